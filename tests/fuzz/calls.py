"""Calls of every tool on any mesh, with arguments from end to end, and what holds of what they return."""

import ast
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import ridgeform
from hypothesis import strategies as st

from fuzz import answers
from fuzz.meshes import MeshPlan, mesh_plans

STUB = ast.parse((Path(ridgeform.__file__).parent / "_native.pyi").read_text(encoding="utf-8"))
WORDS = {
    ast.unparse(node.target): ast.literal_eval(node.value.slice)
    for node in STUB.body
    if isinstance(node, ast.AnnAssign) and ast.unparse(node.value or node).startswith("Literal[")
}
"""What a keyword of a type takes, as the stubs have it."""
ENERGIES, DUALS, COUPLINGS = WORDS["Energy"], WORDS["Dual"], WORDS["Coupling"]
SCALES, SOLVERS = WORDS["Scale"], WORDS["Solver"]
JUNK = (None, "", -1, 0, 2**63, 2**200, 1e-300, 1e300, -1.0, float("nan"), float("inf"), [], {}, b"x", 3 + 4j)

powers = st.floats(-6, 6).map(lambda x: 10.0**x)
solving = st.fixed_dictionaries(
    {},
    optional={
        "solver": st.sampled_from(SOLVERS),
        "tolerance": st.sampled_from([None, 1e-3, 0.1, 1e-6]),
        "max_iterations": st.sampled_from([1, 5, 200]),
        "memory_limit": st.sampled_from([1, 10**5, 10**9]),
        "threads": st.sampled_from([1, 2, 10**6]),
    },
)
scalar = st.fixed_dictionaries(
    {},
    optional={
        "energy": st.sampled_from(ENERGIES),
        "coupling": st.sampled_from(COUPLINGS),
        "delaunay": st.booleans(),
        "sharpness": st.sampled_from([0.0, 0.0, 0.5, 1.0]),
        "dual": st.sampled_from(DUALS),
        "face_weights": st.just("face numbers"),
    },
)
flowing = {
    "iterations": st.integers(0, 4),
    "fidelity": powers,
    "coupling": st.sampled_from(COUPLINGS),
    "scale": st.sampled_from(SCALES),
    "dual": st.sampled_from(DUALS),
}

# Keywords of each tool. Words like "face numbers" stand for arrays made from the mesh and the seed.
TOOLS: dict[str, st.SearchStrategy[dict[str, Any]]] = {
    "operators": st.fixed_dictionaries({"kind": st.sampled_from(ENERGIES), "dual": st.sampled_from(DUALS)}),
    "denoise": st.fixed_dictionaries(
        {"values": st.just("vertex values"), "fidelity": powers},
        optional={"fixed": st.just("some vertices"), "linear_constraints": st.just("constraints")},
    ),
    "interpolate": st.fixed_dictionaries(
        {"indices": st.just("few vertices"), "values": st.just("few values")}
    ),
    "vibration_modes": st.fixed_dictionaries(
        {"count": st.integers(1, 4), "energy": st.sampled_from(ENERGIES)},
        optional={"delaunay": st.booleans()},
    ),
    "stylize": st.fixed_dictionaries(
        {},
        optional={
            **flowing,
            "sharpness": st.floats(0, 1),
            "fixed": st.just("some vertices"),
            "strength": st.just("vertex numbers"),
            "ridge_weights": st.just("face numbers"),
            "delaunay": st.booleans(),
        },
    ),
    "segment": st.fixed_dictionaries(
        {},
        optional={
            "length_weight": powers,
            "fidelity": powers,
            "method": st.sampled_from(["fitted", "paper"]),
            "fillets": st.sampled_from(["automatic", "apart", "joined"]),
            "n_segments": st.sampled_from([1, 3, 1000]),
            "min_faces": st.sampled_from([0, 5]),
            "values": st.just("vertex values"),
            "faces": st.just("some faces"),
            "scale": st.sampled_from(SCALES),
        },
    ),
    "facet": st.fixed_dictionaries(
        {},
        optional={
            "facets": st.sampled_from([1, 3, 12, 10**6]),
            "error": powers,
            "edge_weights": st.just("halfedge numbers"),
            "faces": st.just("some faces"),
            "threads": st.sampled_from([1, 2, 10**6]),
        },
    ),
    "restore": st.fixed_dictionaries(
        {},
        optional={
            "max_move": powers,
            "noise": powers,
            "regularize": st.floats(0, 30),
            "free": st.booleans(),
            "fixed": st.just("some vertices"),
            "faces": st.just("some faces"),
        },
    ),
    "fill_holes": st.fixed_dictionaries(
        {},
        optional={
            **flowing,
            "outer": st.booleans(),
            "sharpness": st.sampled_from(["auto", 0.0, 0.5, 1.0]),
            "max_edges": st.sampled_from([3, 30]),
            "loops": st.sampled_from([[0], [0, 0], [10**6], [[0, 1, 2]]]),
        },
    ),
    "remesh": st.fixed_dictionaries(
        {"iterations": st.integers(0, 3)},
        optional={
            "fixed": st.just("some vertices"),
            "feature_angle": st.sampled_from([None, 0.0, 45.0, 180.0]),
        },
    ),
    "diffusion_curves": st.fixed_dictionaries(
        {"colors": st.just("colors")},
        optional={
            "fidelity": powers,
            "rims": st.booleans(),
            "refine": st.booleans(),
            "color_error": st.sampled_from([0.0, 0.3]),
            "min_faces": st.integers(0, 30),
            "labels": st.just("labels"),
        },
    ),
}


