//! What a border costs for its length: less in a hollow (minima rule: Hoffman and Richards 1984), and
//! where the thickness changes.
//!
//! Both are judged over a scale, not an edge, so that neither noise nor a finer mesh makes them.

use rayon::prelude::*;

use super::constants::{
    BEND_OF_A_THIRD, BEND_SCALE, CHANGE_OF_A_THIRD, HOLLOW, LEAST_SHARE, THICKNESS_SCALE,
};
use super::diffusion::{diffused, Link};
use super::graph::{Edge, Graph};
use super::surface::Surface;
use super::thickness::thickness;
use crate::mesh::vector::{dot, sub, unit};
use crate::progress::Progress;
use crate::{memory, Result};

/// The faces as a graph whose edges cost what borders cost.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn border_graph(surface: &Surface, progress: &Progress) -> Result<Graph> {
    let flow = |length: f64, distance: f64| length / distance.max(f64::MIN_POSITIVE);
    let links: Vec<Link> =
        memory::gathered(surface.joints.iter().map(|j| (j.faces, flow(j.length, j.distance))))?;
    let smooth = diffused(&surface.areas, &links, BEND_SCALE, memory::twin(&surface.normals)?)?;
    let normals = memory::gathered(smooth.into_iter().map(unit))?;
    progress.check()?;
    let thickness = thickness(surface, &normals, &links, THICKNESS_SCALE, progress)?;
    let edges = surface.joints.par_iter().map(|joint| {
        let [f, g] = joint.faces.map(|f| f as usize);
        let across = sub(surface.centers[g], surface.centers[f]);
        let squared = dot(across, across);
        // The curvature across the edge, hollow positive, times the scale.
        let turn =
            if squared > 0.0 { -dot(sub(normals[g], normals[f]), across) / squared.sqrt() } else { 0.0 };
        let bend = turn.max(0.0) * (BEND_SCALE / squared.sqrt()).max(LEAST_SHARE);
        let slope = (thickness[g] - thickness[f]).abs() / joint.distance.max(f64::MIN_POSITIVE);
        let change = slope * THICKNESS_SCALE.max(joint.distance);
        let part =
            (-(bend / BEND_OF_A_THIRD).powi(2) - (change / CHANGE_OF_A_THIRD).powi(2)).exp().max(HOLLOW);
        Edge {
            ends: joint.faces,
            length: joint.length,
            cost: part * joint.weight * joint.length,
            distance: joint.distance,
        }
    });
    let (areas, centers) = (memory::twin(&surface.areas)?, memory::twin(&surface.centers)?);
    Ok(Graph::new(areas, centers, memory::joined(edges)?)?.with_thickness(thickness))
}

/// What a border anywhere on the surface costs for its length, given the [`border_graph`]: the geometric mean
/// over the area, without painted weights. It is 1 where there are no hollows, and less for curls and folds.
pub(super) fn usual_part(surface: &Surface, graph: &Graph) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (joint, edge) in surface.joints.iter().zip(&graph.edges) {
        let plain = joint.weight * joint.length;
        if plain > 0.0 {
            let around = joint.length * joint.distance;
            sum += around * (edge.cost / plain).clamp(HOLLOW, 1.0).ln();
            area += around;
        }
    }
    if area > 0.0 {
        (sum / area).exp()
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes;

    /// A sphere whose radius varies by `height` in waves all over it.
    fn usual(height: f64, weight: f64) -> f64 {
        let shape = shapes::icosphere(5).map(|p| {
            let radius = 1.0 + height * p.iter().map(|x| (20.0 * x).sin()).product::<f64>();
            p.map(|x| x * radius)
        });
        let mesh = shape.mesh().unwrap();
        let faces: Vec<u32> = (0..shape.faces.len() as u32).collect();
        let surface = Surface::new(&mesh, &faces, |_| weight).unwrap();
        usual_part(&surface, &border_graph(&surface, &Progress::new()).unwrap())
    }

    #[test]
    fn borders_are_usually_cheap_on_a_rough_shape_whatever_is_painted() {
        let (smooth, rough) = (usual(0.0, 1.0), usual(0.1, 1.0));
        assert!((smooth - 1.0).abs() < 1e-3, "{smooth}");
        assert!(rough < 0.9, "{rough}");
        assert!((usual(0.1, 0.01) - rough).abs() < 1e-9);
        assert_eq!(usual(0.1, 0.0), 1.0);
    }
}
