"""The pages of the manual as plain HTML, a part of the extension: its help works without a network."""

import html
import re
from pathlib import Path

from workspace import ROOT

PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Ridgeform: {title}</title>
<style>body {{ max-width: 60em; margin: 2em auto; font-family: sans-serif }} pre {{ white-space: pre-wrap;
font: inherit }}</style>
{body}
</html>
"""
PICTURE = re.compile(r"!\[([^\]]*)\]\([^)]*\)\n?")
LINK = re.compile(r"\[([^\]]*)\]\(([^)#]*)(#[^)]*)?\)")


def help_page(markdown: str) -> str:
    """A page of the manual, with its headings to jump to and its links, without pictures."""
    title = re.search(r"^# (.*)$", markdown, re.MULTILINE).group(1)
    parts = []
    for block in re.split(r"^(?=#)", PICTURE.sub("", markdown), flags=re.MULTILINE):
        heading, _, text = block.partition("\n") if block.startswith("#") else ("", "", block)
        if heading:
            level = len(heading) - len(heading.lstrip("#"))
            words = heading.lstrip("# ")
            parts.append(f'<h{level} id="{anchor(words)}">{html.escape(words)}</h{level}>')
        parts.append(f"<pre>{_linked(html.escape(text.strip(), quote=False))}</pre>")
    return PAGE.format(title=html.escape(title), body="\n".join(parts))


def anchor(heading: str) -> str:
    """What a heading is jumped to by."""
    return re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-")


def _linked(text: str) -> str:
    def link(match: re.Match) -> str:
        words, page, place = match.groups()
        if "/" in page or not (page or place):
            return words
        return f'<a href="{page.removesuffix(".md") + ".html" if page else ""}{place or ""}">{words}</a>'

    text = LINK.sub(link, text)
    return re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)


def write_help(folder: Path) -> None:
    """Write all pages into a folder."""
    folder.mkdir()
    for path in sorted((ROOT / "docs").glob("manual*.md")):
        page = help_page(path.read_text(encoding="utf-8"))
        (folder / f"{path.stem}.html").write_text(page, encoding="utf-8")
