//! Frequency responses from recorded signals: members of a measured family.
//!
//! ```text
//! file -> SampledPair -> whole periods | local polynomials | overlapping segments -> points -> those that are sufficiently well known
//! ```
//!
//! A periodic input (a multisine, a repeated chirp) is averaged over its periods; any other (noise,
//! a single sweep, a step) is estimated band by band, from the reference of a closed loop, or by
//! its controller. One file is one member.

mod levels;
mod member;
mod reading;
mod resampled;
mod spacing;
mod spacing_error;
mod test_controller;

pub use levels::{FALSE_ALARM, LevelComparison, LevelDifference, compare_levels};
pub use member::{Averaging, LeftOut, ResponseMember, Unusable};
pub use reading::{ReferenceSignal, ReferenceSource, SampledPair, sampled_pairs};
pub use resampled::Resampled;
pub(crate) use resampled::{EvenRows, even_rows, interpolated, is_software_timed};
pub use spacing::{RowSpacing, UNEVEN, time_step};
pub use spacing_error::EvenlySampled;
pub use test_controller::TestController;

use phea_dynamics::watch::{Watch, report_progress};

use crate::identify_error::{IdentifyError, ResponseFitError};

/// Settings of the estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseSettings {
    /// Period of a periodic input, s; found if absent.
    pub period: Option<f64>,
    /// Omitted time at the beginning, s; absent: one period of a periodic input, otherwise nothing.
    pub settling: Option<f64>,
    /// Length of a segment, s; absent: an input that does not repeat is used as a whole.
    pub segment: Option<f64>,
    /// Squared coherence below which a frequency is omitted.
    pub coherence: f64,
}

impl Default for ResponseSettings {
    /// Default settings: a squared coherence of 0.8 over ten blocks leaves a standard deviation of
    /// 17 % of the response.
    fn default() -> ResponseSettings {
        ResponseSettings { period: None, settling: None, segment: None, coherence: 0.8 }
    }
}

/// Members of a family from records, one each.
///
/// # Errors
/// [`IdentifyError`] if a record is too short or its input does not move, and after cancellation.
pub fn members(
    records: &[SampledPair],
    settings: &ResponseSettings,
    watch: Watch<'_>,
) -> Result<Vec<ResponseMember>, IdentifyError> {
    let mut members = Vec::with_capacity(records.len());
    for (index, record) in records.iter().enumerate() {
        report_progress(watch, "frequency responses", index, records.len())?;
        let fault = |fault| ResponseFitError { file: record.file.clone(), fault };
        members.push(member::member(record, settings).map_err(fault)?);
    }
    Ok(members)
}
