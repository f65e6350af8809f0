"""Make facets of the bust of the fixtures with the installed extension: out/demo.blend, out/demo.png.

python scripts/setup_env.py scripts/demo.py
"""

import importlib
import time

from blender_profile import EXTENSION, empty_profile, install_extension
from build_extension import build_extension, extension_here
from workspace import OUT, ROOT, stop

FIXTURE = ROOT / "blend_fixtures/bust.blend"
VIEW = (0.55, -1.0, 0.12)
"""From before the face, a little to the side and above."""
SIZE = 700


def main() -> None:
    """Build, install, open, stylize, save, draw, report."""
    extension = extension_here(build_extension())
    install_extension(extension, empty_profile())
    import bpy  # noqa: PLC0415

    print(f"== stylize {FIXTURE.stem} in Blender {bpy.app.version_string} with {extension.name}", flush=True)
    bpy.ops.wm.open_mainfile(filepath=str(FIXTURE))
    bust = bpy.data.objects["Bust"]
    bpy.context.view_layer.objects.active = bust
    bust.select_set(True)
    import pictures  # noqa: PLC0415

    before, n_before = pictures.triangles([bust]), len(bust.data.polygons)
    begin = time.perf_counter()
    if bpy.ops.ridgeform.stylize(finish="FACETS") != {"FINISHED"}:
        stop("the operator did not finish")
    seconds = time.perf_counter() - begin
    after = pictures.triangles([bust])
    OUT.mkdir(exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "demo.blend"), check_existing=False)
    look = {"view": VIEW, "size": SIZE, "frame": before[0]}
    drawn = [pictures.render(*mesh, **look) for mesh in (before, after)]
    report = summary()
    captions = [f"{n_before} triangles", f"{report['facets']} facets"]
    pictures.sheet(OUT / "demo.png", [drawn], captions=[captions])
    for what, value in {
        "vertices": report["vertices"],
        "facets": report["facets"],
        "flow steps": f"{report['steps']} ({report['status']})",
        "energy before": f"{report['energy_before']:.6g}",
        "energy after": f"{report['energy_after']:.6g}",
        "largest gap": f"{report['gap']:.2g}",
        "seconds": f"{seconds:.1f}",
        "file": (OUT / "demo.blend").relative_to(ROOT),
        "picture": (OUT / "demo.png").relative_to(ROOT),
    }.items():
        print(f"{what:>14}  {value}")


def summary() -> dict[str, object]:
    """What the add-on says of its last run."""
    job = importlib.import_module(EXTENSION).job
    (entry,) = job.last_summary()
    return entry


if __name__ == "__main__":
    main()
