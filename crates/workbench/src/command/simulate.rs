//! `simulate`: scenarios, or a frequency response.

use phea_engineering::setup::Setup;
use phea_engineering::simulate::{
    FrequencyRequest, RunOutput, ScenarioRun, files, frequency_response, simulate_checked, simulate_into,
};

use super::unprinted::Unprinted;
use super::{CommandError, Watch, positive};
use crate::answer::{Body, OutputFile, TableFormat, picture_files};
use crate::caveat::misfits_in_runs;
use crate::project::Loaded;
use crate::quantity::MotionKind;
use crate::quantity::{ANGULAR_FREQUENCY, Dimension, FORCE, VOLTAGE};
use crate::simulate::{
    body, document, figure_files, frequency_body, frequency_document, frequency_files, frequency_pictures,
};
use crate::source::{Destination, Source};

/// Request for `simulate`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SimulateRequest {
    /// Format of the tables.
    pub table: TableFormat,
    /// True if figures are requested as files.
    pub figures: bool,
    /// The frequency response of the machine instead of its scenarios.
    pub frequency_response: Option<FrequencyOptions>,
    /// True if each scenario is run a second time at a tenth of the tolerance, with a report of the
    /// difference.
    pub check: bool,
    /// True if each run has accounts of oil and energy, which cost as much as its solution; an
    /// answer without them states that they were not requested.
    pub ledgers: bool,
}

/// Options of a frequency response, as written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrequencyOptions {
    /// Frequencies, such as `1, 10, 100 rad/s`: a unit applies to the bare numbers before it.
    pub frequencies: Option<String>,
    /// Amplitude of the command of the open loop, such as `0.1 V`.
    pub amplitude: Option<String>,
    /// Amplitude of the reference of the closed loop, such as `100 N`.
    pub reference_amplitude: Option<String>,
}

impl FrequencyOptions {
    /// The request, in SI.
    ///
    /// # Errors
    /// [`CommandError`] for a text that is not a positive quantity of its kind.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::command::FrequencyOptions;
    /// use phea_workbench::quantity::MotionKind;
    /// let options = FrequencyOptions { amplitude: Some("100 mV".to_string()), ..FrequencyOptions::default() };
    /// assert_eq!(options.request(MotionKind::Linear)?.command_amplitude_v, Some(0.1));
    /// # Ok::<(), phea_workbench::command::CommandError>(())
    /// ```
    pub fn request(&self, motion: MotionKind) -> Result<FrequencyRequest, CommandError> {
        let one = |option: &'static str, text: &Option<String>, dimension: &'static Dimension| {
            text.as_deref().map(|text| positive(option, text, text, dimension)).transpose()
        };
        Ok(FrequencyRequest {
            frequencies_rad_per_s: self.frequencies.as_deref().map_or(Ok(vec![]), frequencies)?,
            command_amplitude_v: one("amplitude", &self.amplitude, &VOLTAGE)?,
            reference_amplitude_n: one(
                "reference-amplitude",
                &self.reference_amplitude,
                motion.dimension(&FORCE),
            )?,
        })
    }
}

pub(super) fn simulate_answer(
    source: &dyn Source,
    loaded: &Loaded,
    request: &SimulateRequest,
    destination: Option<&dyn Destination>,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    if let Some(options) = &request.frequency_response {
        return frequency_answer(loaded, request, &options.request(loaded.project.motion())?, watch);
    }
    let table = destination.map(|destination| (destination, request.table));
    let setup = Setup::new(&loaded.project)?;
    let runs = if request.check {
        simulate_checked(source, &setup, table, watch)?
    } else {
        simulate_into(
            source,
            &setup,
            RunOutput { ledger: request.ledgers, ..RunOutput::new(request.figures, table) },
            watch,
        )?
    };
    let mut written = files(loaded, &runs);
    if request.figures {
        written.extend(figure_files(&runs));
    }
    let all = runs.len() == loaded.project.scenarios.len();
    let warnings = misfits_in_runs(&loaded.project);
    Ok(Unprinted {
        document: document(loaded, &runs),
        body: body(loaded, &runs, warnings.clone()).into_object(),
        files: written,
        affirmative: all && runs.iter().all(ScenarioRun::is_reliable),
    }
    .with_warnings(warnings))
}

fn frequency_answer(
    loaded: &Loaded,
    request: &SimulateRequest,
    sines: &FrequencyRequest,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let found = frequency_response(&Setup::new(&loaded.project)?, sines, watch)?;
    // writing to memory cannot fail
    let mut written: Vec<OutputFile> =
        frequency_files(&found, request.table, loaded.project.motion()).unwrap_or_default();
    if request.figures {
        written.extend(picture_files(&frequency_pictures(&found)));
    }
    Ok(Unprinted {
        document: frequency_document(&found),
        body: frequency_body(loaded, &found).into_object(),
        files: written,
        affirmative: found.is_settled(),
    })
}

/// `1, 10, 100 Hz`: the unit applies to the bare numbers before it; the default is rad/s.
pub(super) fn frequencies(text: &str) -> Result<Vec<f64>, CommandError> {
    let mut unit = "";
    let mut found = Vec::new();
    for part in text.rsplit(',').map(str::trim) {
        let bare = is_number(part);
        if !bare {
            let number = (0..part.len()).rev().find(|end| part.get(..*end).is_some_and(is_number));
            unit = number.and_then(|end| part.get(end..)).unwrap_or_default().trim();
        }
        let written = if bare { format!("{part} {unit}") } else { part.to_string() };
        found.push(positive("frequencies", text, written.trim(), &ANGULAR_FREQUENCY)?);
    }
    found.reverse();
    Ok(found)
}

fn is_number(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok()
}
