"""Build the documentation as a site, from the same Markdown: `out/site/index.html`.

    python scripts/setup_env.py scripts/build_docs.py

The README is the first page. The API page is made of the docstrings and stubs of the wheel, with the cells of
examples/api.py; the notebooks are run. MkDocs runs in an environment of its own, and stops at a link that
leads nowhere.
"""

import os
import re
import shutil
import sys
from pathlib import Path

from api_page import api_page
from build_wheel import build_wheel
from setup_env import fill_environment
from workspace import OUT, ROOT, WHEEL_SITE, python_path, run, stop

SOURCE = OUT / "site-source"
SITE = OUT / "site"
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s#]*)(#[^)\s]*)?\)")
CODE = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def sources() -> dict[Path, str]:
    """Files of the project → their names on the site."""
    found = {ROOT / "README.md": "index.md", ROOT / "CHANGELOG.md": "changelog.md"}
    for path in sorted((ROOT / "docs").rglob("*")):
        if path.is_file():
            found[path] = path.relative_to(ROOT / "docs").as_posix()
    for path in sorted((ROOT / "benchmarks").glob("*.md")):
        found[path] = f"benchmarks/{path.name}"
    for name in ("CONTRIBUTING.md", "SECURITY.md"):
        if (ROOT / name).exists():
            found[ROOT / name] = name.lower()
    return found


def moved(text: str, path: Path, names: dict[Path, str]) -> str:
    """A page with its links as they are on the site; a link to a file that is not there becomes text."""
    here = Path(names[path]).parent

    def replace(link: re.Match[str]) -> str:
        picture, label, target, anchor = link[1], link[2], link[3], link[4] or ""
        if not target or re.match(r"[a-z]+:", target):
            return link[0]
        file = (path.parent / target).resolve()
        if file in names:
            return f"{picture}[{label}]({os.path.relpath(names[file], here)}{anchor})"
        if not file.exists():
            stop(f"{path.relative_to(ROOT)} links to {target}, which does not exist")
        return label if "`" in label or " " in label else f"`{label}`"

    parts = CODE.split(text)
    return "".join(part if part.startswith("```") else LINK.sub(replace, part) for part in parts)


def stage() -> None:
    """Lay out the pages as MkDocs wants them."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    names = sources()
    for path, name in names.items():
        target = SOURCE / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            target.write_text(moved(path.read_text(encoding="utf-8"), path, names), encoding="utf-8")
        else:
            shutil.copy2(path, target)
    (SOURCE / "api.md").write_text(api_page(), encoding="utf-8")


def main() -> None:
    """Build the wheel, the pages, and the site."""
    build_wheel()
    stage()
    python = fill_environment("docs", sys.executable, ["docs"], "mkdocs")
    path = {"PYTHONPATH": python_path(WHEEL_SITE)}
    run([python, ROOT / "scripts/notebook_pages.py", SOURCE / "notebooks"], "notebooks", path)
    # The theme announces its maker's next product on every run otherwise.
    quiet = {"NO_MKDOCS_2_WARNING": "1", "DISABLE_MKDOCS_2_WARNING": "true"}
    run(
        [python, "-m", "mkdocs", "build", "--strict", "--quiet", "--clean", "--site-dir", SITE], "site", quiet
    )
    print(SITE.relative_to(ROOT) / "index.html")


if __name__ == "__main__":
    main()
