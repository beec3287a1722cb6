use phea_dynamics::portable::{argument, log10, magnitude};
use phea_dynamics::spectrum::{LOCAL_BLOCKS, SpectralPoint};
use phea_engineering::response::{Averaging, LeftOut, LevelComparison, ReferenceSource, Resampled, Unusable};

use super::levels::{LevelComparisonAnswer, compared_levels};
use super::{Compared, because};
use crate::answer::{Answer, Body, SCHEMA, VERSION, words};
use crate::project::Loaded;
use crate::quantity::MotionKind;

/// Frequency responses identified from recorded signals.
#[derive(Answer)]
pub(crate) struct IdentifiedResponsesAnswer {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command.
    command: &'static str,
    /// SHA-256 of the bytes of the project file; null without a project.
    project_sha256: Option<String>,
    /// Responses, and comparisons of them.
    response: RecordedResponsesAnswer,
}

/// Responses of all records, and comparisons of those at one operating point.
#[derive(Answer)]
struct RecordedResponsesAnswer {
    /// Response of each record, which is a member of a measured family.
    members: Vec<ResponseMemberAnswer>,
    /// Comparisons of each two records at one operating point, if there are any.
    #[answer(optional)]
    comparisons: Option<Vec<LevelComparisonAnswer>>,
}

/// Frequency response from one record.
#[derive(Answer)]
struct ResponseMemberAnswer {
    /// Path of the record.
    file: String,
    /// Name of the column of the input.
    input: &'static str,
    /// Name of the column of the output.
    output: &'static str,
    /// SI unit of the response, output over input.
    unit: String,
    /// Number of rows of the record.
    rows: usize,
    /// Time between two rows.
    time_step_s: f64,
    /// Operating point of the test, if the project names it.
    #[answer(optional)]
    operating_point: Option<String>,
    /// Root mean square of the input around its mean, in SI.
    input_rms: f64,
    /// Averaging of the record.
    method: Averaging,
    /// Name of the column of the signal that moves a closed loop, if the record has one.
    #[answer(optional)]
    reference: Option<&'static str>,
    /// Controller from which the reference of a closed loop is calculated, if so.
    #[answer(optional)]
    controller: Option<TestControllerSource>,
    /// Length of a block: a period, a segment, or the record.
    block_s: f64,
    /// Number of blocks.
    blocks: usize,
    /// Number of independent blocks with the same scatter.
    independent_blocks: f64,
    /// Squared coherence below which a frequency is omitted.
    least_coherence: f64,
    /// Response at each frequency, the lowest first.
    frequencies: Vec<ResponsePointAnswer>,
    /// Excited frequencies that are omitted, the lowest first.
    rows_left_out: Vec<OmittedFrequencyAnswer>,
    /// Number of frequencies that the input does not excite.
    lines_not_excited: usize,
    /// Distortion of the output, only of a periodic input.
    #[answer(optional)]
    distortion: Option<DistortionAnswer>,
    /// Resampling, only of rows that are not even.
    #[answer(optional)]
    resampled: Option<ResampledAnswer>,
    /// Comparison with the linear plant of the project, if it has one of these signals.
    #[answer(optional)]
    linear_plant: Option<PlantAgreementAnswer>,
    /// Sentences on findings, if there are any.
    #[answer(optional)]
    warnings: Option<Vec<String>>,
}

/// Origin of the controller of a recorded loop.
enum TestControllerSource {
    Declared,
}

words! {
    /// Origin of the controller of a recorded loop.
    TestControllerSource { Declared => "declared" }
}

words! {
    /// Averaging of a record: over periods, by local polynomials in frequency, or over segments.
    Averaging {
        Periods { .. } => "periods",
        LocalPolynomials { .. } => "local_polynomials",
        Segments { .. } => "segments",
    }
}

words! {
    /// Reason for which a frequency is omitted.
    Unusable by because [NotExcited, Incoherent]
}

/// Response at one frequency.
#[derive(Answer)]
struct ResponsePointAnswer {
    /// Frequency.
    frequency_rad_per_s: f64,
    /// Magnitude over that of 1 in the unit of the response.
    magnitude_db: f64,
    /// Phase, from -180 to 180.
    phase_deg: f64,
    /// Squared coherence, from 0 to 1.
    coherence: f64,
    /// Standard deviation of the complex response, in its unit.
    standard_deviation: f64,
    /// Radius of the disc around the response that contains the true one with 95 %, in its unit.
    confidence_95: f64,
    /// Radius of the disc over the magnitude of the response.
    relative_confidence_95: f64,
}

/// Frequency without a usable response.
#[derive(Answer)]
struct OmittedFrequencyAnswer {
    /// Frequency.
    frequency_rad_per_s: f64,
    /// Squared coherence, from 0 to 1.
    coherence: f64,
    /// Reason for which it is omitted.
    reason: Unusable,
}

