use phea_dynamics::portable::{argument, log10, magnitude};
use phea_dynamics::spectrum::LOCAL_BLOCKS;
use serde::Serialize;

use super::levels::{ComparedLevels, compared_levels};
use super::{Averaging, Compared, LeftOut, LevelComparison, ReferenceSource, Unusable, because};
use crate::answer::{self, Number};
use crate::project::Loaded;

#[derive(Serialize)]
struct ResponsesBody<'a> {
    schema: u32,
    version: &'static str,
    command: &'static str,
    project_sha256: Option<&'a str>,
    response: RecordedResponses<'a>,
}

#[derive(Serialize)]
struct RecordedResponses<'a> {
    members: Vec<ResponseMemberBody<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    comparisons: Vec<ComparedLevels<'a>>,
}

#[derive(Serialize)]
struct ResponseMemberBody<'a> {
    file: &'a str,
    input: &'static str,
    output: &'static str,
    unit: String,
    rows: usize,
    time_step_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    operating_point: Option<&'a str>,
    input_rms: Number,
    method: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    controller: Option<&'static str>,
    block_s: f64,
    blocks: usize,
    independent_blocks: Number,
    least_coherence: Number,
    frequencies: Vec<ResponseAt>,
    rows_left_out: Vec<LeftOutAt>,
    lines_not_excited: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    distortion: Option<DistortionOf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    resampled: Option<ResampledRows>,
    #[serde(skip_serializing_if = "Option::is_none")]
    linear_plant: Option<AgreementWithPlant>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct ResponseAt {
    frequency_rad_per_s: f64,
    magnitude_db: Number,
    phase_deg: Number,
    coherence: Number,
    standard_deviation: Number,
    confidence_95: Number,
}

#[derive(Serialize)]
struct LeftOutAt {
    frequency_rad_per_s: f64,
    coherence: Number,
    reason: &'static str,
}

#[derive(Serialize)]
struct DistortionOf {
    even: Number,
    odd: Number,
}

#[derive(Serialize)]
struct ResampledRows {
    scatter_s: f64,
    longest_gap_s: f64,
    highest_frequency_rad_per_s: f64,
}

#[derive(Serialize)]
struct AgreementWithPlant {
    within_confidence_95: usize,
    largest_difference_db: Number,
}

/// The JSON object of `identify --of response`.
pub fn json(loaded: Option<&Loaded>, found: &[Compared], comparisons: &[LevelComparison]) -> String {
    let body = ResponsesBody {
        schema: answer::SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        command: "identify",
        project_sha256: loaded.map(|loaded| loaded.sha256.as_str()),
        response: RecordedResponses {
            members: found.iter().map(member).collect(),
            comparisons: comparisons.iter().map(|one| compared_levels(one, found)).collect(),
        },
    };
    // every number that may not exist is one of `Number` or `Option`
    serde_json::to_string_pretty(&body).unwrap_or_default()
}

fn member(compared: &Compared) -> ResponseMemberBody<'_> {
    let found = &compared.member;
    let (method, block_s, blocks, independent) = match found.method {
        Averaging::Periods { period, count } => ("periods", period, count, count as f64),
        Averaging::LocalPolynomials { length, .. } => ("local_polynomials", length, 1, LOCAL_BLOCKS),
        Averaging::Segments { length, count, independent } => ("segments", length, count, independent),
    };
    let incoherent = found.left_out.iter().filter(|one| one.reason == Unusable::Incoherent);
    let left_out = |one: &LeftOut| LeftOutAt {
        frequency_rad_per_s: one.frequency,
        coherence: Number(one.coherence),
        reason: because(one.reason),
    };
    let point = |point: &phea_dynamics::spectrum::SpectralPoint| ResponseAt {
        frequency_rad_per_s: point.frequency,
        magnitude_db: Number(20.0 * log10(magnitude(point.response))),
        phase_deg: Number(argument(point.response).to_degrees()),
        coherence: Number(point.coherence),
        standard_deviation: Number(point.deviation),
        confidence_95: Number(point.radius),
    };
    let rows_left_out: Vec<LeftOutAt> = incoherent.map(left_out).collect();
    ResponseMemberBody {
        file: &found.file,
        input: found.signals[0],
        output: found.signals[1],
        unit: format!("{}/{}", found.units[1], found.units[0]),
        rows: found.rows,
        time_step_s: found.time_step,
        operating_point: found.operating_point.as_deref(),
        input_rms: Number(found.input_rms),
        method,
        reference: match found.reference {
            Some(ReferenceSource::Column(name)) => Some(name),
            _ => None,
        },
        controller: (found.reference == Some(ReferenceSource::Controller)).then_some("declared"),
        block_s,
        blocks,
        independent_blocks: Number(independent),
        least_coherence: Number(found.least_coherence),
        frequencies: found.points.iter().map(point).collect(),
        lines_not_excited: found.left_out.len() - rows_left_out.len(),
        rows_left_out,
        distortion: matches!(found.method, Averaging::Periods { .. })
            .then(|| DistortionOf { even: Number(found.distortion.even), odd: Number(found.distortion.odd) }),
        resampled: found.resampled.map(|resampled| ResampledRows {
            scatter_s: resampled.scatter,
            longest_gap_s: resampled.longest,
            highest_frequency_rad_per_s: resampled.highest(),
        }),
        linear_plant: compared.agreement().map(|(held, apart)| AgreementWithPlant {
            within_confidence_95: held,
            largest_difference_db: Number(apart),
        }),
        warnings: compared.warnings(),
    }
}
