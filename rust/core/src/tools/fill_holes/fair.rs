//! Smooth parts between sharp ridges: the patch is cut along its ridges,
//! and each part is as smooth as what it continues.

use super::constants::RIDGE_STIFFNESS;
use super::guard::move_guarded;
use super::region::Region;
use super::ridge_curves::third_derivatives;
use super::surface::FaceGeometry;
use crate::block_rows::BlockRows;
use crate::linear::Columns;
use crate::memory;
use crate::mesh::partition::Partition;
use crate::mesh::vector::norm;
use crate::mesh::Mesh;
use crate::operators::{Dual, Energy, EnergyForm};
use crate::progress::Progress;
use crate::solve::{quadratic, Coupling, Problem, Settings};
use crate::Result;

/// Moves the patch to the minimizer of the L2 Hessian energy of its coordinates on both sides of its ridges,
/// everything around it fixed; edges bent by more than `ridge` radians are ridges. Returns the longest move.
///
/// The surface is cut along the ridges and its parts stay joined there: with the natural boundary conditions
/// of the energy (Stein et al. 2018b) each part goes on as the surface that it continues, a plane as a plane,
/// and the ridge lies where the parts meet; the squared third derivative along the ridges
/// ([`third_derivatives`]) is added.
pub(super) fn fair(region: &mut Region, ridge: f64, progress: &Progress) -> Result<f64> {
    let cut = Cut::new(region, ridge)?;
    let points = memory::gathered(cut.origin.iter().map(|&v| region.mesh.position(v)))?;
    let form = EnergyForm::new(Energy::L2Hessian, &Mesh::new(points, cut.faces)?, None, Dual::default())?;
    let ridges = third_derivatives(region, ridge)?;
    let n_blocks = form.operator.n_blocks() + ridges.len();
    let n_entries = form.operator.columns.len() + 4 * ridges.len();
    let mut joined = BlockRows::with_room(region.mesh.n_vertices(), n_blocks, n_entries)?;
    for b in 0..form.operator.n_blocks() {
        let (columns, values) = form.operator.block(b);
        joined.push_block(columns.iter().zip(values).map(|(&c, &value)| (cut.origin[c as usize], value)));
    }
    let mut weights = form.weights;
    let area: f64 = region.patch_faces().map(|(f, _)| norm(region.mesh.area_vector(f))).sum();
    for (vertices, coefficients, length) in ridges {
        joined.push_block(vertices.into_iter().zip(coefficients).map(|(v, c)| (v, [c, 0.0, 0.0])));
        memory::extend(&mut weights, 1)?;
        weights.push(RIDGE_STIFFNESS * area.powf(1.5) * length);
    }
    let problem = Problem {
        operator: &joined,
        weights,
        fidelity: memory::repeated(0.0, joined.n_columns)?,
        target: Columns::from_points(region.mesh.positions())?,
        fixed: region.fixed()?,
        linear_constraints: None,
        coupling: Coupling::Joint,
    };
    let settings = Settings { announce: false, ..Settings::default() };
    let goal = quadratic::minimize(&problem, &settings, &progress.patient())?.values.to_points()?;
    move_guarded(region, &goal)
}

/// A region cut along its ridges.
struct Cut {
    faces: Vec<[u32; 3]>,
    /// The vertex of the region of every vertex here; those on ridges are there several times.
    origin: Vec<u32>,
}

impl Cut {
    fn new(region: &Region, ridge: f64) -> Result<Self> {
        let mesh = &region.mesh;
        let surface = FaceGeometry::of(region)?;
        let faces = region.faces()?;
        // Corners of faces that are one vertex, as a forest: across every edge that is no ridge.
        let mut corners = Partition::new(3 * faces.len())?;
        let corner =
            |f: u32, v: u32| 3 * f + faces[f as usize].iter().position(|&w| w == v).unwrap_or(0) as u32;
        for [a, b] in mesh.edges()? {
            let Some(wings) = mesh.wings(a, b) else { continue };
            let [f, g] = wings.faces;
            if surface.dihedral([f, g]) > ridge {
                continue;
            }
            for v in [a, b] {
                corners.unite(corner(f, v), corner(g, v));
            }
        }
        let mut number = memory::repeated(u32::MAX, 3 * faces.len())?;
        let mut origin = Vec::new();
        let mut cut = memory::twin(&faces)?;
        for (f, face) in faces.iter().enumerate() {
            for (i, &v) in face.iter().enumerate() {
                let r = corners.root((3 * f + i) as u32) as usize;
                if number[r] == u32::MAX {
                    number[r] = origin.len() as u32;
                    memory::push(&mut origin, v)?;
                }
                cut[f][i] = number[r];
            }
        }
        Ok(Self { faces: cut, origin })
    }
}
