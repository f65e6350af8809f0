"""The notebooks of `examples/notebooks` as pages of the documentation, run when these are made.

python scripts/notebook_pages.py FOLDER
"""

import ast
import contextlib
import io
import json
import os
import sys
from pathlib import Path

from workspace import ROOT

NOTEBOOKS = ROOT / "examples/notebooks"


def cells(path: Path) -> list[tuple[str, str]]:
    """Kinds (markdown, code) and texts of the cells of a notebook."""
    found = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [(cell["cell_type"], "".join(cell["source"])) for cell in found]


def run_cell(text: str, names: dict[str, object]) -> tuple[str, object]:
    """What a cell prints, and the value of its last line if that is an expression; as a notebook has it."""
    tree = ast.parse(text)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(compile(tree, "cell", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return said.getvalue(), value


def run(path: Path, names: dict[str, object]) -> list[tuple[str, str, str, object]]:
    """Run a notebook where it lies, into names: the kind, text, output, and value of each cell."""
    before, sys.path[:0] = os.getcwd(), [str(path.parent)]
    os.chdir(path.parent)
    try:
        return [
            (kind, text, *(run_cell(text, names) if kind == "code" else ("", None)))
            for kind, text in cells(path)
        ]
    finally:
        os.chdir(before)
        sys.path.remove(str(path.parent))


def write_pages(folder: Path) -> None:
    """Write a page for each notebook into a folder, with its pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        parts = []
        for number, (kind, text, said, value) in enumerate(run(path, {})):
            parts.append(text if kind == "markdown" else f"```python\n{text}\n```")
            if said:
                parts.append(f"```text\n{said.rstrip()}\n```")
            if value is not None:
                picture = folder / f"{path.stem}_{number}.svg"
                picture.write_text(value._repr_svg_(), encoding="utf-8")
                parts.append(f"![{path.stem}, picture {number}]({picture.name})")
        parts.append(f"This page is the notebook `examples/notebooks/{path.name}`.")
        (folder / f"{path.stem}.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_pages(Path(sys.argv[1]))
