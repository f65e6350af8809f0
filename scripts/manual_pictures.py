"""Draw the pictures of README and manual that show results: docs/pictures/*.png.

    python scripts/setup_env.py scripts/manual_pictures.py [NAME ...]

Everything is computed with the sliders of the add-on, from the meshes of `blend_fixtures` and of
`tests/known_shapes/shapes.py`.
"""

import sys
import time

import numpy as np
from build_wheel import build_wheel
from workspace import ROOT, WHEEL_SITE

PICTURES = ROOT / "docs/pictures"
BUST_VIEW = (0.55, -1.0, 0.12)
SPOT_VIEW = (-0.9, -1.0, 0.35)
CUBE_VIEW = (0.6, -1.0, 0.6)
STRENGTHS = {"bust": (0.35, 0.5, 0.65), "spot": (0.5, 0.65, 0.8)}
SHARPNESSES = (0.0, 0.5, 1.0)
NOISE = 0.5
NOISE_STRENGTH = 0.6
BANDS = 10
HOUSE_NOISE = 0.1
SEGMENT_COUNTS = (5, None, 30)
PART_COUNTS = (4, 8, 16)
MONKEY_LEVELS = 2
MONKEY_VIEW = (0.7, -1.0, 0.2)
PART_VIEW = (0.7, -1.0, 0.8)
PART_NOISE = 0.2
NOISE_FACTORS = (0.25, 1.0, 4.0)
FACET_COUNTS = {"bust": (80, 200, 400), "spot": (60, 150)}


def stylized(vertices: np.ndarray, faces: np.ndarray, **changes: object) -> np.ndarray:
    """The vertices after the flow, with the add-on's defaults but for `changes`."""
    import ridgeform  # noqa: PLC0415

    from addon.stylize.settings import default_settings, stylize_options  # noqa: PLC0415

    options = stylize_options(default_settings(**changes))
    begin = time.perf_counter()
    result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), **options)
    said = ", ".join(f"{name} {value}" for name, value in changes.items()) or "defaults"
    print(
        f"{said}: {result.status}, {result.iterations} steps, {time.perf_counter() - begin:.1f} s", flush=True
    )
    return result.vertices


