//! The surface Hessian `H = M_F T C G` (Rowe et al. 2024, eq. (30)) in one pass over the faces.
//!
//! Across an edge of length `l` the gradient of a continuous function jumps only along the edge's normal.
//! With `n` the unit normal into face `f`, `(s_f, h_f)` the foot and height of the opposite corner and
//! `(s_g, h_g)` those of the neighbor unfolded into the plane of `f` ([`triangle::apex`]), that jump is a
//! number times `n`,
//!
//! `δ = n [((1 − s_f/l)/h_f + (1 − s_g/l)/h_g) u_tail + (s_f/(l h_f) + s_g/(l h_g)) u_head`
//! `− u_f/h_f − u_g/h_g]`,
//!
//! so the composition of the gradient (28), the hinge map (29) and the tensor product needs neither a basis
//! for the neighbor nor a rotation. Tests compare the matrices one by one
//! (`factors.rs`).

use crate::block_rows::{BlockRows, BLOCK};
use crate::error::{Error, MeshError, SolveError};
use crate::memory;
use crate::mesh::{triangle, Connectivity, Mesh};
use crate::operators::dual::DualEdge;
use crate::operators::hinge::{directions, usable_area, Hinge};
use crate::operators::Dual;
use crate::unit::Unit;

/// A face's block has up to six columns: its corners and the vertices opposite its edges.
const STENCIL: usize = 6;

/// The columns of every face's block of rows, computed once per connectivity.
#[derive(Debug, Clone, PartialEq)]
pub struct HessianPattern {
    n_columns: usize,
    starts: Vec<usize>,
    columns: Vec<u32>,
    /// Where the face's corners 0, 1, 2 and the vertices opposite its halfedges 0, 1, 2 are in its block.
    slots: Vec<[u8; STENCIL]>,
}

impl HessianPattern {
    /// The pattern of `connectivity`.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn new(connectivity: &Connectivity) -> Result<Self, SolveError> {
        let n_faces = connectivity.n_faces();
        let mut pattern = Self {
            n_columns: connectivity.n_vertices(),
            starts: memory::room(n_faces + 1)?,
            columns: memory::room(STENCIL * n_faces)?,
            slots: memory::room(n_faces)?,
        };
        pattern.starts.push(0);
        for (f, &corners) in connectivity.faces().iter().enumerate() {
            // A missing neighbor repeats a corner: no column of its own, and its slot is never written.
            let mut stencil = [corners[0], corners[1], corners[2], corners[0], corners[0], corners[0]];
            for i in 0..3 {
                if let Some(twin) = connectivity.twin(3 * f + i) {
                    stencil[3 + i] = connectivity.opposite(twin);
                }
            }
            pattern.push(stencil);
        }
        Ok(pattern)
    }

    /// Appends the block of a face with the vertices `stencil`.
    fn push(&mut self, stencil: [u32; STENCIL]) {
        let start = self.columns.len();
        let mut sorted = stencil;
        sorted.sort_unstable();
        for vertex in sorted {
            if self.columns.len() == start || self.columns.last() != Some(&vertex) {
                self.columns.push(vertex);
            }
        }
        let block = &self.columns[start..];
        self.slots.push(stencil.map(|vertex| block.iter().take_while(|&&c| c < vertex).count() as u8));
        self.starts.push(self.columns.len());
    }

    /// The matrix for the given edge lengths: rows `xx, yy, √2·xy` of every face's Hessian in the frame of
    /// [`triangle::layout`], times its area.
    ///
    /// Faces that are degenerate ([`triangle::is_degenerate`]) have zero rows and count as missing for their
    /// neighbors.
    ///
    /// # Errors
    /// [`MeshError::ZeroDualEdge`] with circumcentric duals where two circumcenters coincide;
    /// [`MeshError::LengthRows`] if `lengths` has not one row a face of this pattern's connectivity;
    /// [`SolveError::Memory`].
    pub fn assemble(
        &self,
        connectivity: &Connectivity,
        lengths: &[[f64; 3]],
        dual: Dual,
    ) -> crate::Result<BlockRows> {
        let mut rows = BlockRows {
            n_columns: self.n_columns,
            starts: memory::twin(&self.starts)?,
            columns: memory::twin(&self.columns)?,
            values: memory::room(self.columns.len())?,
        };
        self.assemble_into(connectivity, lengths, dual, &mut rows)?;
        Ok(rows)
    }

    /// [`HessianPattern::assemble`] into a matrix that the same pattern has made before.
    ///
    /// # Errors
    /// As [`HessianPattern::assemble`]; then the values of `rows` are unspecified.
    pub fn assemble_into(
        &self,
        connectivity: &Connectivity,
        lengths: &[[f64; 3]],
        dual: Dual,
        rows: &mut BlockRows,
    ) -> crate::Result<()> {
        let n_faces = self.slots.len();
        if lengths.len() != n_faces || connectivity.n_faces() != n_faces {
            return Err(MeshError::LengthRows { rows: lengths.len(), n_faces }.into());
        }
        memory::grow(&mut rows.values, self.columns.len(), [0.0; BLOCK])?;
        let areas: Vec<f64> = memory::gathered(lengths.iter().map(|&l| usable_area(l)))?;
        for (f, slots) in self.slots.iter().enumerate() {
            let block = &mut rows.values[self.starts[f]..self.starts[f + 1]];
            block.fill([0.0; BLOCK]);
            let stencil = face_block(connectivity, lengths, &areas, dual, f)?;
            for (&slot, entry) in slots.iter().zip(stencil) {
                for (value, x) in block[usize::from(slot)].iter_mut().zip(entry) {
                    *value += x;
                }
            }
        }
        Ok(())
    }
}

