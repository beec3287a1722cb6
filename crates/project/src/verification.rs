//! Table `[verification]`: the judgement of a controller.

use phea_quantity::GAIN;
use phea_table::Visitor;
use phea_table::key;

/// Settings of the verification.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredVerification {
    /// Factor by which a limit may be missed and still counts as met; if absent, 0.01 dB.
    pub tolerance: Option<f64>,
}

impl DeclaredVerification {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let doc = "By how much a limit may be missed and still counts as met; absent: 0.01 dB.";
        v.optional(key("tolerance", &GAIN, doc).at_least(1.0).at_most(GREATEST), &mut self.tolerance);
    }
}

/// Greatest tolerance, 6 dB: beyond it, the factor is no longer a numerical tolerance.
const GREATEST: f64 = 2.0;
