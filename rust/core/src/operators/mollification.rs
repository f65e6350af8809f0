//! Intrinsic mollification: edge lengths of degenerate triangles made sound (Sharp and Crane 2020).

use crate::mesh::{triangle, Connectivity};

/// The margin of the triangle inequality, in mean edge lengths: scans and modeled meshes keep their lengths
/// (eleven were measured, from fandisk to Nefertiti), and the entries of the Hessian of a mesh squashed to
/// 1e-7 of its height fall from 1e7 to 1e4.
pub const MOLLIFICATION_MARGIN: f64 = 1e-4;

/// Lengthens all edges by the least `ε` with which every triangle inequality holds by
/// [`MOLLIFICATION_MARGIN`] mean edge lengths, and returns `ε` (0 if nothing had to change). Lengths that are
/// zero or violate the triangle inequality are welcome.
pub fn mollify(connectivity: &Connectivity, lengths: &mut [[f64; 3]]) -> f64 {
    let (sum, count) =
        connectivity.edges().fold((0.0, 0_usize), |(sum, count), h| (sum + lengths[h / 3][h % 3], count + 1));
    if count == 0 {
        return 0.0;
    }
    let margin = MOLLIFICATION_MARGIN * sum / count as f64;
    let epsilon = lengths.iter().fold(0.0_f64, |epsilon, &l| epsilon.max(margin - triangle::slack(l)));
    if epsilon > 0.0 {
        for length in lengths.iter_mut().flatten() {
            *length += epsilon;
        }
    }
    epsilon
}
