//! `identify`: its options as a shell or a script states them, and the request that they make.

use phea_engineering::identify_error::IdentifyError;
use phea_engineering::response::ResponseSettings;
use phea_hydraulics::servovalve::LeakageModel;

use super::{
    FrictionRequest, IdentifyRequest, LineRequest, ResponseRequest, Watch, friction_watched,
    identify_watched, line_watched, response_watched,
};
use crate::answer::Answer;
use crate::project::{LineSide, Loaded};
use crate::quantity::{self, QuantityError, TIME};
use crate::source::Source;

/// Part that recorded tests identify.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IdentifiedPart {
    /// Coefficients of the servovalve.
    #[default]
    Valve,
    /// Frequency responses.
    Response,
    /// A line to the actuator.
    Line,
    /// Friction of the cylinder.
    Friction,
}

impl IdentifiedPart {
    /// Every part.
    pub const ALL: [IdentifiedPart; 4] =
        [IdentifiedPart::Valve, IdentifiedPart::Response, IdentifiedPart::Line, IdentifiedPart::Friction];

    /// Word of the option `of`.
    pub fn name(self) -> &'static str {
        match self {
            IdentifiedPart::Valve => "valve",
            IdentifiedPart::Response => "response",
            IdentifiedPart::Line => "line",
            IdentifiedPart::Friction => "friction",
        }
    }
}

/// Options of an identification; an absent one has its default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IdentifyOptions {
    /// Part to identify.
    pub of: IdentifiedPart,
    /// Recorded tests, as text or Parquet; if empty, those of the project.
    pub files: Vec<String>,
    /// Number of starting points of the search.
    pub starts: Option<usize>,
    /// Seed of the starting points and of the bootstrap.
    pub seed: Option<u32>,
    /// Number of repetitions of the bootstrap.
    pub bootstrap: Option<usize>,
    /// Model of the leakage.
    pub leakage_model: Option<LeakageModel>,
    /// Period of the input of a response, such as `2 s`.
    pub period: Option<String>,
    /// Time to discard at the beginning of a response.
    pub settling: Option<String>,
    /// Length of a segment of a response.
    pub segment: Option<String>,
    /// Least squared coherence.
    pub coherence: Option<f64>,
    /// Chamber to which an identified line leads.
    pub side: Option<LineSide>,
    /// True if figures are requested as files.
    pub figures: bool,
}

/// Way in which an interface spells the names of options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionSpelling {
    /// `--leakage-model`, in a command line.
    CommandLine,
    /// `leakage_model`, a keyword of a function.
    Keyword,
}

/// Fault of an option of `identify`.
#[derive(Clone, Debug, PartialEq)]
pub enum IdentifyOptionError {
    /// The identification of this part does not have the option.
    NoEffect {
        /// Option.
        option: &'static str,
        /// Requested part.
        of: IdentifiedPart,
        /// Parts with the option.
        parts: &'static [IdentifiedPart],
    },
    /// The number is below the least one.
    TooFew {
        /// Option.
        option: &'static str,
        /// Stated number.
        number: usize,
        /// Least number.
        least: usize,
    },
    /// A periodic input has no segments.
    PeriodAndSegment,
    /// The coherence is not from 0 to below 1.
    Coherence(f64),
    /// The time is not positive.
    NotPositive {
        /// Option.
        option: &'static str,
        /// Text as written.
        text: String,
    },
    /// The text is no time.
    NoTime {
        /// Option.
        option: &'static str,
        /// Text as written.
        text: String,
        /// Fault of the text.
        error: Box<QuantityError>,
    },
}

impl IdentifyOptionError {
    /// The fault in a sentence, with the options as an interface spells them.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::command::{IdentifyOptions, OptionSpelling};
    /// let options = IdentifyOptions { side: Some(Default::default()), ..IdentifyOptions::default() };
    /// let fault = options.request().unwrap_err();
    /// let in_a_shell = fault.words(OptionSpelling::CommandLine);
    /// assert_eq!(in_a_shell, "`--side` has no effect on `--of valve`: it belongs to `--of line`");
    /// assert!(fault.words(OptionSpelling::Keyword).starts_with("`side` has no effect on"));
    /// ```
    pub fn words(&self, spelling: OptionSpelling) -> String {
        let name = |option: &str| match spelling {
            OptionSpelling::CommandLine => format!("--{option}"),
            OptionSpelling::Keyword => option.replace('-', "_"),
        };
        let of = |part: IdentifiedPart| match spelling {
            OptionSpelling::CommandLine => format!("`--of {}`", part.name()),
            OptionSpelling::Keyword => format!("`of=\"{}\"`", part.name()),
        };
        match self {
            IdentifyOptionError::NoEffect { option, of: part, parts } => {
                let parts: Vec<String> = parts.iter().map(|part| of(*part)).collect();
                let (option, part, parts) = (name(option), of(*part), parts.join(" and "));
                format!("`{option}` has no effect on {part}: it belongs to {parts}")
            }
            IdentifyOptionError::TooFew { option, number, least } => {
                format!("`{}` is at least {least}, not {number}", name(option))
            }
            IdentifyOptionError::PeriodAndSegment => {
                format!("`{}` cannot be used with `{}`", name("segment"), name("period"))
            }
            IdentifyOptionError::Coherence(value) => {
                format!("`{} {value}` is not from 0 to below 1", name("coherence"))
            }
            IdentifyOptionError::NotPositive { option, text } => {
                format!("`{} {text}` is not a positive time", name(option))
            }
            IdentifyOptionError::NoTime { option, text, error } => {
                format!("`{} {text}`: {error}", name(option))
            }
        }
    }
}

