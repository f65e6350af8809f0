//! Facets of a large mesh, found on a coarser one.
//!
//! A facet is a plane of many faces, and a mesh of some thousand vertices says as well as one of a million
//! where these are ([`crate::levels`]): of scans of 50,000 to 140,000 vertices 30, 100, and 300 facets are as
//! near to the mesh as those found on all of its faces, in a fifth to a tenth of the time. What is said of
//! the facets, how far the mesh is from them and which is nearest to each face, is measured on the mesh
//! itself.

use std::sync::Arc;

use rayon::prelude::*;

use super::coarse::Coarse;
use super::constants::{MOST_LOST, PER_FACET};
use super::faces::{Faces, Scan};
use super::faceted::FacetMerges;
use super::job::Job;
use super::options::FacetOptions;
use super::regions::OUTSIDE;
use super::search::Found;
use crate::mesh::vector::{distance, sub};
use crate::mesh::Working;
use crate::progress::Progress;
use crate::tools::options::ENOUGH;
use crate::{memory, Result};

impl Job<'_> {
    /// Facets that a coarser mesh tells, with the merges of its faces, those that are `known` where they are
    /// of one that is fine enough; nothing where the mesh itself is to be asked.
    ///
    /// A coarser mesh of a shape that was modeled as a polyhedron may have lost some of its planes, one that
    /// passes through itself where the mesh does not says nothing, and one that has less than half of
    /// [`PER_FACET`] vertices for each facet that was found too little: then a finer one is asked.
    pub(super) fn found_on_coarser(
        &self,
        scan: &Scan,
        known: Option<&FacetMerges>,
        options: &FacetOptions,
        progress: &Progress,
    ) -> Result<Option<(Found, FacetMerges)>> {
        let n_vertices = self.working.mesh().connectivity().n_vertices();
        let mut enough = ENOUGH.max(options.facets.unwrap_or(0).saturating_mul(PER_FACET));
        if self.mirror.is_some() || !options.use_levels(n_vertices, enough) || self.is_modeled(scan)? {
            return Ok(None);
        }
        let is_enough = |known: &&FacetMerges| {
            known.coarse.as_ref().is_some_and(|coarse| 2 * coarse.mesh.connectivity().n_vertices() >= enough)
        };
        let mut known = known.filter(is_enough);
        while options.use_levels(n_vertices, enough) {
            let coarse = match known.and_then(|known| known.coarse.clone()) {
                Some(coarse) => coarse,
                None => match Coarse::of(self, enough, progress)? {
                    Some(coarse) => Arc::new(coarse),
                    None => break,
                },
            };
            let working = Working::contracted(&coarse.mesh)?;
            let job = {
                let center = sub(self.center, working.place([0.0; 3]));
                Job::within(&working, options, None, (center, self.diagonal))?
            };
            let own = job.scan(options)?;
            let lost = match options.error {
                Some(_) => self.lost(scan, &own)?,
                None => 0.0,
            };
            let error = options.error.map(|error| (error.powi(2) - lost.powi(2)).max(0.0).sqrt());
            let passes_itself = own.standing.is_any() && !scan.standing.is_any();
            if !passes_itself && options.error.is_none_or(|error| lost <= MOST_LOST * error) {
                let options = FacetOptions { error, ..options.clone() };
                let merges = match known.take() {
                    Some(known) => known.merges.twin()?,
                    None => job.merges(&own, &options, &progress.patient())?,
                };
                let found = job.found(&merges, &own, &options, progress)?;
                let needed = found.n_facets.saturating_mul(PER_FACET);
                if needed <= 2 * enough || progress.is_finishing() {
                    let found = self.measured(found, scan, &job, &coarse)?;
                    return Ok(Some((found, FacetMerges { merges, coarse: Some(coarse) })));
                }
                enough = needed;
            } else {
                enough *= 2;
            }
            known = None;
        }
        Ok(None)
    }

    /// How far the mesh is from a coarser one, root mean square, in its own unit.
    fn lost(&self, scan: &Scan, coarse: &Scan) -> Result<f64> {
        let away = scan
            .centers
            .par_iter()
            .zip(&scan.moments)
            .map(|(&center, moments)| moments.area * distance(center, coarse.on_mesh(center)).powi(2));
        let squares: Vec<f64> = memory::joined(away)?;
        Ok(self.diagonal * (squares.iter().sum::<f64>() / scan.area.max(f64::MIN_POSITIVE)).sqrt())
    }

    /// What was found on a coarser mesh, by `job`, as it is on this one.
    fn measured(&self, found: Found, scan: &Scan, job: &Job<'_>, coarse: &Coarse) -> Result<Found> {
        let Found { mut shape, inspection, labels, n_facets, n_crossings, .. } = found;
        for corner in &mut shape.corners {
            corner.vertex = coarse.origins[job.working.original(corner.vertex) as usize];
        }
        let on_coarse = job.labels(labels)?;
        let at_home = |&f: &u32| match on_coarse[coarse.homes[f as usize] as usize] {
            OUTSIDE => 0,
            label => label,
        };
        let faces = Faces {
            scan,
            labels: memory::gathered(self.parts.iter().map(at_home))?,
            is_held: memory::repeated(false, self.parts.len())?,
        };
        let (labels, distances) = faces.nearest(&shape, &inspection)?;
        Ok(Found { shape, inspection, labels, distances, n_facets, n_crossings })
    }
}
