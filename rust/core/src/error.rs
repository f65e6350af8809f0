//! What can go wrong, as values: each error names the culprit and the cure.

/// The result of every fallible function of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Any failure of this crate. A solver that stops short of its tolerance is *not* an error but a status.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The mesh cannot be used as it is.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// An argument has a wrong value or shape.
    #[error("{name}: {problem}")]
    Argument {
        /// The argument's name, as the caller wrote it.
        name: &'static str,
        /// What is wrong with it and what to pass instead.
        problem: String,
    },
    /// The numerical problem could not be solved at all.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The call, or an array of it, does not fit into memory.
    #[error("{}", memory_text(what, *needed, *limit, *is_given, *fits))]
    Memory {
        /// The call or the argument.
        what: &'static str,
        /// Bytes that it needs, about.
        needed: usize,
        /// Bytes that it may take.
        limit: usize,
        /// Whether the caller gave that limit; otherwise it is a share of what is free.
        is_given: bool,
        /// How many vertices a mesh may have that fits; 0 if not known.
        fits: usize,
    },
    /// No thread could be started to work on.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The caller asked to stop through [`crate::Progress::cancel`]; nothing is returned.
    #[error("cancelled")]
    Cancelled,
}

impl Error {
    /// An [`Error::Argument`] for the argument `name`.
    pub fn argument(name: &'static str, problem: impl Into<String>) -> Self {
        Self::Argument { name, problem: problem.into() }
    }
}

/// The system gives no thread to work on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "no thread could be started: {reason}; end other programs, or raise the limit of processes (ulimit -u)"
)]
pub struct ThreadsError {
    /// What the system said.
    pub reason: String,
}

/// What is wrong with a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {n_vertices} vertices")]
    VertexOutOfRange {
        /// The face.
        face: usize,
        /// The vertex that it names.
        vertex: i64,
        /// How many there are.
        n_vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite; remove or repair that vertex")]
    NonFiniteVertex {
        /// The vertex.
        vertex: usize,
    },
    /// Coordinates so large that the length of an edge between them is past the largest number.
    #[error("face {face} has an edge too long for a number; scale the mesh down")]
    TooLarge {
        /// The face.
        face: usize,
    },
    /// An edge length is NaN, infinite or negative.
    #[error("face {face} has an edge length that is negative or not finite; pass lengths >= 0")]
    BadEdgeLength {
        /// The face.
        face: usize,
    },
    /// The two faces of an edge were given different lengths for it.
    #[error("faces {first} and {second} share an edge but were given different lengths for it")]
    UnequalEdgeLengths {
        /// One face.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Three edge lengths of a face form no triangle.
    #[error("the edge lengths of face {face} violate the triangle inequality")]
    TriangleInequality {
        /// The face.
        face: usize,
    },
    /// Edge lengths were not given once for every face.
    #[error("edge lengths were given for {rows} faces, but there are {n_faces}; pass one row a face")]
    LengthRows {
        /// How many rows were given.
        rows: usize,
        /// How many faces there are.
        n_faces: usize,
    },
    /// More faces than 32-bit halfedge indices can count.
    #[error("{n_faces} faces are more than the 1431655764 that fit; reduce the mesh")]
    TooManyFaces {
        /// How many there are.
        n_faces: usize,
    },
    /// More vertices than 32-bit indices can number.
    #[error("{n_vertices} vertices are more than the 2147483647 that 32-bit indices can number")]
    TooManyVertices {
        /// How many there are.
        n_vertices: usize,
    },
    /// There is no face with positive area.
    #[error("the mesh has no face with positive area; nothing can be computed on it")]
    NoFaces,
    /// A dual edge has no length, so the circumcentric Hessian does not exist.
    #[error(
        "faces {face} and {neighbor} have the same circumcenter: the circumcentric dual edge has no \
        length; use barycentric duals, or circumcentric_or_barycentric to replace such edges only"
    )]
    ZeroDualEdge {
        /// One face.
        face: usize,
        /// Its neighbor.
        neighbor: usize,
    },
    /// A boundary loop cannot be filled.
    #[error("the hole of {n_edges} edges at vertex {vertex} cannot be filled: {reason}")]
    Unfillable {
        /// A vertex on the loop.
        vertex: u32,
        /// The length of the loop.
        n_edges: usize,
        /// Why not.
        reason: Refusal,
    },
    /// The operation needs positions, but the mesh is known by its edge lengths only.
    #[error("the mesh has edge lengths only; this operation needs vertex positions")]
    NoPositions,
}

