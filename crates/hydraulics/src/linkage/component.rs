//! Linkage from its table.

use phea_dynamics::scalar::{Parameters, Scalar};

use super::keys::{DeclaredLinkage, DeclaredWeight};
use super::{Linkage, STANDARD_GRAVITY};

impl DeclaredLinkage {
    /// Linkage over a stroke in m, with a weight over another scalar; an actuator is not assembled
    /// with one that does not close.
    pub fn component<S: Scalar>(&self, stroke: f64, weight: Option<DeclaredWeight<S>>) -> Linkage<S> {
        let Ok(reduced) = self.reduced(stroke) else { return Linkage::impossible() };
        let Some(DeclaredWeight { mass, centre_distance, .. }) = weight else {
            return reduced.linkage.convert(&mut S::from);
        };
        let moment = mass * centre_distance;
        reduced.linkage.convert(&mut S::from).with_moment(moment * S::from(STANDARD_GRAVITY))
    }
}
