//! How to segment.

use super::constants::{CLEAN_FIDELITY, DEFAULT_SCALE, MOST_LEAST_FACES, NOISY};
use crate::linear::Columns;
use crate::mesh::Mesh;
use crate::solve::MAX_JOINT_COLUMNS;
use crate::tools::options::{
    check_edge_weights, check_faces, check_positive, check_range, check_weights, painted_weight, ENOUGH,
};
use crate::tools::{Levels, Scale, SolveOptions};
use crate::{memory, Error, Result};

/// How segments are made from the indicator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SegmentMethod {
    /// Watershed by persistence, merging across borders that bend by less than the length weight, and border
    /// faces moved to the segment that they fit best.
    #[default]
    Fitted,
    /// Cuts below a threshold, and small pieces merged by majority (Rowe et al. 2024, supplement E).
    Paper,
}

/// What becomes of the fillets and bevels of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fillets {
    /// Segments are told by the surfaces that their faces lie on, so every fillet is one of its own, and by
    /// bends where one smooth surface would do as well, as on free shapes.
    #[default]
    Automatic,
    /// The same wherever surfaces explain the faces, also in patches of a free shape.
    Apart,
    /// The same as by default, and fillets and bevels belong to the larger one of the sides beside them.
    Joined,
    /// Segments are told by bends alone, and on exact shapes by their surfaces: what no edge parts is one.
    Unseen,
}

/// How to segment.
#[derive(Debug, Clone)]
pub struct SegmentOptions {
    /// How segments are made from the indicator.
    pub method: SegmentMethod,
    /// What becomes of fillets and bevels; for shapes by [`SegmentMethod::Fitted`].
    pub fillets: Fillets,
    /// `λ`, what a border costs per length. A crease that bends by more (radians; for other signals the jump
    /// of the slope, with the signal's range and the shape's size as 1) is worth a border.
    pub length_weight: f64,
    /// `α`. Without it as the noise found in the signal wants it; for [`SegmentMethod::Paper`] 1000. With it
    /// even modeled shapes of a few faces a side are smoothed, which otherwise go by their planes.
    pub fidelity: Option<f64>,
    /// `ε` at the start.
    pub epsilon_start: f64,
    /// `ε` at the end; [`SegmentMethod::Fitted`] stops where the mesh is not fine enough for less.
    pub epsilon_end: f64,
    /// The mean squared change of the indicator at which `ε` is halved.
    pub inner_tolerance: f64,
    /// For [`SegmentMethod::Paper`]: edges with a lower indicator are cut.
    pub cut_threshold: f64,
    /// Segments of fewer faces are merged. Without it 20, or where [`SegmentMethod::Fitted`] finds less noise
    /// down to 4; none for modeled shapes of a few faces a side.
    pub min_faces: Option<usize>,
    /// How many segments are wanted; as many as the length weight makes where `None`.
    pub n_segments: Option<usize>,
    /// The unit of length of the weights.
    pub scale: Scale,
    /// What borders cost in each face, 1 neutral, smaller where they are welcome.
    pub face_weights: Option<Vec<f64>>,
    /// What borders cost along each edge, one row a face, column `i` opposite corner `i`;
    /// the mean of both faces' entries counts.
    pub edge_weights: Option<Vec<[f64; 3]>>,
    /// The faces to segment; all where `None`.
    pub faces: Option<Vec<bool>>,
    /// The standard deviation of the noise in the signal, in its units; found where `None`.
    pub noise: Option<f64>,
    /// Whether segments are found on a coarser mesh: those of shapes without weights of edges and a given
    /// fidelity, by [`SegmentMethod::Fitted`]; others never are.
    pub levels: Levels,
    /// The solver; the default stops on residuals.
    pub solve: SolveOptions,
}

impl Default for SegmentOptions {
    fn default() -> Self {
        Self {
            method: SegmentMethod::Fitted,
            fillets: Fillets::Automatic,
            length_weight: 0.5,
            fidelity: None,
            epsilon_start: 0.1,
            epsilon_end: 0.001,
            inner_tolerance: 1e-5,
            cut_threshold: 0.6,
            min_faces: None,
            n_segments: None,
            scale: DEFAULT_SCALE,
            face_weights: None,
            edge_weights: None,
            faces: None,
            noise: None,
            levels: Levels::Auto,
            solve: SolveOptions::default().on_residuals(),
        }
    }
}

