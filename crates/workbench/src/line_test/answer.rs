use phea_engineering::estimate::Estimate;
use phea_engineering::line_test::{
    CompliancePoint, LineIdentification, LineMisfit, NotIdentifiableLine, ResponseFit, RiseFit, VolumeSource,
};

use super::{because, misfit_in_words, remark};
use crate::answer::{Answer, Body, FileWarningAnswer, OrReason, SCHEMA, VERSION, words};
use crate::project::{LineSide, Loaded};

/// Line identified from recordings with its far end blocked.
#[derive(Answer)]
pub(crate) struct IdentifiedLineAnswer {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command.
    command: &'static str,
    /// SHA-256 of the bytes of the project file.
    project_sha256: String,
    /// Identified line.
    line: LineAnswer,
}

/// Numbers of a line, and the tests from which they follow.
#[derive(Answer)]
struct LineAnswer {
    /// Effective bulk modulus at rest.
    effective_bulk_modulus_pa: LineEstimateAnswer,
    /// Dynamic stiffening of the wall of a hose: its stiffness in fast motion over that at rest.
    dynamic_stiffening: LineEstimateAnswer,
    /// Speed of a fast pressure wave.
    wave_speed_m_per_s: LineEstimateAnswer,
    /// Effective bulk modulus in fast motion.
    dynamic_bulk_modulus_pa: LineEstimateAnswer,
    /// Time in which the pressure relaxes while the volume is held.
    relaxation_time_s: LineEstimateAnswer,
    /// Bulk modulus between both ends of the pressure rise.
    secant_bulk_modulus_pa: LineEstimateAnswer,
    /// Volume of free air at atmospheric pressure over that of the mixture.
    entrained_air: LineEstimateAnswer,
    /// Density of the oil, from its inertia with the declared length and bore.
    density_kg_per_m3: LineEstimateAnswer,
    /// Change of the bulk modulus at rest per change of the pressure.
    modulus_slope: LineEstimateAnswer,
    /// Chamber at the end of the line.
    chamber: LineSide,
    /// Pressure at which the numbers are stated.
    pressure_pa: f64,
    /// Volume of the oil in the line, to which the moduli refer.
    volume_m3: f64,
    /// Signals that the line does not explain.
    misfits: Vec<LineMisfitAnswer>,
    /// Misfits in sentences.
    warnings: Vec<FileWarningAnswer>,
    /// Remark on parts that the test omits, if there are any.
    #[answer(optional)]
    remark: Option<&'static str>,
    /// Fit of the slow pressure rise; null without one.
    pressure_rise: Option<PressureRiseAnswer>,
    /// Fit of the frequency response; null without one.
    frequency_response: Option<LineResponseAnswer>,
}

/// Number of a line with its confidence interval.
#[derive(Answer)]
struct LineEstimateAnswer {
    /// Estimate; null if the recordings do not determine it.
    value: Option<f64>,
    /// Confidence interval of 95 %, from low to high; null without an estimate.
    #[answer(interval)]
    confidence_95: Option<[f64; 2]>,
    /// Reason for which there is no estimate; null if there is one.
    reason: Option<String>,
}

/// Signal that the line does not explain.
#[derive(Answer)]
struct LineMisfitAnswer {
    /// Path of the recording.
    file: String,
    /// Signal with the misfit: `volume` of a pressure rise, `response` of a frequency response.
    signal: &'static str,
    /// Root mean square of the misfit over the range of the volume, or over the response.
    fraction: f64,
    /// Correlation of neighbouring residuals; null of a frequency response.
    neighbour_correlation: Option<f64>,
}

/// Fit of a slow pressure rise.
#[derive(Answer)]
struct PressureRiseAnswer {
    /// Path of the recording.
    file: String,
    /// Number of rows.
    rows: usize,
    /// Origin of the displaced volume.
    volume_from: VolumeSource,
    /// Lowest and highest pressure.
    #[answer(interval)]
    pressures_pa: [f64; 2],
    /// Number of terms of the volume over the pressure; 1 for a constant compliance, that of free
    /// air apart.
    terms: usize,
    /// Compliance at the lowest, the middle and the highest pressure.
    compliance: [TangentComplianceAnswer; 3],
    /// Flow that the meter shows, or the line loses, at standstill.
    drift_m3_per_s: OrReason<f64>,
    /// Root mean square of the noise of the volume that differs from row to row.
    volume_noise_m3: f64,
    /// Root mean square of the growth, from row to row, of the summed noise of a flow meter.
    volume_walk_m3: f64,
}

/// Slope of the displaced volume over the pressure.
#[derive(Answer)]
struct TangentComplianceAnswer {
    /// Pressure.
    pressure_pa: f64,
    /// Slope of the volume over the pressure.
    compliance_m3_per_pa: f64,
    /// Standard deviation of the compliance, in its unit.
    standard_deviation: f64,
}

/// Fit of a frequency response, pressure over flow.
#[derive(Answer)]
struct LineResponseAnswer {
    /// Path of the recording.
    file: String,
    /// Number of rows.
    rows: usize,
    /// Mean recorded pressure.
    pressure_pa: f64,
    /// Sum of the squared residuals over that of noise, for each degree of freedom.
    misfit: f64,
    /// Degrees of freedom of the residuals.
    degrees_of_freedom: f64,
    /// True if the residuals are no larger than noise makes them.
    explained: bool,
    /// Compliance at each frequency, the lowest first.
    compliance: Vec<DynamicComplianceAnswer>,
}

