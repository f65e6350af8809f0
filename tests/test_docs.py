"""The documentation holds: links and pictures exist, and so does every name in the index of equations."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest
from american_words import british_lines, british_strings, british_words

ROOT = Path(__file__).parents[1]
PAGES = sorted(
    path
    for folder, pattern in ((ROOT, "*.md"), (ROOT / "docs", "**/*.md"), (ROOT / "blend_fixtures", "*.md"))
    for path in folder.glob(pattern)
)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```\n", re.MULTILINE | re.DOTALL)
LARGEST_PICTURE = 350_000
README_LINES = 170
LINE_LENGTH = 110
DECISIONS = ROOT / "docs/decisions"


def name_of(page):
    return str(page.relative_to(ROOT))


@cache
def anchors(page):
    """The anchors that a page's headings have on code hosts."""
    headings = re.findall(r"^#+ +(.+)$", CODE.sub("", page.read_text(encoding="utf-8")), re.MULTILINE)
    kept = (re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", heading).lower()) for heading in headings)
    return {heading.strip().replace(" ", "-") for heading in kept}


def relative_links(page):
    targets = LINK.findall(CODE.sub("", page.read_text(encoding="utf-8")))
    return [target for target in targets if not re.match(r"[a-z]+:", target)]


def equation_rows():
    """File and names of every row of the tables in docs/equations.md."""
    page = ROOT / "docs/equations.md"
    for line in page.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 4 and (link := LINK.fullmatch(cells[2])):
            yield (page.parent / link[1]).resolve(), re.findall(r"`([^`]+)`", cells[3])


def defines(path, name):
    """Whether a Rust or Python file defines a function, type, method or constant of this name."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        kinds = (ast.FunctionDef, ast.ClassDef)
        return any(isinstance(node, kinds) and node.name == name for node in ast.walk(ast.parse(text)))
    return re.search(rf"\b(fn|struct|enum|trait|type|const)\s+{re.escape(name)}\b", text) is not None


NOT_COMPUTED = {*range(31, 38)}
"""Equations of the paper that derive boundary conditions; docs/equations.md says so."""


def paper_rows():
    """Numbers, file and names of every row of the paper's table in docs/equations.md."""
    page = ROOT / "docs/equations.md"
    for line in page.read_text(encoding="utf-8").split("## Other sources")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 4 and (link := LINK.fullmatch(cells[2])):
            numbers = {int(number) for number in re.findall(r"\((\d+)\)", cells[0])}
            yield numbers, (page.parent / link[1]).resolve(), re.findall(r"`([^`]+)`", cells[3])


def documentation(path, name):
    """The doc comments of all that a Rust file defines by this name."""
    item = r"(?:pub(?:\([a-z]+\))? )?(?:const )?(?:fn|struct|enum|trait|type)"
    definition = rf"^((?:[ \t]*(?:///|#\[)[^\n]*\n)*)[ \t]*{item}\s+{re.escape(name)}\b"
    return "\n".join(re.findall(definition, path.read_text(encoding="utf-8"), re.MULTILINE))


def test_functions_carry_the_numbers_of_their_equations():
    rows = list(paper_rows())
    assert len(rows) > 25
    for numbers, path, names in rows:
        text = "".join(documentation(path, name) for name in names)
        missing = [number for number in sorted(numbers) if f"({number})" not in text]
        assert missing == [], f"{path.name}: {names} does not name {missing}"
    listed = set().union(*(numbers for numbers, _, _ in rows))
    assert set(range(15, 42)) - listed == NOT_COMPUTED


def test_every_equation_that_code_claims_is_in_the_index():
    rows = list(paper_rows())
    claim = re.compile(
        r"Rowe et al\. 2024, [^()]*?eqs?\. (\(\d+\)(?:(?:, | and |, in matrices eq\. )\(\d+\))*)"
    )
    found = 0
    for path in sorted((ROOT / "rust/core/src").rglob("*.rs")):
        for block in re.findall(r"(?:^[ \t]*///[^\n]*\n)+", path.read_text(encoding="utf-8"), re.MULTILINE):
            text = " ".join(line.strip().removeprefix("///").strip() for line in block.splitlines())
            for numbers in claim.findall(text):
                for number in map(int, re.findall(r"\d+", numbers)):
                    found += 1
                    assert any(number in n and path == p for n, p, _ in rows), f"{path}: ({number})"
    assert found > 20


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_relative_links_and_pictures_exist(page):
    for target in relative_links(page):
        file, _, anchor = target.partition("#")
        where = (page.parent / file).resolve() if file else page
        assert where.is_relative_to(ROOT), f"{target} leads out of the project"
        assert where.exists(), f"{target} does not exist"
        if anchor and where.suffix == ".md":
            assert anchor in anchors(where), f"{target} names no heading"


def reached_from(page):
    return {(page.parent / link.partition("#")[0]).resolve() for link in relative_links(page)}


@pytest.mark.parametrize("page", [page for page in PAGES if page.parent == ROOT / "docs"], ids=name_of)
def test_every_page_is_reached_from_the_readme(page):
    assert page in reached_from(ROOT / "README.md")


def test_every_decision_is_in_the_index_and_says_why():
    pages = sorted(DECISIONS.glob("*.md"))
    index = DECISIONS / "README.md"
    assert reached_from(index) == set(pages) - {index}
    for page in set(pages) - {index}:
        headings = re.findall(r"^## (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
        assert headings == ["Context", "Choice", "Evidence", "Rejected"], page.name


def test_the_words_are_american():
    assert british_words("The COLOUR of a neighbouring centre: labelled, unfactorised") == [
        "COLOUR",
        "neighbouring",
        "centre",
        "labelled",
        "unfactorised",
    ]
    assert british_words("Colors, centers, realistic analyses, l2_norm, revise, promise, raised") == []
    assert [line for page in PAGES for line in british_lines(page)] == []
    addon = ROOT / "addon"
    assert [line for table in addon.rglob("*.toml") for line in british_lines(table)] == []
    assert [line for file in addon.rglob("*.py") for line in british_strings(file)] == []


def prose(page):
    """The lines of a page with their numbers, without code, tables, pictures, and what programs write."""
    text = page.read_text(encoding="utf-8")
    for skipped in (CODE, re.compile(r"<!-- (.+?):begin -->.*?<!-- \1:end -->", re.DOTALL)):
        text = skipped.sub(lambda found: "\n" * found[0].count("\n"), text)
    return [line for line in enumerate(text.splitlines(), 1) if not line[1].startswith(("|", "!["))]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_lines_fit_into_an_editor(page):
    assert [number for number, line in prose(page) if len(line) > LINE_LENGTH] == []


def test_every_picture_is_shown_and_small():
    shown = {file for page in PAGES for file in reached_from(page)}
    pictures = sorted(path for path in (ROOT / "docs/pictures").rglob("*") if path.is_file())
    assert pictures
    for picture in pictures:
        assert picture in shown, f"{picture.name} is in no page"
        assert picture.stat().st_size <= LARGEST_PICTURE, f"{picture.name} is too large"


def test_every_name_in_the_index_of_equations_is_defined():
    rows = list(equation_rows())
    assert len(rows) > 25
    for path, names in rows:
        assert path.is_file(), f"{path} does not exist"
        assert names, f"a row on {path.name} has no names"
        for name in names:
            assert defines(path, name), f"{path.name} defines no {name}"


def test_every_file_named_in_the_architecture_exists():
    text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
    parts = ROOT / "rust/core/src", ROOT / "addon"
    folders = [ROOT, *parts, *(folder for part in parts for folder in part.iterdir() if folder.is_dir())]
    named = re.findall(r"`([\w./*]+(?:\.(?:py|rs|toml)|/))`", text)
    assert len(named) > 15
    for name in named:
        assert any(any(folder.glob(name.rstrip("/"))) for folder in folders), f"{name} does not exist"


def test_the_manual_names_every_field_of_the_command():
    """Settings and flags are known to Blender only: tests/blender/test_settings.py."""
    manual = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "docs").glob("manual*.md")))
    command = (ROOT / "addon/overnight/one_file.py").read_text(encoding="utf-8")
    fields = re.findall(r'^        "(\w+)": (?:None|\[\]|str)', command, re.MULTILINE)
    assert len(fields) > 8
    for name in fields:
        assert f"`{name}" in manual, f"{name} is not in the manual"


def test_the_readme_is_short_and_has_its_benchmark_block():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) < README_LINES
    assert re.search(r"<!-- bench:begin -->\n.+\n<!-- bench:end -->", text, re.DOTALL)


def test_the_gallery_has_a_table_for_every_figure():
    names = re.search(
        r"^FIGURES = \((.+?)\)", (ROOT / "scripts/draw_gallery.py").read_text("utf-8"), re.M | re.S
    )
    assert names
    text = (ROOT / "docs/gallery.md").read_text(encoding="utf-8")
    for name in re.findall(r'"(\w+)"', names[1]):
        assert re.search(rf"<!-- {name}:begin -->\n\|.+?<!-- {name}:end -->", text, re.DOTALL), name
