//! Frequency responses from recorded signals: the discrete Fourier transform, and what blocks of
//! two signals say of the response from one to the other.
//!
//! ```text
//! periodic input:   whole periods -> transforms -> response at the excited lines, variance from period to period
//! any other input:  overlapping segments, Hann window -> transforms -> H1, coherence
//! ```

mod blocks;
mod estimate;
mod period;
mod transform;

pub use blocks::{Blocks, periods, segments};
pub use estimate::{SpectralPoint, disc_radius, least_coherence};
pub use period::period;
pub use transform::Transform;