/// Compliance at one frequency: imaginary part of flow over pressure, divided by the frequency.
#[derive(Answer)]
struct DynamicComplianceAnswer {
    /// Frequency.
    frequency_rad_per_s: f64,
    /// Measured compliance.
    compliance_m3_per_pa: f64,
    /// Half of the confidence interval of 95 % of the measured compliance, in its unit.
    confidence_95: f64,
    /// Compliance of the fitted line; null if its model does not exist.
    model_m3_per_pa: Option<f64>,
    /// Squared coherence of the recording, from 0 to 1.
    coherence: f64,
}

words! {
    /// Chamber of the cylinder or motor.
    LineSide { A => "a", B => "b" }
}

words! {
    /// Origin of a displaced volume: integral of a flow, recorded volume, or position of a piston
    /// times its area.
    VolumeSource { Flow => "flow", Volume => "volume", Position => "position" }
}

/// The JSON object of `identify --of line`.
pub fn json(loaded: &Loaded, found: &LineIdentification) -> String {
    let answer = IdentifiedLineAnswer {
        schema: SCHEMA,
        version: VERSION,
        command: "identify",
        project_sha256: loaded.sha256.clone(),
        line: line(found),
    };
    answer.into_object().print(loaded.project.motion())
}

fn line(found: &LineIdentification) -> LineAnswer {
    let misfits = found.misfits();
    let warning = |one: &LineMisfit| FileWarningAnswer::of_file(misfit_in_words(one), &one.file);
    LineAnswer {
        effective_bulk_modulus_pa: estimate(&found.effective_bulk_modulus),
        dynamic_stiffening: estimate(&found.dynamic_stiffening),
        wave_speed_m_per_s: estimate(&found.wave_speed),
        dynamic_bulk_modulus_pa: estimate(&found.dynamic_bulk_modulus),
        relaxation_time_s: estimate(&found.relaxation_time),
        secant_bulk_modulus_pa: estimate(&found.secant_bulk_modulus),
        entrained_air: estimate(&found.entrained_air),
        density_kg_per_m3: estimate(&found.density),
        modulus_slope: estimate(&found.modulus_slope),
        chamber: found.known.side,
        pressure_pa: found.pressure,
        volume_m3: found.known.volume(),
        warnings: misfits.iter().map(warning).collect(),
        misfits: misfits.into_iter().map(misfit).collect(),
        remark: remark(&found.known),
        pressure_rise: found.rise.as_ref().map(rise),
        frequency_response: found.response.as_ref().map(|fit| response(found, fit)),
    }
}

fn estimate(number: &Result<Estimate, NotIdentifiableLine>) -> LineEstimateAnswer {
    match number {
        Ok(Estimate { value, interval }) => {
            LineEstimateAnswer { value: Some(*value), confidence_95: Some(*interval), reason: None }
        }
        Err(reason) => {
            LineEstimateAnswer { value: None, confidence_95: None, reason: Some(because(*reason)) }
        }
    }
}

fn misfit(one: LineMisfit) -> LineMisfitAnswer {
    LineMisfitAnswer {
        file: one.file,
        signal: one.signal,
        fraction: one.fraction,
        neighbour_correlation: one.correlation,
    }
}

fn rise(fit: &RiseFit) -> PressureRiseAnswer {
    let [low, high] = fit.pressures;
    let tangent = |pressure: f64| {
        let [value, deviation] = fit.compliance(pressure);
        TangentComplianceAnswer {
            pressure_pa: pressure,
            compliance_m3_per_pa: value,
            standard_deviation: deviation,
        }
    };
    PressureRiseAnswer {
        file: fit.record.file.clone(),
        rows: fit.record.pressures.len(),
        volume_from: fit.record.source,
        pressures_pa: [low, high],
        terms: fit.terms(),
        compliance: [low, f64::midpoint(low, high), high].map(tangent),
        drift_m3_per_s: OrReason::new(
            fit.drift,
            "the record has no standstill that separates it from the compliance",
        ),
        volume_noise_m3: fit.white_noise,
        volume_walk_m3: fit.walk,
    }
}

fn response(found: &LineIdentification, fit: &ResponseFit) -> LineResponseAnswer {
    let [misfit, degrees_of_freedom] = fit.misfit;
    let compliance = |point: CompliancePoint| DynamicComplianceAnswer {
        frequency_rad_per_s: point.frequency,
        compliance_m3_per_pa: point.measured,
        confidence_95: point.edge,
        model_m3_per_pa: Some(point.model).filter(|model| !model.is_nan()),
        coherence: point.coherence,
    };
    LineResponseAnswer {
        file: fit.member.file.clone(),
        rows: fit.member.rows,
        pressure_pa: fit.pressure,
        misfit,
        degrees_of_freedom,
        explained: fit.is_explained(),
        compliance: fit.compliances(&found.known).into_iter().map(compliance).collect(),
    }
}