/// Size of the output at frequencies that a periodic input does not excite, over that at excited
/// ones; 0 if it is no more than noise.
#[derive(Answer)]
struct DistortionAnswer {
    /// Distortion at even multiples of the frequency of the period.
    even: f64,
    /// Distortion at odd multiples.
    odd: f64,
}

/// Resampling of rows at uneven times.
#[derive(Answer)]
struct ResampledAnswer {
    /// Time between the earliest and the latest row, each relative to even ones.
    scatter_s: f64,
    /// Longest time from one row to the next.
    longest_gap_s: f64,
    /// Highest frequency that straight lines between the rows follow within 5 %.
    highest_frequency_rad_per_s: f64,
}

/// Agreement of a response with the linear plant of the project.
#[derive(Answer)]
struct PlantAgreementAnswer {
    /// Number of frequencies at which the plant is inside the disc of 95 %.
    within_confidence_95: usize,
    /// Largest magnitude of the ratio of response to plant.
    largest_difference_db: f64,
}

/// The JSON object of `identify --of response`.
pub fn json(loaded: Option<&Loaded>, found: &[Compared], comparisons: &[LevelComparison]) -> String {
    let compared = comparisons.iter().map(|one| compared_levels(one, found)).collect();
    let answer = IdentifiedResponsesAnswer {
        schema: SCHEMA,
        version: VERSION,
        command: "identify",
        project_sha256: loaded.map(|loaded| loaded.sha256.clone()),
        response: RecordedResponsesAnswer {
            members: found.iter().map(member).collect(),
            comparisons: Some(compared).filter(|all: &Vec<_>| !all.is_empty()),
        },
    };
    let motion = loaded.map_or(MotionKind::Linear, |loaded| loaded.project.motion());
    answer.into_object().print(motion)
}

fn member(compared: &Compared) -> ResponseMemberAnswer {
    let found = &compared.member;
    let (block_s, blocks, independent_blocks) = match found.method {
        Averaging::Periods { period, count } => (period, count, count as f64),
        Averaging::LocalPolynomials { length, .. } => (length, 1, LOCAL_BLOCKS),
        Averaging::Segments { length, count, independent } => (length, count, independent),
    };
    let incoherent = found.left_out.iter().filter(|one| one.reason == Unusable::Incoherent);
    let rows_left_out: Vec<OmittedFrequencyAnswer> = incoherent.map(omitted).collect();
    let is_periodic = matches!(found.method, Averaging::Periods { .. });
    ResponseMemberAnswer {
        file: found.file.clone(),
        input: found.signals[0],
        output: found.signals[1],
        unit: format!("{}/{}", found.units[1], found.units[0]),
        rows: found.rows,
        time_step_s: found.time_step,
        operating_point: found.operating_point.clone(),
        input_rms: found.input_rms,
        method: found.method,
        reference: match found.reference {
            Some(ReferenceSource::Column(name)) => Some(name),
            Some(ReferenceSource::Controller) | None => None,
        },
        controller: (found.reference == Some(ReferenceSource::Controller))
            .then_some(TestControllerSource::Declared),
        block_s,
        blocks,
        independent_blocks,
        least_coherence: found.least_coherence,
        frequencies: found.points.iter().map(point).collect(),
        lines_not_excited: found.left_out.len() - rows_left_out.len(),
        rows_left_out,
        distortion: is_periodic
            .then_some(DistortionAnswer { even: found.distortion.even, odd: found.distortion.odd }),
        resampled: found.resampled.map(resampled),
        linear_plant: compared.agreement().map(|(within, largest)| PlantAgreementAnswer {
            within_confidence_95: within,
            largest_difference_db: largest,
        }),
        warnings: Some(compared.warnings()).filter(|all| !all.is_empty()),
    }
}

/// Radius of the disc of 95 % over the magnitude of the response.
pub(super) fn relative_radius(point: &SpectralPoint) -> f64 {
    point.radius / magnitude(point.response)
}

fn point(point: &SpectralPoint) -> ResponsePointAnswer {
    ResponsePointAnswer {
        frequency_rad_per_s: point.frequency,
        magnitude_db: 20.0 * log10(magnitude(point.response)),
        phase_deg: argument(point.response).to_degrees(),
        coherence: point.coherence,
        standard_deviation: point.deviation,
        confidence_95: point.radius,
        relative_confidence_95: relative_radius(point),
    }
}

fn omitted(one: &LeftOut) -> OmittedFrequencyAnswer {
    OmittedFrequencyAnswer {
        frequency_rad_per_s: one.frequency,
        coherence: one.coherence,
        reason: one.reason,
    }
}

fn resampled(rows: Resampled) -> ResampledAnswer {
    ResampledAnswer {
        scatter_s: rows.scatter,
        longest_gap_s: rows.longest,
        highest_frequency_rad_per_s: rows.highest(),
    }
}
