"""Draw the gallery: docs/pictures/gallery/*.png, and the tables of docs/gallery.md between their markers.

    python scripts/setup_env.py scripts/draw_gallery.py [NAME ...]

Names are those of the modules of `scripts/gallery` that draw a figure; none draws all.
"""

import importlib
import re
import sys
import time

from build_wheel import build_wheel
from workspace import ROOT, WHEEL_SITE, stop

PICTURES = ROOT / "docs/pictures/gallery"
PAGE = ROOT / "docs/gallery.md"
FIGURES = (
    "flow",
    "cubes",
    "layouts",
    "modes",
    "scattered",
    "surfaces",
    "duals",
    "resolutions",
    "slivers",
    "missing",
    "heights",
    "filled",
    "curves",
    "segments",
)


def put_into_page(name: str, text: str) -> None:
    """Replace what stands between the markers of this name in the page; stop if it has none."""
    begin, end = f"<!-- {name}:begin -->\n", f"<!-- {name}:end -->"
    old = PAGE.read_text(encoding="utf-8")
    new, found = re.subn(
        f"(?<={re.escape(begin)}).*?(?={re.escape(end)})", lambda _: text, old, count=1, flags=re.DOTALL
    )
    if not found:
        stop(f"docs/gallery.md has no markers {name}:begin and {name}:end")
    PAGE.write_text(new, encoding="utf-8")


def main(names: list[str]) -> None:
    """Draw all figures, or those named."""
    unknown = sorted(set(names) - set(FIGURES))
    if unknown:
        stop(f"no figure is called {', '.join(unknown)}: there are {', '.join(FIGURES)}")
    build_wheel()
    sys.path[:0] = [str(WHEEL_SITE), str(ROOT), str(ROOT / "benchmarks")]
    # Before everything that might load another NumPy.
    import bpy  # noqa: F401, PLC0415

    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names or FIGURES:
        print(f"== {name}", flush=True)
        begin = time.perf_counter()
        for marker, text in importlib.import_module(f"gallery.{name}").draw(PICTURES).items():
            put_into_page(marker, text)
            print(text, flush=True)
        print(f"   {time.perf_counter() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