/// Request for an identification.
#[derive(Clone, Debug, PartialEq)]
pub enum IdentificationRequest {
    /// A valve.
    Valve(IdentifyRequest),
    /// Frequency responses.
    Response(ResponseRequest),
    /// A line.
    Line(LineRequest),
    /// Friction.
    Friction(FrictionRequest),
}

/// Least number of repetitions from which a bootstrap has intervals.
const FEWEST_REPETITIONS: usize = 50;

impl IdentifyOptions {
    /// The request of these options.
    ///
    /// # Errors
    /// [`IdentifyOptionError`] for a value that is not accepted, and for an option that the part
    /// does not have.
    pub fn request(self) -> Result<IdentificationRequest, IdentifyOptionError> {
        self.check_part()?;
        let too_few = |option, number: Option<usize>, least| {
            let number = number.filter(|number| *number < least);
            number.map(|number| IdentifyOptionError::TooFew { option, number, least })
        };
        let fault = too_few("starts", self.starts, 1)
            .or_else(|| too_few("bootstrap", self.bootstrap, FEWEST_REPETITIONS));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let settings = self.response_settings()?;
        let (files, figures) = (self.files, self.figures);
        Ok(match self.of {
            IdentifiedPart::Valve => IdentificationRequest::Valve(IdentifyRequest {
                files,
                starts: self.starts,
                seed: self.seed.unwrap_or(1),
                bootstrap: self.bootstrap.unwrap_or(0),
                leakage_model: self.leakage_model,
                figures,
            }),
            IdentifiedPart::Response => {
                IdentificationRequest::Response(ResponseRequest { files, settings, figures })
            }
            IdentifiedPart::Line => {
                IdentificationRequest::Line(LineRequest { files, side: self.side, settings, figures })
            }
            IdentifiedPart::Friction => IdentificationRequest::Friction(FrictionRequest { files, figures }),
        })
    }

    /// Rejects options that the identification of the part does not have.
    fn check_part(&self) -> Result<(), IdentifyOptionError> {
        const VALVE: &[IdentifiedPart] = &[IdentifiedPart::Valve];
        const RESPONSES: &[IdentifiedPart] = &[IdentifiedPart::Response, IdentifiedPart::Line];
        let options = [
            ("starts", self.starts.is_some(), VALVE),
            ("seed", self.seed.is_some(), VALVE),
            ("bootstrap", self.bootstrap.is_some(), VALVE),
            ("leakage-model", self.leakage_model.is_some(), VALVE),
            ("period", self.period.is_some(), RESPONSES),
            ("settling", self.settling.is_some(), RESPONSES),
            ("segment", self.segment.is_some(), RESPONSES),
            ("coherence", self.coherence.is_some(), RESPONSES),
            ("side", self.side.is_some(), &[IdentifiedPart::Line]),
        ];
        let unfit = options.iter().find(|(_, is_stated, parts)| *is_stated && !parts.contains(&self.of));
        match unfit {
            Some((option, _, parts)) => Err(IdentifyOptionError::NoEffect { option, of: self.of, parts }),
            None => Ok(()),
        }
    }

    /// Settings of the estimation of a frequency response. A line omits no frequency unless a
    /// coherence is stated.
    fn response_settings(&self) -> Result<ResponseSettings, IdentifyOptionError> {
        if let Some(value) = self.coherence.filter(|value| !(0.0..1.0).contains(value)) {
            return Err(IdentifyOptionError::Coherence(value));
        }
        if self.period.is_some() && self.segment.is_some() {
            return Err(IdentifyOptionError::PeriodAndSegment);
        }
        let default = match self.of {
            IdentifiedPart::Line => 0.0,
            _ => ResponseSettings::default().coherence,
        };
        Ok(ResponseSettings {
            period: seconds("period", self.period.as_deref())?,
            settling: seconds("settling", self.settling.as_deref())?,
            segment: seconds("segment", self.segment.as_deref())?,
            coherence: self.coherence.unwrap_or(default),
        })
    }
}

/// A time in seconds; only the time to discard may be zero.
fn seconds(option: &'static str, text: Option<&str>) -> Result<Option<f64>, IdentifyOptionError> {
    let Some(text) = text else { return Ok(None) };
    match quantity::parse(text, &TIME) {
        Ok(value) if value > 0.0 || (value == 0.0 && option == "settling") => Ok(Some(value)),
        Ok(_) => Err(IdentifyOptionError::NotPositive { option, text: text.to_string() }),
        Err(error) => {
            Err(IdentifyOptionError::NoTime { option, text: text.to_string(), error: Box::new(error) })
        }
    }
}

/// Identifies a part from recordings.
///
/// # Errors
/// [`IdentifyError`] of the part.
pub fn identification_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    request: &IdentificationRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    match request {
        IdentificationRequest::Valve(request) => identify_watched(source, loaded, request, watch),
        IdentificationRequest::Response(request) => response_watched(source, loaded, request, watch),
        IdentificationRequest::Line(request) => line_watched(source, loaded, request, watch),
        IdentificationRequest::Friction(request) => friction_watched(source, loaded, request, watch),
    }
}
