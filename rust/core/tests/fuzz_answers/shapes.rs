//! Meshes that nobody modeled: most have a few faces, since a fault of connections or of numbers that is
//! there shows on few (Jackson 2012, small scope), and a call on them takes a thousandth of a second.

use ridgeform_core::shapes::{cube, grid, icosphere, torus, Random, Shape};

use super::{any, below};

/// A mesh for one call. Nine in ten are tiny.
pub(crate) fn shape(random: &mut Random) -> Shape {
    let mut shape = if below(random, 10) == 0 { small(random) } else { tiny(random) };
    if below(random, 2) == 0 {
        fault(&mut shape, random);
    }
    sized(&mut shape, random);
    shape
}

/// A shape of up to some hundred faces.
fn small(random: &mut Random) -> Shape {
    let k = 1 + below(random, 4) as usize;
    let shape = match below(random, 5) {
        0 => grid(2 * k, 2 * k),
        1 => icosphere(k.div_ceil(2)),
        2 => torus(3 * k, 2 + k, 1.0, 0.4),
        3 => cube(k),
        _ => soup(4 * k as u64, 6 * k, random),
    };
    if below(random, 2) == 0 {
        shape.noisy([0.05, 0.5][below(random, 2) as usize], random.bits())
    } else {
        shape
    }
}

/// Faces between any of `n` vertices, which may name one twice.
fn soup(n: u64, faces: usize, random: &mut Random) -> Shape {
    let vertices = (0..n).map(|_| std::array::from_fn(|_| random.symmetric())).collect();
    let mut corner = || below(random, n) as u32;
    Shape { vertices, faces: (0..faces).map(|_| [corner(), corner(), corner()]).collect() }
}

/// Up to some forty faces: how they are joined is drawn first, then where their vertices are.
fn tiny(random: &mut Random) -> Shape {
    let k = 1 + below(random, 9) as u32;
    let (mut faces, n) = connections(k, random);
    if below(random, 8) == 0 {
        // A second piece of the same kind, apart or at one vertex.
        let shift = if below(random, 2) == 0 { n } else { n - 1 };
        faces.extend(faces.clone().into_iter().map(|f| f.map(|v| v + shift)));
    }
    let n = faces.iter().flatten().max().map_or(n, |v| n.max(v + 1));
    let mut vertices = places(n, random);
    if below(random, 8) == 0 {
        let (a, b) = (below(random, n.into()) as usize, below(random, n.into()) as usize);
        vertices[a] = vertices[b];
    }
    Shape { vertices, faces }
}

/// Faces and how many vertices they have.
fn connections(k: u32, random: &mut Random) -> (Vec<[u32; 3]>, u32) {
    let wheel = |closed: bool| {
        let last = if closed { k.max(3) } else { k };
        let next = |i| if closed { 1 + (i + 1) % last } else { 2 + i };
        ((0..last).map(|i| [0, 1 + i, next(i)]).collect::<Vec<_>>(), last + 2)
    };
    match below(random, 12) {
        // A fan, a cone, a double cone.
        0 => wheel(false),
        1 => wheel(true),
        2 => {
            let (mut faces, n) = wheel(true);
            faces.extend(faces.clone().into_iter().map(|[_, b, c]| [n - 1, c, b]));
            (faces, n)
        }
        // A strip, open or closed to a band or a band with a twist.
        3 => ((0..k).map(|i| [i, i + 1 + i % 2, i + 2 - i % 2]).collect(), k + 2),
        4 => {
            let n = k + 4;
            let faces = (0..n).map(|i| [i % n, (i + 1 + i % 2) % n, (i + 2 - i % 2) % n]).collect();
            (faces, n)
        }
        // Pages of a book: all at one edge.
        5 => ((0..k).map(|i| [0, 1, 2 + i]).collect(), k + 2),
        // Every triple of few vertices that a coin picks.
        6 => {
            let n = 3 + k % 4;
            let triples = (0..n).flat_map(|a| (0..a).flat_map(move |b| (0..b).map(move |c| [a, b, c])));
            let mut faces: Vec<_> = triples.filter(|_| below(random, 2) == 0).collect();
            faces.push([0, 1, 2]);
            (faces, n)
        }
        // The same face, in any order of its corners.
        7 => {
            let orders = [[0, 1, 2], [1, 2, 0], [0, 2, 1], [2, 1, 0]];
            ((0..k).map(|_| any(random, &orders)).collect(), 3)
        }
        8 => (cube(1).faces, 8),
        9 => {
            let side = 1 + u64::from(k) % 4;
            let shape = grid(side as usize, 1 + below(random, 4) as usize);
            (shape.faces, shape.vertices.len() as u32)
        }
        10 => (torus(3, 3, 1.0, 0.4).faces, 9),
        _ => {
            let n = 3 + below(random, 6) as u32;
            let mut corner = || below(random, n.into()) as u32;
            ((0..2 * k).map(|_| [corner(), corner(), corner()]).collect(), n)
        }
    }
}

