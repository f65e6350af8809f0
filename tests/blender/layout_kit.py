"""A layout that takes down what is drawn into it, for the tests of panels and menus."""


class Layout:
    """Stands for a layout and all that is made in it."""

    def __init__(self) -> None:
        """Begin empty."""
        self.rows: list[str] = []
        self.buttons: list[tuple[str, str]] = []
        self.labels: list[str] = []

    def row(self, **_options: object) -> "Layout":
        """The same layout."""
        return self

    column = box = row

    def prop(self, _settings: object, name: str, **_options: object) -> None:
        """Take down a row."""
        self.rows.append(name)

    def prop_search(self, _settings: object, name: str, _data: object, _collection: str) -> None:
        """Take down a row with a search field."""
        self.rows.append(name)

    def label(self, text: str = "", **_options: object) -> None:
        """Take down a text."""
        self.labels.append(text)

    def menu(self, _idname: str, **_options: object) -> None:
        """Menus are tested by themselves."""

    def operator(self, idname: str, text: str = "", **_options: object) -> "Layout":
        """Take down a button; its properties are set on the layout itself."""
        self.buttons.append((idname, text))
        return self

    def popover(self, text: str = "", **_options: object) -> None:
        """Take down the text of a button that opens a panel."""
        self.labels.append(text)