@dataclass(frozen=True)
class Call:
    """A call of a tool."""

    tool: str
    plan: MeshPlan
    keywords: dict[str, Any]
    value_exponent: int
    junk: tuple[int, int] | None
    wish: str | None

    def check(self) -> str:
        """Make the call and check what comes of it; "answer" or the name of the error."""
        rng = np.random.default_rng(self.plan.seed + 1)
        try:
            vertices, faces = self.plan.make()
            mesh = ridgeform.Mesh(vertices, faces)
            given = {name: self._array(word, mesh, rng) for name, word in self.keywords.items()}
            if self.junk and given:
                name = sorted(given)[self.junk[0] % len(given)]
                given[name] = JUNK[self.junk[1] % len(JUNK)]
            before = {name: np.array(value) for name, value in given.items() if isinstance(value, np.ndarray)}
            if self.wish and self.tool != "operators":
                given["progress"] = ridgeform.Progress()
                getattr(given["progress"], self.wish)()
            try:
                getattr(answers, self.tool)(mesh, given, sane=self.junk is None)
            finally:
                for name, value in before.items():
                    np.testing.assert_array_equal(given[name], value, f"{name} was written to")
        except ridgeform.RidgeformError as error:
            assert "internal check" not in str(error), error
            assert str(error) == "cancelled" or len(str(error).split()) > 3, f"no sentence: {error}"
            return type(error).__name__
        except TypeError as error:
            assert self.junk and str(error).split(":")[0] in self.keywords, error
            return "TypeError"
        return "answer"

    def _array(self, word: Any, mesh: ridgeform.Mesh, rng: np.random.Generator) -> Any:
        """What the word stands for on `mesh`."""
        if not isinstance(word, str):
            return word
        n, m, used = mesh.n_vertices, mesh.n_faces, np.unique(mesh.faces)
        few = used[rng.permutation(len(used))[:5]] if len(used) else used
        made = {
            "vertex values": lambda: np.ldexp(rng.normal(size=(n, rng.integers(1, 4))), self.value_exponent),
            "vertex numbers": lambda: rng.random(n),
            "face numbers": lambda: rng.random(m) + 1e-3,
            "halfedge numbers": lambda: rng.random((m, 3)),
            "some vertices": lambda: rng.random(n) < 0.2,
            "some faces": lambda: rng.random(m) < 0.6,
            "few vertices": lambda: few,
            "few values": lambda: np.ldexp(rng.normal(size=len(few)), self.value_exponent),
            "colors": lambda: np.round(rng.random((n, 3)), rng.integers(0, 3)),
            "labels": lambda: rng.integers(0, 4, m),
            "constraints": lambda: (rng.normal(size=(1, n)), np.zeros((1, 1))),
        }
        return made[word]() if word in made else word


@st.composite
def calls(draw: st.DrawFn) -> Call:
    """Any call; one in five with one argument that is junk, one in ten of those with a wish to stop."""
    tool = draw(st.sampled_from(sorted(TOOLS)))
    keywords = dict(draw(TOOLS[tool]))
    if tool in ("denoise", "interpolate"):
        keywords |= draw(scalar)
    if tool in ("denoise", "interpolate", "vibration_modes", "stylize", "segment", "restore", "fill_holes"):
        keywords |= draw(solving)
    rarely = draw(st.integers(0, 19))
    return Call(
        tool,
        draw(mesh_plans()),
        keywords,
        draw(st.sampled_from([0, 0, 0, -30, 30, -500, 500, -1000, 1000])),
        draw(st.tuples(st.integers(0, 99), st.integers(0, 99))) if 13 < rarely < 18 else None,
        draw(st.sampled_from(["cancel", "finish"])) if rarely > 17 else None,
    )