/// The rows of face `f`: for its corners 0, 1, 2 and the vertices opposite its halfedges 0, 1, 2.
fn face_block(
    connectivity: &Connectivity,
    lengths: &[[f64; 3]],
    areas: &[f64],
    dual: Dual,
    f: usize,
) -> Result<[[f64; BLOCK]; STENCIL], MeshError> {
    let mut stencil = [[0.0; BLOCK]; STENCIL];
    if areas[f] == 0.0 {
        return Ok(stencil);
    }
    for (i, direction) in directions(lengths[f], areas[f]).into_iter().enumerate() {
        let Some(twin) = connectivity.twin(3 * f + i).filter(|twin| areas[twin / 3] > 0.0) else { continue };
        let hinge = Hinge::new(lengths, areas, 3 * f + i, twin);
        let edge =
            DualEdge::new(dual, &hinge).ok_or(MeshError::ZeroDualEdge { face: f, neighbor: twin / 3 })?;
        let tensor = edge.tensor(direction, areas[f]);
        for (place, coefficient) in [(i + 1) % 3, (i + 2) % 3, i, i + 3].into_iter().zip(hinge.jump()) {
            for (value, t) in stencil[place].iter_mut().zip(tensor) {
                *value += coefficient * t;
            }
        }
    }
    Ok(stencil)
}

/// The matrix `H` of Rowe et al. 2024, eq. (30): `4m × n`, rows `xx, xy, yx, yy` of every face's Hessian
/// times its area, in the frame of eq. (28).
///
/// # Errors
/// [`MeshError::ZeroDualEdge`] with circumcentric duals where two circumcenters coincide.
pub fn hessian(mesh: &Mesh, dual: Dual) -> Result<sprs::CsMat<f64>, Error> {
    let rows = assembled(mesh.measured(mesh.unit())?.as_ref(), dual)?;
    let n_entries = 4 * rows.columns.len();
    let mut indptr = memory::room(4 * rows.n_blocks() + 1)?;
    let mut indices = memory::room(n_entries)?;
    let mut data = memory::room(n_entries)?;
    indptr.push(0);
    for b in 0..rows.n_blocks() {
        let (columns, values) = rows.block(b);
        let entries: [fn(&[f64; BLOCK]) -> f64; 4] =
            [|v| v[0], |v| v[2] / std::f64::consts::SQRT_2, |v| v[2] / std::f64::consts::SQRT_2, |v| v[1]];
        for entry in entries {
            indices.extend(columns.iter().map(|&c| c as usize));
            data.extend(values.iter().map(entry));
            indptr.push(indices.len());
        }
    }
    Ok(sprs::CsMat::new((4 * rows.n_blocks(), rows.n_columns), indptr, indices, data))
}

/// The rows of every face, which have no unit; `mesh` of a size whose powers are numbers.
pub(super) fn assembled(mesh: &Mesh, dual: Dual) -> crate::Result<BlockRows> {
    let pattern = HessianPattern::new(mesh.connectivity())?;
    pattern.assemble(mesh.connectivity(), mesh.edge_lengths(), dual)
}

/// The Frobenius norm `‖H_f(u)‖` of every face's Hessian, not times its area, of `values` (column-major, `n`
/// rows): one number a face, jointly over the columns. Degenerate faces have 0.
///
/// # Errors
/// [`Error::Argument`] if `values` are not whole columns, [`crate::error::SolveError::NoNumber`],
/// and the errors of [`hessian`].
pub fn hessian_norm(mesh: &Mesh, values: &[f64], dual: Dual) -> Result<Vec<f64>, Error> {
    let (length, value) = (mesh.unit(), Unit::of(values.iter().copied()));
    let unit = value.times(length.power(-2));
    let mesh = mesh.measured(length)?;
    let rows = assembled(&mesh, dual)?;
    let mut norms = rows.block_squares(&value.measure_all(values))?;
    norms.iter_mut().for_each(|norm| *norm = norm.sqrt());
    for (norm, &l) in norms.iter_mut().zip(mesh.edge_lengths()) {
        if *norm > 0.0 {
            *norm = unit.restore_finite("the Hessian", *norm / triangle::area(l))?;
        }
    }
    Ok(norms)
}
