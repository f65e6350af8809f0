//! Small shapes with known properties, for tests and benchmarks.

use std::collections::HashMap;

use crate::mesh::Mesh;
pub use crate::random::Random;
use crate::Result;

/// Vertices and faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Positions.
    pub vertices: Vec<[f64; 3]>,
    /// Vertex triples.
    pub faces: Vec<[u32; 3]>,
}

impl Shape {
    /// The shape as a mesh.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn mesh(&self) -> Result<Mesh> {
        Mesh::new(self.vertices.clone(), self.faces.clone())
    }

    /// Every vertex replaced by `f` of it.
    #[must_use]
    pub fn map(mut self, mut f: impl FnMut([f64; 3]) -> [f64; 3]) -> Self {
        for p in &mut self.vertices {
            *p = f(*p);
        }
        self
    }

    /// Every coordinate moved by up to `amplitude` either way.
    #[must_use]
    pub fn noisy(mut self, amplitude: f64, seed: u64) -> Self {
        let mut random = Random::new(seed);
        for x in self.vertices.iter_mut().flatten() {
            *x += amplitude * random.symmetric();
        }
        self
    }

    /// Turned by `angle` radians about `axis` (not zero).
    #[must_use]
    pub fn rotated(self, axis: [f64; 3], angle: f64) -> Self {
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [x, y, z] = axis.map(|a| a / length);
        let (s, c) = angle.sin_cos();
        self.map(|p| {
            let along = (1.0 - c) * (x * p[0] + y * p[1] + z * p[2]);
            let cross = [y * p[2] - z * p[1], z * p[0] - x * p[2], x * p[1] - y * p[0]];
            [
                c * p[0] + s * cross[0] + along * x,
                c * p[1] + s * cross[1] + along * y,
                c * p[2] + s * cross[2] + along * z,
            ]
        })
    }

    /// Both shapes, not connected.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.faces.extend(other.faces.iter().map(|f| f.map(|v| v + offset)));
        self
    }

    /// Without the faces for which `remove` holds.
    #[must_use]
    pub fn without_faces(mut self, remove: impl Fn(usize) -> bool) -> Self {
        let mut f = 0;
        self.faces.retain(|_| {
            f += 1;
            !remove(f - 1)
        });
        self
    }

    /// Every face split into four, the edge midpoints passed through `place`.
    #[must_use]
    fn split(&self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let mut vertices = self.vertices.clone();
        let mut midpoints = HashMap::new();
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        for &[a, b, c] in &self.faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *midpoints.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let (u, v) = (self.vertices[p as usize], self.vertices[q as usize]);
                    vertices.push(place([0, 1, 2].map(|k| 0.5 * (u[k] + v[k]))));
                    vertices.len() as u32 - 1
                })
            });
            faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { vertices, faces }
    }
}

/// A grid of `(nx + 1) × (ny + 1)` vertices at `place(i, j)`, each cell split along its diagonal; where
/// `wrap_x` or `wrap_y`, the last column or row is the first one again.
fn sheet(n: [usize; 2], wrap: [bool; 2], place: impl Fn(usize, usize) -> [f64; 3]) -> Shape {
    let [nx, ny] = n;
    let columns = if wrap[0] { nx } else { nx + 1 };
    let rows = if wrap[1] { ny } else { ny + 1 };
    let vertex = |i: usize, j: usize| ((j % rows) * columns + i % columns) as u32;
    let vertices =
        (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).map(|(i, j)| place(i, j)).collect();
    let mut faces = Vec::with_capacity(2 * nx * ny);
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Shape { vertices, faces }
}

/// A flat grid of unit squares in the xy plane, each split along its diagonal.
#[must_use]
pub fn grid(nx: usize, ny: usize) -> Shape {
    sheet([nx, ny], [false; 2], |i, j| [i as f64, j as f64, 0.0])
}

/// A flat lattice of equilateral triangles of edge length 1, in the xy plane.
#[must_use]
pub fn lattice(nx: usize, ny: usize) -> Shape {
    let mut shape =
        sheet([nx, ny], [false; 2], |i, j| [i as f64 - 0.5 * j as f64, j as f64 * 0.75_f64.sqrt(), 0.0]);
    let shift = 0.5 * ny as f64;
    shape.vertices.iter_mut().for_each(|p| p[0] += shift);
    shape
}

/// An open cylinder about the z axis.
#[must_use]
pub fn cylinder(around: usize, along: usize, radius: f64, height: f64) -> Shape {
    sheet([around, along], [true, false], |i, j| {
        let (s, c) = (std::f64::consts::TAU * i as f64 / around as f64).sin_cos();
        [radius * c, radius * s, height * j as f64 / along as f64]
    })
}

/// A ring of `2 n` faces around a round hole of radius 1, and the boundary loop of that hole.
#[must_use]
pub fn ring(n: usize) -> (Shape, Vec<u32>) {
    let shape = sheet([n, 1], [true, false], |i, j| {
        let (s, c) = (-std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
        let radius = 1.0 + 0.01 * j as f64;
        [radius * c, radius * s, 0.3 * radius]
    });
    (shape, (0..n as u32).rev().collect())
}

/// A torus about the z axis.
#[must_use]
pub fn torus(around: usize, across: usize, major: f64, minor: f64) -> Shape {
    sheet([around, across], [true; 2], |i, j| {
        let (s, c) = (std::f64::consts::TAU * i as f64 / around as f64).sin_cos();
        let (sin, cos) = (std::f64::consts::TAU * j as f64 / across as f64).sin_cos();
        [(major + minor * cos) * c, (major + minor * cos) * s, minor * sin]
    })
}

/// A regular tetrahedron inscribed in the unit sphere, faces outwards.
#[must_use]
pub fn tetrahedron() -> Shape {
    let r = (1.0_f64 / 3.0).sqrt();
    Shape {
        vertices: vec![[r, r, r], [r, -r, -r], [-r, r, -r], [-r, -r, r]],
        faces: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    }
}

/// An icosahedron split `levels` times, on the unit sphere: `20 · 4^levels` faces.
#[must_use]
pub fn icosphere(levels: usize) -> Shape {
    let unit = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let vertices = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ];
    let faces = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    let mut shape = Shape { vertices: vertices.map(unit).to_vec(), faces: faces.to_vec() };
    for _ in 0..levels {
        shape = shape.split(unit);
    }
    shape
}

/// The cube `[-1, 1]³`, every side a grid of `n × n` squares split along their diagonals, faces outwards.
#[must_use]
pub fn cube(n: usize) -> Shape {
    let mut shape = Shape { vertices: Vec::new(), faces: Vec::new() };
    let mut seen: HashMap<[usize; 3], u32> = HashMap::new();
    for axis in 0..3 {
        for side in [0, n] {
            let mut vertex = |i: usize, j: usize| {
                let mut key = [0; 3];
                key[axis] = side;
                // On the lower side the two other axes swap,
                // so that faces run counterclockwise seen from outside.
                let (u, v) = if side == n {
                    ((axis + 1) % 3, (axis + 2) % 3)
                } else {
                    ((axis + 2) % 3, (axis + 1) % 3)
                };
                (key[u], key[v]) = (i, j);
                *seen.entry(key).or_insert_with(|| {
                    shape.vertices.push(key.map(|k| 2.0 * k as f64 / n as f64 - 1.0));
                    shape.vertices.len() as u32 - 1
                })
            };
            for j in 0..n {
                for i in 0..n {
                    let [a, b, c, d] =
                        [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                    shape.faces.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    shape
}
