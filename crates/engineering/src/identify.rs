//! The coefficients of a servovalve from recorded static tests.
//!
//! ```text
//! files -> Recording -> first guess (thesis, section 5.2) -> least squares over all signals at once -> intervals, what the data do not tell
//! ```
//!
//! The model is [`phea_hydraulics::servovalve::TestedValve`]; all signals of all files are explained
//! by one set of coefficients.

mod contents;
mod fit;
mod guess;
mod reading;
mod recording;
mod told;

pub use contents::{ColumnContents, FileContents, Recorded};
pub use guess::SimpleCalculations;
pub use reading::recordings;
pub use recording::{RecordedSignal, Recording, SignalKind};
pub use told::Untold;

use phea_dynamics::least_squares::Ending;
use phea_dynamics::watch::{Stopped, Watch};
use phea_hydraulics::servovalve::{STATIC_COEFFICIENTS, StaticCoefficients, TestedValve};

use crate::project::Refusal;

/// What the coefficients are called, in their order, and their units.
pub const COEFFICIENT_NAMES: [(&str, &str); STATIC_COEFFICIENTS] = [
    ("flow_coefficients.supply_to_a", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.a_to_tank", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.supply_to_b", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.b_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.supply_to_a", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.a_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.supply_to_b", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.b_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_shape", "1"),
    ("tare_flow", "m3/s"),
    ("null_bias", "V"),
    ("hysteresis", "V"),
];

/// What is known beside the files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// V, command of full opening.
    pub nominal_voltage: f64,
    /// Pa, drop below which an edge's flow is laminar.
    pub transition_pressure: f64,
    /// Pa, where a file has no column for it.
    pub supply_pressure: Option<f64>,
    /// Pa, where a file has no column for it.
    pub tank_pressure: f64,
    /// Pa, drop at which the tare flow is to be stated; absent: that of the files.
    pub tare_pressure: Option<f64>,
}

impl Default for Known {
    fn default() -> Known {
        Known {
            nominal_voltage: 10.0,
            transition_pressure: 1e3,
            supply_pressure: None,
            tank_pressure: 0.0,
            tare_pressure: None,
        }
    }
}

/// How thoroughly is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Starting points, the first guess among them.
    pub starts: usize,
    /// Of the others.
    pub seed: u32,
}

impl Default for Search {
    fn default() -> Search {
        Search { starts: 6, seed: 1 }
    }
}

/// The valve that explains the files best.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// What was recorded.
    pub recordings: Vec<Recording>,
    /// Its coefficients.
    pub coefficients: StaticCoefficients,
    /// 95 % confidence interval of each, linearised; `None` where the data do not tell it.
    pub intervals: [Option<[f64; 2]>; STATIC_COEFFICIENTS],
    /// Correlation of each pair, row by row.
    pub correlations: Vec<f64>,
    /// Combinations that the data do not tell, the least known first.
    pub untold: Vec<Untold>,
    /// By the calculations of section 5.2, for comparison.
    pub simple: SimpleCalculations,
    /// How well each signal is explained.
    pub signals: Vec<SignalFit>,
    /// Root mean square of all residuals, each over the range of its signal.
    pub residual_rms: f64,
    /// Coefficients that ended at a bound of the search.
    pub at_bounds: Vec<&'static str>,
    /// Starting points, and how many of them lead to this minimum.
    pub starts: [usize; 2],
    /// How the search ended.
    pub ending: Ending,
    /// What was taken as known.
    pub tested: TestedValve,
}

impl Identification {
    /// Whether no further step explains more.
    pub fn has_converged(&self) -> bool {
        self.ending == Ending::Converged
    }
}

/// How well a signal is explained. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalFit {
    /// Index of the recording.
    pub recording: usize,
    /// Which signal.
    pub kind: SignalKind,
    /// Rows that count.
    pub rows: usize,
    /// Root mean square of the residuals.
    pub rms: f64,
    /// Scale of the residuals that a few outliers do not change.
    pub scale: f64,
    /// Largest less smallest recorded value.
    pub range: f64,
    /// Correlation of neighbouring residuals: near zero for noise, near one where the model is wrong.
    pub correlation: f64,
}

/// Why nothing was identified.
#[derive(Debug, thiserror::Error)]
pub enum IdentifyError {
    /// Files are refused.
    #[error("{0}")]
    Files(Box<Refusal>),
    /// The files say nothing that coefficients follow from.
    #[error("{0}")]
    Data(String),
    /// Whoever watched stopped it.
    #[error("stopped")]
    Stopped,
}

impl From<Stopped> for IdentifyError {
    fn from(_: Stopped) -> IdentifyError {
        IdentifyError::Stopped
    }
}

/// Finds the coefficients that explain all recordings at once.
///
/// # Errors
/// [`IdentifyError`] where the recordings cannot be explained by any valve, and when it is stopped.
pub fn identify(
    recordings: Vec<Recording>,
    known: &Known,
    search: Search,
    watch: Watch<'_>,
) -> Result<Identification, IdentifyError> {
    let tested = TestedValve {
        nominal_voltage: known.nominal_voltage,
        transition_pressure: known.transition_pressure,
        tare_reference_drop: known.tare_pressure.unwrap_or_else(|| recording::usual_drop(&recordings)),
    };
    let simple = guess::simple_calculations(&recordings, &tested);
    let start = guess::first_guess(&recordings, &tested, &simple);
    fit::fitted(recordings, tested, (simple, start), search, watch)
}
