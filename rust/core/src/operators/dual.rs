//! Dual edges: from the center of a face to the center of its neighbor, unfolded into the face's plane.

use crate::operators::hinge::Hinge;
use crate::operators::Dual;

/// Two circumcenters coincide when the cotangents of the angles opposite their edge cancel to this part of
/// their size; rounding leaves some 1e-15 on squares split along the diagonal, more on slivers.
const COINCIDENT_CIRCUMCENTERS: f64 = 1e-10;

/// A dual edge in the frame of its [`Hinge`]: x along the halfedge, y into the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DualEdge(pub [f64; 2]);

impl DualEdge {
    /// The dual edge of `hinge`, or nothing if it has no length.
    pub(crate) fn new(dual: Dual, hinge: &Hinge) -> Option<Self> {
        let ([s_f, h_f], [s_g, h_g]) = (hinge.face, hinge.neighbor);
        let barycentric = Self([(s_g - s_f) / 3.0, -(h_f + h_g) / 3.0]);
        match dual {
            Dual::Barycentric => Some(barycentric),
            Dual::Circumcentric | Dual::CircumcentricOrBarycentric => {
                // The circumcenter is cot(angle) · length / 2 above the edge's midpoint.
                let cotangent = |[s, h]: [f64; 2]| (h - s * (hinge.length - s) / h) / hinge.length;
                let (face, neighbor) = (cotangent([s_f, h_f]), cotangent([s_g, h_g]));
                let sum = face + neighbor;
                let size = 1.0 + face.abs() + neighbor.abs();
                if sum.abs() > COINCIDENT_CIRCUMCENTERS * size {
                    Some(Self([0.0, -0.5 * hinge.length * sum]))
                } else {
                    (dual == Dual::CircumcentricOrBarycentric).then_some(barycentric)
                }
            }
        }
    }

    /// The dual edge in the face's frame, where the halfedge has the unit `direction`.
    pub(crate) fn turned(self, direction: [f64; 2]) -> [f64; 2] {
        let Self([along, across]) = self;
        let [c, s] = direction;
        [c * along - s * across, s * along + c * across]
    }

    /// What a unit jump of the gradient along the halfedge's normal adds to the face's Hessian times `area`:
    /// `(1/l*) (n · t) t ⊗ t` (Rowe et al. 2024, eqs. (16) and (17), and supplement A) as `xx, yy, √2·xy` in
    /// the face's frame.
    pub(crate) fn tensor(self, direction: [f64; 2], area: f64) -> [f64; 3] {
        let Self([along, across]) = self;
        let [x, y] = self.turned(direction);
        let squared = along * along + across * across;
        let scale = area * across / (squared * squared);
        [scale * x * x, scale * y * y, std::f64::consts::SQRT_2 * scale * x * y]
    }
}
