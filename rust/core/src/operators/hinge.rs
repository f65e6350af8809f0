//! Two faces unfolded about their edge: what the Hessian, its dual edges and the energies share.

use crate::mesh::triangle;

/// The area of every face, 0 for degenerate ones.
pub(crate) fn usable_areas(lengths: &[[f64; 3]]) -> Vec<f64> {
    lengths.iter().map(|&l| usable_area(l)).collect()
}

/// The area of a face, 0 of a degenerate one.
pub(crate) fn usable_area(l: [f64; 3]) -> f64 {
    if triangle::is_degenerate(l) {
        0.0
    } else {
        triangle::area(l)
    }
}

/// The unit directions of a face's halfedges in its own frame.
pub(crate) fn directions(l: [f64; 3], area: f64) -> [[f64; 2]; 3] {
    let [s, h] = triangle::apex(l, 2, area);
    [[(s - l[2]) / l[0], h / l[0]], [-s / l[1], -h / l[1]], [1.0, 0.0]]
}

/// Two faces unfolded into one plane about their shared edge. Origin at the start of the halfedge of `f`,
/// x along it, y into `f`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hinge {
    /// Length of the shared edge.
    pub length: f64,
    /// Foot and height of the corner of `f` opposite the edge.
    pub face: [f64; 2],
    /// Foot and height of the neighbor's opposite corner; the height counts away from `f`.
    pub neighbor: [f64; 2],
}

impl Hinge {
    /// The hinge at halfedge `h` with the given `twin`; both faces must have an area.
    pub(crate) fn new(lengths: &[[f64; 3]], areas: &[f64], h: usize, twin: usize) -> Self {
        let (f, g) = (h / 3, twin / 3);
        let length = lengths[f][h % 3];
        let [foot, height] = triangle::apex(lengths[g], twin % 3, areas[g]);
        // The twin runs the other way.
        Self { length, face: triangle::apex(lengths[f], h % 3, areas[f]), neighbor: [length - foot, height] }
    }

    /// The jump of the gradient, neighbor less face, along the normal into `f`: the coefficients of the
    /// values at the halfedge's tail and head, at the opposite corner of `f` and at that of the neighbor.
    pub(crate) fn jump(&self) -> [f64; 4] {
        let ([s_f, h_f], [s_g, h_g]) = (self.face, self.neighbor);
        let (face, neighbor) = (1.0 / h_f, 1.0 / h_g);
        let head = (s_f * face + s_g * neighbor) / self.length;
        [face + neighbor - head, head, -face, -neighbor]
    }
}