/// Why a boundary loop cannot be filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The vertices are not three or more, each once, around a boundary.
    #[error("its vertices do not follow the boundary edges around a hole, each vertex once")]
    NotALoop,
    /// The faces at the loop do not all run the same way along it.
    #[error("the faces around it disagree on which side is outside; make the normals consistent")]
    InconsistentOrientation,
    /// The loop is the three edges of one face.
    #[error("it is the outline of a single triangle, and would be filled with the same triangle again")]
    SingleFace,
    /// Another piece of surface lies inside the hole.
    #[error(
        "another piece of surface lies inside it; delete that piece, or join it to the rim, and fill what is \
        left"
    )]
    Island,
    /// The rim ends at edges with three faces or more.
    #[error(
        "its rim ends at non-manifold edges, with three faces or more, as where an inner wall meets the \
        surface; separate that wall, fill the hole, and join the wall again"
    )]
    OpenRim,
    /// The two sides of the rim lie on each other, with vertices of one in the middle of edges of the other.
    #[error(
        "it has no width: vertices of one side lie in the middle of edges of the other (T-junctions); \
        split these edges there and merge vertices by distance"
    )]
    TJunction,
    /// The rim encloses no area.
    #[error("it has no width: the two sides of the rim lie in the same place; merge vertices by distance")]
    NoExtent,
}

/// Why a numerical problem has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The matrix of a linear system is singular or not finite.
    #[error("the linear system could not be factorized: {reason}")]
    Factorization {
        /// What the factorization reported.
        reason: String,
    },
    /// The factor of the linear system does not fit, or the system gives nothing for another array.
    #[error("{}", solve_memory_text(*needed, *limit))]
    Memory {
        /// Bytes for the factor and the work on it, or for the array.
        needed: usize,
        /// The limit in bytes that was given; without one the system refused.
        limit: Option<usize>,
    },
    /// What was to be computed is past the largest number, or below the smallest with all its digits.
    #[error(
        "{what} would be too large or too small for a number; scale the mesh or the values to a size around 1"
    )]
    NoNumber {
        /// What it is.
        what: &'static str,
    },
    /// Rounding leaves no correct digit of the answer.
    #[error(
        "the sizes of the triangles differ so much that rounding leaves nothing of the answer; remove \
        the largest and the smallest, or remesh"
    )]
    Uneven,
    /// The constraints contradict each other or the problem has no unique solution.
    #[error("the problem has no solution: {reason}")]
    Infeasible {
        /// Why.
        reason: String,
    },
}

fn solve_memory_text(needed: usize, limit: Option<usize>) -> String {
    let needed = readable(needed);
    match limit {
        Some(limit) => format!(
            "the factorization needs {needed} of memory, more than the limit of {}; raise memory_limit, keep \
            more values fixed or reduce the mesh",
            readable(limit)
        ),
        None => format!(
            "another {needed} of memory are needed, more than there is; free memory, keep more values fixed \
            or reduce the mesh"
        ),
    }
}

fn memory_text(what: &str, needed: usize, limit: usize, is_given: bool, fits: usize) -> String {
    let limit = readable(limit);
    let (limit, cure) = if is_given {
        (format!("the limit of {limit}"), "raise memory_limit")
    } else {
        (format!("the {limit} that are free for it"), "free memory")
    };
    let reduce =
        if fits > 0 { format!("reduce the mesh to about {fits} vertices") } else { "reduce the mesh".into() };
    format!("{what}: needs about {} of memory, more than {limit}; {reduce}, or {cure}", readable(needed))
}

fn readable(bytes: usize) -> String {
    let (size, unit) = if bytes < 1_000_000_000 { (1e6, "MB") } else { (1e9, "GB") };
    format!("{:.2} {unit}", bytes as f64 / size)
}
