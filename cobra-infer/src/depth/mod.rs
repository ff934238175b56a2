//! A pose against a depth image, both ways.
//!
//! Owns the check of one pose: whether what was observed lies on the surface (forward), whether the surface
//! that the pose says is visible was seen (reverse), and how far the pose would have to move to fit
//! (refinement). What the surface is, a template or on a host the exact mesh, is behind [`Surface`]; pixels
//! and memory are the caller's. Segmenting images and estimating poses is not done here.
//!
//! 1. **Visible surface.** Points of the surface are projected into a small depth buffer over the square of
//!    the image that the object's bounding sphere falls into; the nearest of each cell is visible.
//! 2. **Reverse.** A visible point at depth z on a pixel with measured depth λ: where λ < z − 3σ something
//!    stands in front of it, and it is no evidence; where λ > z it would have been seen and was not. The
//!    reverse likelihood is the mean of exp(−(λ − z)²/2σ²) over all points that are evidence.
//! 3. **Forward.** An observed pixel of depth λ is put back into the object's frame, P̂ = Rᵀ(λK⁻¹p − t). The
//!    forward likelihood is the mean of exp(−e²/2σ²), e being the distance of P̂ from the surface: the
//!    residual along the ray from the reference point divided by the gradient's norm. Pixels that nothing
//!    of the surface speaks for count 0.
//! 4. **Refinement.** A few robust Gauss-Newton steps of the pose on the distances e. How far they move the
//!    object's points on average is the displacement, an estimate of ADD.
//!
//! Every one of the three is a length as well: a mean likelihood L is that of points which all are
//! σ√(−2 ln L) off. The estimated error is the largest of the three lengths, and the confidence the least of the
//! three likelihoods, min(forward, reverse, exp(−displacement²/2σ²)): the one is a function of the other,
//! confidence = exp(−error²/2σ²), so that a threshold on the confidence is one on the error in shares of σ.
//! A product of the three orders poses as well, but a threshold on it that was found on some objects accepts
//! four times as many wrong poses of others as it should (`docs/DEPTH.md`).
//!
//! σ² is σ̂_k² + σ_m². By default σ_m is 6 % of the diameter: how far from the surface a right pose may put
//! what was seen. With the noise of the sensor alone nearly every pose that a gripper could work with would
//! have confidence 0. It belongs to this module only.

mod cause;
mod check;
mod error;
mod observed;
mod pulse;
mod refine;
mod report;
mod residual;
mod reverse;
mod settings;
mod surface;
mod zbuffer;

pub use cause::{Cause, CauseInUnit, Correction};
pub use check::{DepthCheck, Observed, check_depth};
pub use error::DepthError;
pub use observed::{DepthImage, DepthPixel, DepthWords};
pub use report::DepthReport;
pub use residual::{PixelResidual, Seen, SurfacePoint};
pub use settings::{DepthSettings, Noise, Thresholds};
pub use surface::{Nearby, Surface, TemplateSurface};
pub use zbuffer::Cell;
