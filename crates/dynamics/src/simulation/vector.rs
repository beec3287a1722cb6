//! Kernels compiled for the vector instructions of a processor.

use pulp::{Arch, WithSimd};

use crate::scalar::Lanes;

/// Scalar whose kernels are compiled for the vector instructions of the processor.
///
/// A single number has a second copy of each kernel, for processors without vector instructions.
/// Lanes have no such copy on architectures with vector instructions (x86-64): several parallel
/// machines gain nothing without them, and the copy took most of the build time.
pub trait Vectorized: Copy {
    /// Does the work; `None` if the processor lacks the instructions that these scalars need.
    fn vectorized<W: WithSimd>(work: W) -> Option<W::Output>;
}

impl Vectorized for f64 {
    #[inline]
    fn vectorized<W: WithSimd>(work: W) -> Option<W::Output> {
        Some(Arch::new().dispatch(work))
    }
}

impl Vectorized for Lanes {
    #[cfg(target_arch = "x86_64")]
    #[inline]
    fn vectorized<W: WithSimd>(work: W) -> Option<W::Output> {
        pulp::x86::V3::try_new().map(|instructions| pulp::Simd::vectorize(instructions, work))
    }

    #[cfg(not(target_arch = "x86_64"))]
    #[inline]
    fn vectorized<W: WithSimd>(work: W) -> Option<W::Output> {
        Some(Arch::new().dispatch(work))
    }
}

/// Empty work, to test whether the instructions are available.
struct Nothing;

impl WithSimd for Nothing {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: pulp::Simd>(self, _: V) {}
}

/// True if this processor can simulate machines in parallel lanes; if not, [`super::drive`] rejects
/// lanes.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::Lanes;
/// use phea_dynamics::simulation::can_drive;
/// assert!(can_drive::<f64>()); // on every processor
/// let lanes_are_worth_it = can_drive::<Lanes>();
/// # let _ = lanes_are_worth_it;
/// ```
pub fn can_drive<S: Vectorized>() -> bool {
    S::vectorized(Nothing).is_some()
}
