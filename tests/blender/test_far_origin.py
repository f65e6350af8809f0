"""Files whose coordinates lie far from the origin: nothing is lost, or the record says how much."""

import numpy as np
import pytest
from batch_kit import records
from bl_ext.user_default.ridgeform.framework import far_origin

STEPS = ("--steps", "2")


def run(capfd, *arguments):
    """Exit code and records of Stylize."""
    return records(capfd, "stylize", *arguments, *STEPS)


SHIFT = np.array([512345.0, 5572094.0, 312.0])


def terrain():
    """Vertices (n, 3) and quads (m, 4) of a bumpy sheet of twelve by twelve units."""
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0))
    heights = np.random.default_rng(0).random(144)
    quads = (12 * np.arange(11)[:, None] + np.arange(11)).ravel()[:, None] + [0, 1, 13, 12]
    return np.round(np.stack([x.ravel(), y.ravel(), heights], axis=1), 6), quads


def write_terrain(path, shift, form="ascii"):
    places, quads = terrain()
    places = places + shift
    if path.suffix == ".obj":
        lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in places]
        lines += ["f " + " ".join(str(k + 1) for k in quad) for quad in quads.tolist()]
        path.write_text("\n".join(lines) + "\n")
        return
    head = f"ply\nformat {form} 1.0\nelement vertex {len(places)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(quads)}\nproperty list uchar int vertex_indices\nend_header\n"
    if form == "ascii":
        rows = [f"{x:.6f} {y:.6f} {z:.6f}" for x, y, z in places]
        rows += ["4 " + " ".join(map(str, quad)) for quad in quads.tolist()]
        path.write_text(head + "\n".join(rows) + "\n")
        return
    order = "<" if "little" in form else ">"
    faces = np.zeros(len(quads), [("n", "u1"), ("v", f"{order}i4", 4)])
    faces["n"], faces["v"] = 4, quads
    path.write_bytes(head.encode() + places.astype(f"{order}f8").tobytes() + faces.tobytes())


def places_in(path):
    """The coordinates (n, 3) float64 of a file."""
    return far_origin._KINDS[path.suffix].places(path)


@pytest.mark.parametrize("suffix", [".obj", ".ply"])
@pytest.mark.parametrize("source", ["obj", "ascii", "binary_little_endian", "binary_big_endian"])
def test_far_from_the_origin_nothing_is_lost(tmp_path, capfd, source, suffix):
    kind = ".obj" if source == "obj" else ".ply"
    for name, shift in (("near", np.zeros(3)), ("far", SHIFT)):
        write_terrain(tmp_path / f"{name}{kind}", shift, source)
    out = tmp_path / "out"
    files = [tmp_path / f"near{kind}", tmp_path / f"far{kind}"]
    code, (near, far) = run(capfd, *files, "-o", out, "--format", suffix)
    assert code == 0
    assert not any("far from the origin" in note for note in near["warnings"])
    (said,) = (note for note in far["warnings"] if "far from the origin" in note)
    assert said.endswith("(512350, 5572100, 312), in double precision") or kind == ".obj"
    turned = (
        SHIFT
        if kind == suffix
        else [SHIFT[0], SHIFT[2], -SHIFT[1]]
        if suffix == ".obj"
        else ([SHIFT[0], -SHIFT[2], SHIFT[1]])
    )
    got, wanted = places_in(out / f"far{suffix}") - turned, places_in(out / f"near{suffix}")
    assert np.abs(got - wanted).max() < 2e-5
    assert np.abs(wanted - places_in(tmp_path / f"near{kind}")).max() > 0.005
    assert not list(tmp_path.rglob("*.moved"))


def test_coordinates_that_blender_rounds_are_said(tmp_path, capfd):
    write_terrain(tmp_path / "far.obj", SHIFT)
    code, (far,) = run(capfd, tmp_path / "far.obj", "-o", tmp_path / "out.blend")
    assert code == 0
    (said,) = (note for note in far["warnings"] if "far from the origin" in note)
    assert "steps of 0.5 (5 % of its size)" in said


def test_materials_are_found_from_where_the_file_is(tmp_path, capfd):
    write_terrain(tmp_path / "far.obj", SHIFT)
    (tmp_path / "my colors.mtl").write_text("newmtl Red\nKd 1 0 0\n")
    text = (tmp_path / "far.obj").read_text()
    (tmp_path / "far.obj").write_text(text.replace("f 1 ", "mtllib my colors.mtl\nusemtl Red\nf 1 ", 1))
    code, _ = run(capfd, tmp_path / "far.obj", "-o", tmp_path / "out.obj")
    assert code == 0
    assert "usemtl Red" in (tmp_path / "out.obj").read_text()
    assert "Kd 1.0" in (tmp_path / "out.mtl").read_text()


@pytest.mark.parametrize(
    "text", ["", "ply\n", "v 1 2\n", "v a b c\n", "ply\nformat ascii 1.0\nelement face 0\n"]
)
@pytest.mark.parametrize("suffix", [".obj", ".ply"])
def test_a_file_that_is_none_is_not_moved(tmp_path, text, suffix):
    path = tmp_path / f"odd{suffix}"
    path.write_text(text)
    assert far_origin.offset_of(path, tmp_path / "out.obj") is None