/// Where `n` vertices are: anywhere, on few places so that much coincides or lies in line, in a plane, on
/// a line, on a sphere, or nearly so.
fn places(n: u32, random: &mut Random) -> Vec<[f64; 3]> {
    let kind = below(random, 7);
    let width = 2 + below(random, 3);
    let step = any(random, &[1.0, 1.0, 0.1, 1.0 / 3.0]);
    let small = any(random, &[0.0, 0.0, 1e-16, 1e-12, 1e-6]);
    let place = |i: u32| {
        let mut free = || -> [f64; 3] { std::array::from_fn(|_| random.symmetric()) };
        let p = free();
        let off = free().map(|x| small * x);
        let on: [f64; 3] = match kind {
            0 => return p,
            1 => std::array::from_fn(|_| below(random, width) as f64 * step),
            2 => [below(random, width) as f64 * step, below(random, width) as f64 * step, 0.0],
            3 => [p[0], p[1], 0.0],
            4 => p.map(|_| f64::from(i) * step),
            5 => {
                let length = p.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
                p.map(|x| x / length)
            }
            _ => {
                let (s, c) = (std::f64::consts::TAU * f64::from(i) / f64::from(n)).sin_cos();
                [c, s, p[2] * step]
            }
        };
        std::array::from_fn(|c| on[c] + off[c])
    };
    (0..n).map(place).collect()
}

/// One fault, somewhere.
fn fault(shape: &mut Shape, random: &mut Random) {
    let (n, m) = (shape.vertices.len() as u64, shape.faces.len() as u64);
    let f = below(random, m) as usize;
    let face = shape.faces[f];
    match below(random, 11) {
        0 => {
            let share = random.uniform() * 0.4;
            shape.faces.retain(|_| random.uniform() >= share);
        }
        1 => shape.faces.push([face[0], face[1], below(random, n) as u32]),
        2 => shape.faces.push(face),
        3 => shape.faces.extend(shape.faces.clone().into_iter().map(|[a, b, c]| [c, b, a])),
        4 => shape.faces[f][1] = face[0],
        5 => shape.vertices[face[0] as usize] = shape.vertices[face[1] as usize],
        6 => {
            let height = any(random, &[0.0, 1e-16, 1e-9, 1e-3]);
            shape.vertices.iter_mut().for_each(|p| p[1] *= height);
        }
        7 => shape.vertices.extend([[3.0, 1.0, 2.0], [0.0; 3]]),
        8 => shape.faces[f].swap(0, 1),
        // A vertex in the middle of an edge, to which it is not joined.
        9 => {
            let [a, b] = [face[0], face[1]].map(|v| shape.vertices[v as usize]);
            shape.vertices[below(random, n) as usize] = std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
        }
        // All in one place.
        _ => shape.vertices.fill([2.5, 0.0, -1.0]),
    }
}

/// The vertices, of any size.
fn sized(shape: &mut Shape, random: &mut Random) {
    let exponent = below(random, 2000) as i32 - 1000;
    let power = |e: i32| 2_f64.powi(e / 2) * 2_f64.powi(e - e / 2);
    match below(random, 12) {
        0 => shape.vertices.iter_mut().flatten().for_each(|x| *x *= power(exponent)),
        1 => shape.vertices.iter_mut().for_each(|p| {
            let size = 10_f64.powf(30.0 * random.symmetric());
            *p = p.map(|x| size * x);
        }),
        2 => shape.vertices.iter_mut().flatten().for_each(|x| *x += power(exponent.abs() % 54)),
        3 => shape.vertices.iter_mut().flatten().for_each(|x| *x = (*x * 50.0).round() * 5e-324),
        _ => {}
    }
}
