//! What all parts of the segmentation know of the surface: sizes in the chosen unit, neighbors, frames.

use crate::mesh::partition::contiguous;
use crate::mesh::vector::area_vector;
use crate::mesh::{edge_lengths, triangle, Connectivity};
use crate::operators::mollify;
use crate::{memory, Result};

/// No face.
pub(super) const NONE: u32 = u32::MAX;

/// The surface in the unit of the segmentation.
pub(super) struct Surface<'a> {
    pub connectivity: &'a Connectivity,
    /// Positions of the vertices.
    pub positions: Vec<[f64; 3]>,
    /// Mollified edge lengths.
    pub lengths: Vec<[f64; 3]>,
    /// Areas of the faces.
    pub areas: Vec<f64>,
    /// Centroids of the faces.
    pub centroids: Vec<[f64; 3]>,
    /// The face across each halfedge, or [`NONE`].
    pub neighbors: Vec<[u32; 3]>,
    /// What a border along each halfedge costs per length, 1 where nothing was asked for.
    pub costs: Vec<[f64; 3]>,
    /// Mean length of the edges.
    pub mean_edge: f64,
}

impl<'a> Surface<'a> {
    /// The surface with all lengths divided by `unit`.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn new(
        connectivity: &'a Connectivity,
        positions: &[[f64; 3]],
        unit: f64,
        costs: Vec<[f64; 3]>,
    ) -> Result<Self> {
        let positions: Vec<[f64; 3]> = memory::gathered(positions.iter().map(|p| p.map(|x| x / unit)))?;
        let mut lengths = edge_lengths(connectivity.faces(), &positions)?;
        mollify(connectivity, &mut lengths);
        let areas = memory::gathered(lengths.iter().map(|&l| triangle::area(l)))?;
        let centroid = |face: &[u32; 3]| {
            std::array::from_fn(|c| face.iter().map(|&v| positions[v as usize][c]).sum::<f64>() / 3.0)
        };
        let across = |h: usize| connectivity.twin(h).map_or(NONE, |twin| (twin / 3) as u32);
        let neighbors = (0..connectivity.n_faces()).map(|f| [0, 1, 2].map(|i| across(3 * f + i)));
        let (sum, count) = connectivity
            .edges()
            .fold((0.0, 0_usize), |(sum, count), h| (sum + lengths[h / 3][h % 3], count + 1));
        Ok(Self {
            centroids: memory::gathered(connectivity.faces().iter().map(centroid))?,
            connectivity,
            positions,
            areas,
            neighbors: memory::gathered(neighbors)?,
            costs,
            mean_edge: sum / count.max(1) as f64,
            lengths,
        })
    }

    /// Number of faces.
    pub(super) fn n_faces(&self) -> usize {
        self.areas.len()
    }

    /// The faces next to `f`, each with the halfedge of `f` that leads there.
    pub(super) fn around(&self, f: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.neighbors[f]
            .iter()
            .enumerate()
            .filter(|(_, g)| **g != NONE)
            .map(move |(i, g)| (3 * f + i, *g as usize))
    }

    /// Whether a neighbor of `f` has another label.
    pub(super) fn is_at_border(&self, labels: &[u32], f: usize) -> bool {
        self.around(f).any(|(_, g)| labels[g] != labels[f])
    }

    /// The vector area of face `f`: its normal times its area.
    pub(super) fn vector_area(&self, f: usize) -> [f64; 3] {
        area_vector(self.connectivity.faces()[f].map(|v| self.positions[v as usize]))
    }
}

/// Renumbers the labels in place, as [`contiguous`] does, and lists the faces of each segment.
pub(super) fn members(labels: &mut Vec<u32>) -> Result<Vec<Vec<u32>>> {
    let (fresh, count) = contiguous(labels)?;
    *labels = fresh;
    let mut members = memory::repeated(Vec::new(), count)?;
    for (f, &label) in (0_u32..).zip(labels.iter()) {
        memory::push(&mut members[label as usize], f)?;
    }
    Ok(members)
}

/// The connected pieces of equal labels, numbered in the order of their first faces, and how many there are.
pub(super) fn pieces(surface: &Surface<'_>, labels: &[u32]) -> Result<(Vec<u32>, usize)> {
    let mut piece = memory::repeated(NONE, labels.len())?;
    let (mut count, mut stack) = (0, Vec::new());
    for start in 0..labels.len() {
        if piece[start] != NONE {
            continue;
        }
        piece[start] = count;
        memory::push(&mut stack, start)?;
        while let Some(f) = stack.pop() {
            for (_, g) in surface.around(f) {
                if piece[g] == NONE && labels[g] == labels[f] {
                    piece[g] = count;
                    memory::push(&mut stack, g)?;
                }
            }
        }
        count += 1;
    }
    Ok((piece, count as usize))
}