impl SegmentOptions {
    pub(super) fn check(&self, mesh: &Mesh, values: Option<&Columns>) -> Result<()> {
        let (n, m) = (mesh.connectivity().n_vertices(), mesh.connectivity().n_faces());
        let positive = [
            ("length_weight", Some(self.length_weight)),
            ("fidelity", self.fidelity),
            ("epsilon_start", Some(self.epsilon_start)),
            ("epsilon_end", Some(self.epsilon_end)),
            ("inner_tolerance", Some(self.inner_tolerance)),
        ];
        for (name, value) in positive {
            check_positive(name, value, "it must be positive")?;
        }
        if self.epsilon_end > self.epsilon_start {
            let problem = format!("is {}, more than epsilon_start, {}", self.epsilon_end, self.epsilon_start);
            return Err(Error::argument("epsilon_end", problem));
        }
        if let Some(noise) = self.noise.filter(|noise| !(*noise >= 0.0 && noise.is_finite())) {
            return Err(Error::argument("noise", format!("is {noise}; it must be finite and at least 0")));
        }
        if matches!(self.fillets, Fillets::Apart | Fillets::Joined) && !self.is_plain(values.is_some()) {
            let problem = "are told on shapes by method \"fitted\" without fidelity; pass \"automatic\"";
            return Err(Error::argument("fillets", problem.to_owned()));
        }
        check_range("cut_threshold", self.cut_threshold, 0.0, 1.0)?;
        check_weights("face_weights", self.face_weights.as_ref(), m, "face")?;
        check_edge_weights(self.edge_weights.as_deref(), m)?;
        if self.n_segments == Some(0) {
            return Err(Error::argument("n_segments", "is 0; ask for at least one segment"));
        }
        check_faces(self.faces.as_deref(), m)?;
        let Some(values) = values else { return Ok(()) };
        values.check("values", n)?;
        if values.n_columns > MAX_JOINT_COLUMNS {
            let problem =
                format!("has {} columns, at most {MAX_JOINT_COLUMNS} are possible", values.n_columns);
            return Err(Error::argument("values", problem));
        }
        Ok(())
    }

    /// A copy.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing.
    pub(super) fn copied(&self) -> Result<Self> {
        Ok(Self {
            face_weights: self.face_weights.as_deref().map(memory::twin).transpose()?,
            edge_weights: self.edge_weights.as_deref().map(memory::twin).transpose()?,
            faces: self.faces.as_deref().map(memory::twin).transpose()?,
            ..self.without_arrays()
        })
    }

    /// The same without what has an entry a face.
    pub(super) fn without_arrays(&self) -> Self {
        Self { face_weights: None, edge_weights: None, faces: None, ..*self }
    }

    /// Whether nothing is asked for but the faces of a shape.
    pub(super) fn is_plain(&self, has_values: bool) -> bool {
        !has_values && self.fidelity.is_none() && self.method == SegmentMethod::Fitted
    }

    /// Whether segments of a mesh with so many vertices are found on a coarser one. Weights of edges say to
    /// the edge where borders run, which no coarser mesh does.
    pub(super) fn are_levels_used(&self, n_vertices: usize, has_values: bool) -> bool {
        let is_suited = self.is_plain(has_values) && self.edge_weights.is_none();
        is_suited && self.levels.are_used(n_vertices, ENOUGH, true)
    }

    /// How many faces a segment must have where the noise is this part of a mean edge: twenty where it is a
    /// tenth, down to a fifth of that where there is less.
    pub(super) fn least_faces(&self, noise: f64) -> usize {
        let is_paper = self.method == SegmentMethod::Paper;
        let share = if is_paper { 1.0 } else { (noise / NOISY).clamp(0.2, 1.0) };
        self.min_faces.unwrap_or((share * MOST_LEAST_FACES).round() as usize)
    }

    /// The unit of length of the weights on a mesh.
    pub(super) fn unit_of(&self, mesh: &Mesh) -> f64 {
        let positions = mesh.positions().unwrap_or_default();
        self.scale.unit(mesh.connectivity(), positions, mesh.edge_lengths())
    }

    /// `α` to start with.
    pub(super) fn starting_fidelity(&self) -> f64 {
        self.fidelity.unwrap_or(CLEAN_FIDELITY)
    }

    /// `ε` halved down to the end, or to `least` where that is more.
    pub(super) fn epsilons(&self, least: f64) -> Vec<f64> {
        let end = match self.method {
            SegmentMethod::Paper => self.epsilon_end,
            SegmentMethod::Fitted => self.epsilon_end.max(least),
        };
        let halved = std::iter::successors(Some(self.epsilon_start), |epsilon| Some(0.5 * epsilon));
        let mut epsilons: Vec<f64> = halved.take_while(|epsilon| *epsilon >= end * (1.0 - 1e-9)).collect();
        if epsilons.is_empty() {
            epsilons.push(end);
        }
        epsilons
    }

    /// What a border along each halfedge costs per length, the same for both halfedges of an edge.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing, here and below.
    pub(super) fn edge_costs(&self, mesh: &Mesh) -> Result<Vec<[f64; 3]>> {
        let connectivity = mesh.connectivity();
        let own = |h: usize| painted_weight(self.edge_weights.as_ref(), self.face_weights.as_ref(), h);
        let cost = |h: usize| connectivity.twin(h).map_or_else(|| own(h), |twin| 0.5 * (own(h) + own(twin)));
        Ok(memory::gathered((0..connectivity.n_faces()).map(|f| [0, 1, 2].map(|i| cost(3 * f + i))))?)
    }

    /// What borders cost in each face: as much as along its cheapest edge.
    pub(super) fn face_costs(&self, edge_costs: &[[f64; 3]]) -> Result<Vec<f64>> {
        let cheapest = |costs: &[f64; 3]| costs.iter().copied().fold(f64::INFINITY, f64::min);
        Ok(memory::gathered(edge_costs.iter().map(cheapest).map(|cost| cost.max(1e-3)))?)
    }
}
