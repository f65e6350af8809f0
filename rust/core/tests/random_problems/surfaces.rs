//! Random surfaces: closed and open, regular and noisy, in several parts, with slivers,
//! of any size and scale.

use ridgeform_core::shapes::{self, Random, Shape};

/// A surface with roughly `n` vertices, and what it is.
pub(super) fn surface(random: &mut Random, n: usize) -> (&'static str, Shape) {
    let side = ((n as f64).sqrt() as usize).max(2);
    let cube = ((n as f64 / 6.0).sqrt() as usize).max(1);
    let level = if n < 30 { 0 } else { ((n as f64 / 10.0).ln() / 4f64.ln()) as usize };
    let stretch = 10f64.powf(-3.0 * random.uniform());
    let (name, shape, spacing) = match (random.bits() % 10, n) {
        (0, ..20) => ("a tetrahedron", shapes::tetrahedron(), 1.0),
        (1, ..20) => ("a square", shapes::grid(1, 1), 1.0),
        (0, _) => ("a sphere", shapes::icosphere(level), 1.0 / 2f64.powi(level as i32)),
        (1, _) => ("a cube", shapes::cube(cube), 2.0 / cube as f64),
        (2, _) => ("a torus", shapes::torus(2 * side + 3, side / 2 + 3, 1.0, 0.4), 2.0 / side as f64),
        (3, _) => ("a cylinder", shapes::cylinder(side + 2, side, 1.0, 3.0), 3.0 / side as f64),
        (4, _) => ("a lattice", shapes::lattice(side, side), 1.0),
        (5, _) => ("a hilly grid", hills(shapes::grid(side, side)), 1.0),
        (6, _) => {
            let pierced = shapes::icosphere(level.max(1));
            let spared: Vec<bool> = pierced.faces.iter().map(|_| random.uniform() < 0.9).collect();
            ("a sphere with holes", pierced.without_faces(|f| !spared[f]), 0.5 / 2f64.powi(level as i32))
        }
        (7, _) => {
            let half = ((n as f64 / 2.0).sqrt() as usize).max(2);
            let other = shapes::cube((cube / 2).max(1)).map(|p| p.map(|x| x - 3.0));
            (
                "a grid and a cube",
                shapes::grid(half, half).map(|p| p.map(|x| x / half as f64)).and(&other),
                0.1,
            )
        }
        (8, _) => {
            ("slivers", shapes::grid(side, side).map(|[x, y, z]| [x + 0.5 * y, stretch * y, z]), stretch)
        }
        _ => {
            let squeezed = shapes::torus(2 * side + 3, side / 2 + 3, 1.0, 0.4);
            (
                "a squeezed torus",
                squeezed.map(|[x, y, z]| [x, 10.0 * stretch * y, z]),
                2.0 * stretch / side as f64,
            )
        }
    };
    let noise = if random.uniform() < 0.3 { 0.0 } else { 0.25 * random.uniform() };
    let scale = 10f64.powf(3.0 * random.symmetric());
    let (axis, angle) = (std::array::from_fn(|_| random.symmetric() + 1e-3), 6.0 * random.uniform());
    let shape = shape.noisy(noise * spacing, random.bits()).rotated(axis, angle);
    (name, shape.map(|p| p.map(|x| scale * x)))
}

fn hills(flat: Shape) -> Shape {
    flat.map(|[x, y, _]| [x, y, 2.0 * (0.4 * x).sin() * (0.3 * y).cos()])
}

/// A number for each vertex, the same for all vertices of a connected part.
pub(super) fn parts(faces: &[[u32; 3]], n: usize) -> Vec<usize> {
    let mut part: Vec<usize> = (0..n).collect();
    loop {
        let mut changed = false;
        for face in faces {
            let corners = face.map(|v| v as usize);
            let least = corners.map(|v| part[v]).into_iter().fold(n, usize::min);
            for v in corners {
                changed |= part[v] != least;
                part[v] = least;
            }
        }
        if !changed {
            return part;
        }
    }
}
