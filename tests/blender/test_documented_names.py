"""What the documentation says to press and to choose is there, under that name and in that place."""

import re
from pathlib import Path

import pytest
from interface_names import is_name, leads_somewhere

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [DOCS.parent / "README.md", *sorted(DOCS.glob("manual*.md"))]
PAGES += [DOCS / "recipes.md", DOCS / "troubleshooting.md"]
NO_TEXT = re.compile(r"^```.*?^```\n|<!--.*?-->|`[^`]*`|(?<=\])\([^)]*\)|[\[\]]", re.MULTILINE | re.DOTALL)
BOLD = re.compile(r"\*\*([^*]+)\*\*")
ITALIC = re.compile(r"(?<![*\w])\*([^*\s][^*]*)\*(?![*\w])")
KEYS = {"N", "L", "i", "+", "Alt", "Ctrl A", "Enter", "Esc", "Tab", "F3", "F9"}
"""Keys, and signs that stand for icons."""
OTHER_WORDS = {
    "manual",
    "Start with the defaults, then change Strength",
    "Change any setting, and it starts again from the original",
    "Custom normals",
    "Ridges look like saw teeth",
    "Coarse meshes",
    "Dense meshes",
    "Regular meshes",
    "Uneven object scale",
    "Corners that would have moved too far",
    "Denoise and Interpolate Attribute",
    "Sharpening and Sparsifying with Surface Hessians",
    "Diffusion curves",
    "Sharpened",
}
"""What is set off without being a name: beginnings of paragraphs, two tools at once, titles, attributes."""
SHORT = {"Denoise", "Interpolate", "Sharp along Edges", "Smooth, Curved"}
"""Beginnings of names that a page has in full before."""
RENAMED = {
    "UV ▸ Unwrap Angle Based": "UV ▸ Unwrap",
    "Object Data ▸ Geometry Data ▸ Clear Custom Normals Data": "Clear Custom Split Normals Data",
}
"""What newer versions of Blender call something, and what older ones do: pages say both."""
ELSEWHERE = {"Window ▸ Toggle System Console"}
"""There on Windows only."""


def spans(page, pattern):
    """What is set in bold, or in italics, on a page; captions, code, and links' targets are left out."""
    text = NO_TEXT.sub("", page.read_text(encoding="utf-8"))
    text = "\n\n".join(part for part in re.split(r"\n\s*\n", text) if not re.match(r"\*[^*]", part))
    return {" ".join(found.split()) for found in pattern.findall(text)}


def is_sentence(span):
    """Whether a span is what a report says, or the beginning of a paragraph, and so no name."""
    return span.endswith(".") or span[0].islower() or '"' in span


def unknown(span):
    """Whether something that is set off should be in the interface and is not, by any of its names."""
    for names in RENAMED.items():
        if span in names:
            return not any(map(is_there, names))
    return not (is_sentence(span) or span in KEYS | OTHER_WORDS | SHORT | ELSEWHERE or is_there(span))


def is_there(span):
    """Whether a name, or a path through menus, is in the interface."""
    if "▸" in span:
        path = [part.strip() for part in span.split("▸")]
        return leads_somewhere([part for part in path if part != "⌄"])
    return is_name(span)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_name_on_a_page_is_in_the_interface(page):
    found = spans(page, BOLD) | spans(page, ITALIC)
    assert sorted(filter(unknown, found)) == []


def test_names_that_are_not_there_are_found():
    for span in ("Melt", "Object ▸ Stylize Flat", "Object ▸ Ridgeform ▸ Melt", "Mesh ▸ Normals ▸ Melt"):
        assert unknown(span), span
    for span in ("Stylize Flat", "Object ▸ Ridgeform ▸ Check Mesh", "Mesh ▸ Merge ▸ By Distance"):
        assert not unknown(span), span
