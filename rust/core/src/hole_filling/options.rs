//! How holes are filled.

/// Which holes are closed flat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lids {
    /// None.
    #[default]
    Never,
    /// Those with a planar rim that the surface meets steeply all round: the missing side of a box,
    /// the cut end of a tube.
    Planar,
    /// All whose rim does not overlap itself in its mean plane.
    Always,
}

/// How a hole is filled.
#[derive(Debug, Clone, PartialEq)]
pub struct FillOptions {
    /// The edge length inside the patch; without it, that of the rim continues into the patch.
    pub edge_length: Option<f64>,
    /// Whether to refine and remesh; without, a patch is the triangulation of minimum weight alone and has no
    /// new vertex unless nothing else is possible.
    pub refine: bool,
    /// Rounds of isotropic remeshing, 0 for Liepa's refinement alone.
    pub remesh_iterations: usize,
    /// Where the patch would have more faces than about this many, edges grow with the distance from the rim.
    pub max_faces: usize,
    /// Which holes are closed flat.
    pub lids: Lids,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self { edge_length: None, refine: true, remesh_iterations: 10, max_faces: 40_000, lids: Lids::Never }
    }
}
