//! When an iteration ends.

/// The steps that an iteration takes at most, and what it comes to rest at; a constant of this type says of
/// what that is a part.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// At most so many steps.
    pub steps: usize,
    /// A step that changes no more than this is the last.
    pub rest: f64,
}
