//! Frequency responses from recorded signals: the discrete Fourier transform, and the response
//! between two signals estimated from blocks.
//!
//! ```text
//! periodic input:   whole periods -> transforms -> response at the excited lines, variance from period to period
//! any other input:  whole record -> transform -> local polynomials: response, transient, noise of each band
//!                   overlapping segments, Hann window -> transforms -> H1, coherence
//! ```

mod blocks;
mod comparison;
mod distortion;
mod estimate;
mod feedback;
mod local;
mod period;
mod transform;

pub use blocks::{Blocks, periods, segments};
pub use comparison::{ResponsePair, pairs};
pub use distortion::Distortion;
pub use estimate::{SpectralPoint, disc_radius, least_coherence};
pub use feedback::{WithinRow, feedback};
pub use local::{LOCAL_BLOCKS, local_polynomials};
pub use period::period;
pub use transform::Transform;
