"""The house holds: files are small, no two take from each other, and no feature takes from another."""

import ast
import re
import subprocess
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LINES, COLUMNS = 400, 110
FEATURES = set(
    re.findall(r'^    "(\w+)",$', (ROOT / "addon/registry.py").read_text(encoding="utf-8"), re.MULTILINE)
)
CRATES = ("rust/core/src", "rust/python/src")
FOLDERS = ("addon", "scripts", "benchmarks", "tests")


@cache
def sources():
    """All source files that git knows."""
    names = subprocess.run(
        ["git", "ls-files", "*.rs", "*.py", "*.pyi"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return [ROOT / name for name in names.stdout.splitlines() if (ROOT / name).is_file()]


def test_files_are_short_and_so_are_their_lines():
    if not sources():
        pytest.skip("not a checkout")
    texts = {path: path.read_text(encoding="utf-8").splitlines() for path in sources()}
    assert [path for path, lines in texts.items() if len(lines) > LINES] == []
    wide = [
        f"{path}:{i}"
        for path, lines in texts.items()
        for i, line in enumerate(lines, 1)
        if len(line) > COLUMNS
    ]
    assert wide == []


def modules(root, ending):
    """The files of a folder by the names of their modules, as tuples."""
    found = {}
    for path in root.rglob(f"*{ending}"):
        name = path.relative_to(root).with_suffix("").parts
        found[name[:-1] if name[-1] in {"mod", "lib", "__init__"} else name] = path
    return found


def python_uses(root):
    """The modules that each Python file imports, in functions as well."""
    files = modules(root, ".py")
    uses = {}
    for name, path in files.items():
        package = name if path.name == "__init__.py" else name[:-1]
        wanted = uses.setdefault(name, set())
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                start = package[: len(package) - node.level + 1] if node.level else ()
                module = (*start, *(node.module.split(".") if node.module else ()))
                wanted |= {
                    (*module, alias.name) if (*module, alias.name) in files else module
                    for alias in node.names
                }
            elif isinstance(node, ast.Import):
                wanted |= {tuple(alias.name.split(".")) for alias in node.names}
        uses[name] = {other for other in wanted if other in files and other != name}
    return uses


def without_tests(text):
    """Rust without comments, strings, and test modules."""
    text = re.sub(r'//[^\n]*|"(?:\\.|[^"\\])*"', "", text)
    while start := re.search(r"#\[cfg\(test\)\][^{;]*\bmod\s+\w+\s*\{", text):
        end, depth = start.end(), 1
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        text = text[: start.start()] + text[end:]
    return text


def paths_in(tree):
    """The paths of a use tree such as `a::{b, c::d}`, each with the name that it brings in."""
    head, brace, rest = tree.partition("{")
    if not brace:
        path, _, alias = (part.strip() for part in tree.partition(" as "))
        return [(path, alias or path.split("::")[-1])] if path else []
    parts, depth = [""], 0
    for letter in rest[: rest.rindex("}")]:
        depth += {"{": 1, "}": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [(head.strip() + path, name) for part in parts for path, name in paths_in(part.strip())]


def rust_uses(root):
    """The modules whose items each Rust file names: by `use`, and by paths in the code."""
    files = modules(root, ".rs")
    texts = {name: without_tests(path.read_text(encoding="utf-8")) for name, path in files.items()}

    def absolute(module, path):
        parts = [part for part in path.split("::") if part != "*"]
        if parts[0] == "crate":
            return tuple(parts[1:])
        if parts[0] in {"self", "super"}:
            up = parts.count("super")
            return (*module[: len(module) - up], *(part for part in parts if part not in {"self", "super"}))
        return (*module, *parts) if (*module, parts[0]) in files else None

    brought, named = {}, {}
    for module, text in texts.items():
        brought[module], named[module] = {}, set()
        for shown, tree in re.findall(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);", text):
            for path, name in paths_in(re.sub(r"\s+", " ", tree)):
                if (place := absolute(module, path)) is not None:
                    brought[module][name] = place
                    # What a folder shows of its files it does not use.
                    if not shown:
                        named[module].add(place)
        code = re.sub(r"\b(?:pub(?:\([^)]*\))?\s+)?use\s+[^;]+;", "", text)
        for path in re.findall(r"(?<![\w:])([a-z_]\w*(?:::\w+)+)", code):
            first, _, rest = path.partition("::")
            place = absolute(module, path) or (
                (*brought[module][first], *rest.split("::")) if first in brought[module] else None
            )
            if place is not None:
                named[module].add(place)

    def home(place, steps=6):
        """The module that an item is defined in, through what others show of it."""
        cut = next(n for n in range(len(place), -1, -1) if place[:n] in files)
        module, rest = place[:cut], place[cut:]
        shown = brought[module].get(rest[0]) if rest else None
        return home((*shown, *rest[1:]), steps - 1) if shown and shown != place and steps else module

    return {module: {home(place) for place in places} - {module} for module, places in named.items()}


@pytest.mark.parametrize("folder", [*CRATES, *FOLDERS])
def test_no_files_take_from_each_other(folder):
    uses = (rust_uses if folder in CRATES else python_uses)(ROOT / folder)
    assert sum(map(len, uses.values())) > len(uses) / 2
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        pytest.fail(" → ".join("/".join(module) or "the top" for module in error.args[1]))


def test_no_feature_takes_from_another():
    uses = python_uses(ROOT / "addon")
    assert {name[0] for name in uses if len(name) > 1} >= FEATURES
    crossing = [
        (name, other)
        for name, others in uses.items()
        for other in others
        if name and other and name[0] in FEATURES and other[0] in FEATURES - {name[0]}
    ]
    assert crossing == []


def test_circles_are_found(tmp_path):
    (tmp_path / "a.rs").write_text("use crate::b::{self, Thing};\nfn f() { b::g() }\n")
    (tmp_path / "b.rs").write_text("pub struct Thing;\npub fn g() { super::a::f() }\n")
    (tmp_path / "lib.rs").write_text("mod a;\nmod b;\n")
    assert rust_uses(tmp_path)[("b",)] == {("a",)}
    with pytest.raises(CycleError):
        TopologicalSorter(rust_uses(tmp_path)).prepare()
    (tmp_path / "c.py").write_text("def f():\n    from d import x\n")
    (tmp_path / "d.py").write_text("import c\n")
    with pytest.raises(CycleError):
        TopologicalSorter(python_uses(tmp_path)).prepare()