def source(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a source of the fixtures."""
    with np.load(ROOT / f"blend_fixtures/sources/{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"]


def hero() -> None:
    """The bust before and after."""
    import pictures  # noqa: PLC0415

    vertices, faces = source("bust")
    after = stylized(vertices, faces)
    look = {"view": BUST_VIEW, "size": (420, 560), "frame": vertices}
    row = [pictures.render(mesh, faces, **look) for mesh in (vertices, after)]
    pictures.sheet(PICTURES / "hero.png", [row])


def sliders(name: str, view: tuple[float, float, float], size: tuple[int, int]) -> None:
    """A mesh at three strengths and three sharpnesses, the input beside them."""
    import pictures  # noqa: PLC0415

    vertices, faces = source(name)
    look = {"view": view, "size": size, "frame": vertices}
    rows, captions = [], []
    for i, strength in enumerate(STRENGTHS[name]):
        row = [pictures.render(vertices, faces, **look) if i == 0 else None]
        for sharpness in SHARPNESSES:
            after = stylized(vertices, faces, strength=strength, sharpness=sharpness)
            row.append(pictures.render(after, faces, **look))
        rows.append(row)
        captions.append(
            [
                "input" if i == 0 else " ",
                *(f"strength {strength}, sharpness {value}" for value in SHARPNESSES),
            ]
        )
    pictures.sheet(PICTURES / f"sliders_{name}.png", rows, captions=captions, text_pixels=13)


def density() -> None:
    """One strength on Spot at four densities."""
    import pictures  # noqa: PLC0415
    from known_shapes import shapes  # noqa: PLC0415

    coarse, fine = source("spot_low_resolution"), source("spot")
    row, captions = [], []
    for vertices, faces in (coarse, shapes.subdivide(*coarse), fine, shapes.subdivide(*fine)):
        after = stylized(vertices, faces, strength=0.7)
        row.append(pictures.render(after, faces, view=SPOT_VIEW, size=240, frame=vertices))
        captions.append(f"{len(vertices)} vertices")
    pictures.sheet(PICTURES / "density.png", [row], captions=[captions], text_pixels=13)


def noisy_cube() -> None:
    """A cube under noise, restored with the paper's weight."""
    import pictures  # noqa: PLC0415
    from known_shapes import shapes  # noqa: PLC0415

    vertices, faces = shapes.noisy_cube(seed=0)
    paper = {"use_fidelity": True, "fidelity": 500.0, "scale": "max_edge"}
    after = stylized(vertices, faces, steps=12, sharpness=0.5, **paper)
    look = {"view": CUBE_VIEW, "size": 400, "frame": vertices}
    row = [pictures.render(mesh, faces, **look) for mesh in (vertices, after)]
    errors = [shapes.root_mean_square(shapes.distance_to_cube(mesh)) for mesh in (vertices, after)]
    captions = [
        f"{when}: {error:.4f} off the cube" for when, error in zip(("noisy", "restored"), errors, strict=True)
    ]
    pictures.sheet(PICTURES / "noisy_cube.png", [row], captions=[captions], text_pixels=15)


def creased(vertices: np.ndarray) -> np.ndarray:
    """A function (n,) on Spot that goes up and down, with straight slopes between sharp turns."""
    x = vertices - vertices.mean(axis=0)
    x /= np.abs(x).max()
    return np.abs((2.0 * x[:, 2] + 0.8 * x[:, 1]) % 2.0 - 1.0)


def attributes() -> None:
    """Noise on a creased function on Spot, taken away with two energies, in bands."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415

    from addon.attributes.denoise import fidelity_for  # noqa: PLC0415
    from addon.attributes.settings import DenoiseSettings, solve_options  # noqa: PLC0415
    from addon.blender import ramp  # noqa: PLC0415
    from addon.framework.settings import defaults_of  # noqa: PLC0415

    vertices, faces = source("spot")
    mesh, truth = ridgeform.Mesh(vertices, faces), creased(vertices)
    noisy = truth + np.random.default_rng(0).normal(scale=NOISE * truth.std(), size=len(truth))
    shown, captions = [noisy], [f"noise of {NOISE:.0%} of the spread"]
    for energy, name in (("l1_hessian", "Sharp"), ("l2_curved_hessian", "Smooth, Curved")):
        settings = defaults_of(DenoiseSettings, energy=energy, strength=NOISE_STRENGTH)
        fidelity = fidelity_for(mesh, noisy[:, None], settings.strength, energy)
        shown.append(ridgeform.denoise(mesh, noisy, fidelity=fidelity, **solve_options(settings)).values)
        error = np.sqrt(np.mean((shown[-1] - truth) ** 2)) / np.sqrt(np.mean((noisy - truth) ** 2))
        captions.append(f"{name}: {error:.0%} of the noise left")
        print(captions[-1], flush=True)
    low, high = truth.min(), truth.max()
    row = []
    for values in shown:
        place = np.clip((values[faces].mean(axis=1) - low) / (high - low), 0, 1 - 1e-9)
        colors = ramp.colors_at(ramp.SEQUENTIAL, (np.floor(place * BANDS) + 0.5) / BANDS)[:, :3]
        row.append(pictures.render(vertices, faces, view=SPOT_VIEW, size=300, color=colors))
    pictures.sheet(PICTURES / "attributes.png", [row], captions=[captions], text_pixels=15)


def segments() -> None:
    """A house under noise, and the bust from one run in three numbers of segments."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415
    from known_shapes import shapes  # noqa: PLC0415

    from addon.framework.settings import defaults_of  # noqa: PLC0415
    from addon.segments.settings import SegmentSettings, segment_options  # noqa: PLC0415
    from addon.segments.slots import color_of  # noqa: PLC0415

    vertices, faces = shapes.house(4)
    house = shapes.add_noise(vertices, faces, HOUSE_NOISE, seed=1), faces
    row, captions = [], []
    for (points, triangles), view, counts in (
        (house, CUBE_VIEW, (None,)),
        (source("bust"), BUST_VIEW, SEGMENT_COUNTS),
    ):
        options = segment_options(defaults_of(SegmentSettings))
        found = ridgeform.segment(ridgeform.Mesh(points, triangles), **options)
        print(found, flush=True)
        for count in counts:
            labels = found.labels if count is None else found.labels_at(count)
            colors = np.array([color_of(number)[:3] for number in range(labels.max() + 1)])[labels]
            row.append(pictures.render(points, triangles, view=view, size=(260, 340), color=colors))
            captions.append(f"{labels.max() + 1} segments" + (" (default)" if count is None else ""))
    pictures.sheet(PICTURES / "segments.png", [row], captions=[captions], text_pixels=15)


def monkey() -> tuple[np.ndarray, np.ndarray]:
    """Blender's monkey, smoothed: three pieces, with open eyes."""
    import bpy  # noqa: PLC0415

    bpy.ops.mesh.primitive_monkey_add()
    item = bpy.context.active_object
    smooth = item.modifiers.new("smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = MONKEY_LEVELS
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    vertices, faces = np.empty((len(mesh.vertices), 3)), np.empty((len(mesh.loop_triangles), 3), np.int64)
    mesh.vertices.foreach_get("co", vertices.ravel())
    mesh.loop_triangles.foreach_get("vertices", faces.ravel())
    bpy.data.objects.remove(item)
    return vertices, faces


def parts() -> None:
    """Parts and faces of three characters, as found and in the same numbers."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415

    rows, captions = [], []
    for (points, triangles), view in (
        (source("spot"), SPOT_VIEW),
        (source("bust"), BUST_VIEW),
        (monkey(), MONKEY_VIEW),
    ):
        mesh = ridgeform.Mesh(points, triangles)
        for kind, found in (("parts", ridgeform.parts(mesh)), ("faces", ridgeform.segment(mesh))):
            print(kind, found, flush=True)
            row, said = [], []
            for count in (None, *PART_COUNTS):
                labels = found.labels if count is None else found.labels_at(count)
                row.append(pictures.render(points, triangles, view=view, size=170, color=colors_of(labels)))
                said.append(f"{labels.max() + 1} {kind}" + (" (as found)" if count is None else ""))
            rows.append(row)
            captions.append(said)
    pictures.sheet(PICTURES / "parts.png", rows, captions=captions, text_pixels=13, shades=40)


def facets() -> None:
    """Facets of the bust after the flow, and of Spot as it is, in several numbers from one run each."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415

    bust, spot = source("bust"), source("spot")
    row, captions = [], []
    for (points, triangles), view, counts in (
        ((stylized(*bust), bust[1]), BUST_VIEW, FACET_COUNTS["bust"]),
        (spot, SPOT_VIEW, FACET_COUNTS["spot"]),
    ):
        found = ridgeform.facet(ridgeform.Mesh(points, triangles), facets=counts[0])
        for count in counts:
            made = found.at(facets=count)
            print(made, flush=True)
            look = {"view": view, "size": (260, 340), "frame": points}
            row.append(pictures.render(made.vertices, made.faces, **look))
            captions.append(f"{made.n_facets} facets")
    pictures.sheet(PICTURES / "facets.png", [row], captions=[captions], text_pixels=15)


def segment() -> None:
    """A noisy part as it is and in the segments of the defaults, for a slider."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415
    from known_shapes import segment_shapes  # noqa: PLC0415

    from addon.framework.settings import defaults_of  # noqa: PLC0415
    from addon.segments.settings import SegmentSettings, segment_options  # noqa: PLC0415

    part = segment_shapes.SHAPES["fan part"](1)
    noisy, triangles = part.noisy(PART_NOISE, 0).vertices, part.faces
    options = segment_options(defaults_of(SegmentSettings))
    labels = ridgeform.segment(ridgeform.Mesh(noisy, triangles), **options).labels
    look = {"view": PART_VIEW, "size": (440, 380), "frame": noisy}
    row = [pictures.render(noisy, triangles, **look)]
    row.append(pictures.render(noisy, triangles, color=colors_of(labels), **look))
    pictures.sheet(PICTURES / "segment_part.png", [row])


def facet() -> None:
    """Spot as it is and in facets, for a slider."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415

    points, triangles = source("spot")
    made = ridgeform.facet(ridgeform.Mesh(points, triangles), facets=FACET_COUNTS["spot"][1])
    look = {"view": SPOT_VIEW, "size": (440, 420), "frame": points}
    row = [pictures.render(points, triangles, **look), pictures.render(made.vertices, made.faces, **look)]
    pictures.sheet(PICTURES / "facet_spot.png", [row])


def colors_of(labels: np.ndarray) -> np.ndarray:
    """A color for each face, by its label; clay for those that have none (-1)."""
    import pictures  # noqa: PLC0415

    from addon.segments.slots import color_of  # noqa: PLC0415

    palette = np.array([color_of(number)[:3] for number in range(labels.max() + 1)] + [pictures.CLAY])
    return palette[labels]


def restored() -> None:
    """A noisy part before and after, and its surfaces; and what the setting Noise does to these."""
    import pictures  # noqa: PLC0415
    import ridgeform  # noqa: PLC0415
    from known_shapes import segment_shapes  # noqa: PLC0415

    part = segment_shapes.SHAPES["fan part"](1)
    noisy = part.noisy(PART_NOISE, 0).vertices
    mesh = ridgeform.Mesh(noisy, part.faces)
    found = ridgeform.restore(mesh)
    look = {"view": PART_VIEW, "size": (300, 260), "frame": noisy}
    row = [pictures.render(points, part.faces, **look) for points in (noisy, found.vertices)]
    row.append(pictures.render(found.vertices, part.faces, color=colors_of(found.labels), **look))
    captions = ["a scan", "restored", f"its {len(found.surfaces)} surfaces"]
    pictures.sheet(PICTURES / "restore.png", [row], captions=[captions], text_pixels=15)
    row, captions = [], []
    for factor in NOISE_FACTORS:
        made = ridgeform.restore(mesh, noise=factor * found.noise)
        print(factor, made, flush=True)
        row.append(pictures.render(made.vertices, part.faces, color=colors_of(made.labels), **look))
        captions.append(f"Noise {factor:g} times: {len(made.surfaces)} surfaces")
    pictures.sheet(PICTURES / "restore_noise.png", [row], captions=[captions], text_pixels=15)


def holes(name: str) -> None:
    """A picture of the page on filling holes."""
    import hole_pictures  # noqa: PLC0415

    getattr(hole_pictures, name)(PICTURES / f"holes_{name}.png")


DRAWN = {
    "hero": hero,
    "sliders_bust": lambda: sliders("bust", BUST_VIEW, (172, 236)),
    "sliders_spot": lambda: sliders("spot", SPOT_VIEW, (205, 205)),
    "density": density,
    "noisy_cube": noisy_cube,
    "attributes": attributes,
    "segments": segments,
    "segment": segment,
    "parts": parts,
    "facets": facets,
    "facet": facet,
    "restore": restored,
    "holes_box": lambda: holes("box"),
    "holes_checker": lambda: holes("checker"),
    "holes_settings": lambda: holes("settings"),
}


def main(names: list[str]) -> None:
    """Draw all pictures, or those named."""
    build_wheel()
    sys.path[:0] = [str(WHEEL_SITE), str(ROOT)]
    import bpy  # noqa: F401, PLC0415

    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names or DRAWN:
        print(f"== {name}", flush=True)
        DRAWN[name]()


if __name__ == "__main__":
    main(sys.argv[1:])
