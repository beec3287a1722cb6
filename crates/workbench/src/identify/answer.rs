//! The JSON of `identify` of a valve.

mod estimates;
mod evidence;
mod residuals;

pub(super) use estimates::EITHER_SIGN;
pub(super) use residuals::correlations;

use phea_engineering::identify::{Identification, TestOil};
use phea_hydraulics::servovalve::LeakageModel;

use self::estimates::{
    BootstrapAnswer, ValveEdgesAnswer, ValveEstimateAnswer, ValveEstimates, ValveLapAnswer,
};
use self::evidence::{CoefficientValuesAnswer, LeakageFitAnswer, ValveTermAnswer};
use self::residuals::{CorrelationAnswer, NotIdentifiableAnswer, ValveMisfitAnswer, ValveSignalAnswer};
use super::Read;
use super::files::ValveTestAnswer;
use super::numbers::{GraphReadingsAnswer, graph_readings};
use super::region::{FoundRegion, JointRegionAnswer, joint_region_answer};
use crate::answer::{Answer, Body, FileWarningAnswer, SCHEMA, VERSION};
use crate::project::Loaded;
use crate::quantity::MotionKind;

/// Valve identified from recorded static tests.
#[derive(Answer)]
pub(crate) struct IdentifiedValveAnswer {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command.
    command: &'static str,
    /// SHA-256 of the bytes of the project file; null without a project.
    project_sha256: Option<String>,
    /// Recorded tests in the order of the files.
    tests: Vec<ValveTestAnswer>,
    /// Findings in the files, and signals that the identified valve does not explain.
    warnings: Vec<FileWarningAnswer>,
    /// Flow coefficient K_v of each edge, m3/(s.Pa^0.5).
    flow_coefficients: ValveEdgesAnswer,
    /// Leakage coefficient K_vin of each edge at null, m3/(s.Pa^0.5).
    leakage_coefficients: ValveEdgesAnswer,
    /// Shape lambda of the leakage, which is in proportion to sech(lambda U/U_n); of the edge from
    /// the supply to A if each edge has its own.
    leakage_shape: ValveEstimateAnswer,
    /// Flow of the pilot stage from supply to tank, at `tare_pressure_pa`.
    tare_flow_m3_per_s: ValveEstimateAnswer,
    /// Pressure drop from supply to tank at which the tare flow is stated.
    tare_pressure_pa: f64,
    /// Temperature of the oil in the tests; null if none recorded it.
    oil_temperature: Option<TestOilAnswer>,
    /// Spool position at which the valve is at null.
    null_bias_v: ValveEstimateAnswer,
    /// Width of the hysteresis over a slow full cycle of the command.
    hysteresis_v: ValveEstimateAnswer,
    /// Model of the leakage for which the values are stated.
    leakage_model: LeakageModel,
    /// Fits with both models of the leakage, the better one first.
    leakage_models: [LeakageFitAnswer; 2],
    /// Criterion of the worse model of the leakage less that of the better one.
    leakage_models_difference: f64,
    /// Better model of the leakage; null if the difference is not decisive.
    leakage_model_preferred: Option<LeakageModel>,
    /// Lap of the edges over full travel, negative for an underlap; null if the identified valve
    /// has none.
    lap: Option<ValveLapAnswer>,
    /// Saturation c of the opening u/(1 + c u) beyond the lap; null if the opening of the
    /// identified valve is in proportion to u.
    saturation: Option<ValveEstimateAnswer>,
    /// Shape lambda of the leakage of each edge; null if one shape applies to all.
    leakage_shapes: Option<ValveEdgesAnswer>,
    /// Evidence for each term that a valve may have in addition.
    terms: Vec<ValveTermAnswer>,
    /// Extent of the bootstrap; null if none was requested.
    bootstrap: Option<BootstrapAnswer>,
    /// Coefficients at which the search began.
    first_guess: CoefficientValuesAnswer,
    /// Sum of the losses of all residuals over their scales, which the search minimised.
    cost: f64,
    /// Root mean square of all residuals, each over the range of its signal.
    residual_rms: f64,
    /// Fit of each recorded signal.
    signals: Vec<ValveSignalAnswer>,
    /// Signals that the identified valve does not explain, the greatest misfit first.
    misfits: Vec<ValveMisfitAnswer>,
    /// Pairs of estimates that are correlated by more than 0.9, the closest first.
    correlations: Vec<CorrelationAnswer>,
    /// Combinations of coefficients that the recordings do not determine, the least known first.
    not_identifiable: Vec<NotIdentifiableAnswer>,
    /// Family of valves that the recordings allow; null without the project of a rig.
    joint_region: Option<JointRegionAnswer>,
    /// Values that are read from the curves by the equations of the thesis, section 5.2.
    simple_calculations: GraphReadingsAnswer,
    /// Number of starting points of the search, the first guess included.
    starts: usize,
    /// Number of starting points that lead to the best minimum.
    starts_that_agree: usize,
    /// True if no further step of the search explains more.
    converged: bool,
    /// Coefficients that ended at a bound of the search.
    at_bounds: Vec<&'static str>,
}

/// Temperature of the oil during the tests, and its effect.
#[derive(Answer)]
struct TestOilAnswer {
    /// Temperature for which the coefficients are stated.
    stated_at_degc: f64,
    /// Lowest and highest temperature of all recordings.
    #[answer(interval)]
    recorded_degc: [f64; 2],
    /// Relative decrease of the dynamic viscosity per degree.
    viscosity_slope_per_degc: f64,
    /// Relative decrease of the density per degree.
    density_slope_per_degc: f64,
}

/// The JSON object of `identify`, with or without a project.
pub fn json(
    loaded: Option<&Loaded>,
    found: &Identification,
    read: &Read,
    region: Option<&FoundRegion>,
) -> String {
    let motion = loaded.map_or(MotionKind::Linear, |loaded| loaded.project.motion());
    answer(loaded, found, read, region).into_object().print(motion)
}

fn answer(
    loaded: Option<&Loaded>,
    found: &Identification,
    read: &Read,
    region: Option<&FoundRegion>,
) -> IdentifiedValveAnswer {
    let has = found.tested.terms;
    let ValveEstimates { flow, leakage, shape, tare_flow, null_bias, hysteresis, lap, saturation, shapes } =
        ValveEstimates::of(found);
    IdentifiedValveAnswer {
        schema: SCHEMA,
        version: VERSION,
        command: "identify",
        project_sha256: loaded.map(|loaded| loaded.sha256.clone()),
        tests: read.tests(found),
        warnings: read.warnings(found),
        flow_coefficients: flow,
        leakage_coefficients: leakage,
        leakage_shape: shape,
        tare_flow_m3_per_s: tare_flow,
        tare_pressure_pa: found.tested.tare_reference_drop,
        oil_temperature: found.oil.as_ref().map(oil),
        null_bias_v: null_bias,
        hysteresis_v: hysteresis,
        leakage_model: found.tested.leakage_model,
        leakage_models: evidence::leakage_models(found),
        leakage_models_difference: found.evidence.difference(),
        leakage_model_preferred: found.evidence.preferred(),
        lap: has.lap.then_some(lap),
        saturation: has.saturation.then_some(saturation),
        leakage_shapes: has.leakage_by_edge.then_some(shapes),
        terms: found.terms.iter().map(evidence::term).collect(),
        bootstrap: found.bootstrap.as_ref().map(estimates::bootstrap),
        first_guess: evidence::values_by_name(found, &found.first_guess),
        cost: found.cost,
        residual_rms: found.residual_rms,
        signals: residuals::signals(found),
        misfits: residuals::misfits(found),
        correlations: residuals::correlation_answers(found),
        not_identifiable: found.not_identifiable.iter().map(residuals::not_identifiable).collect(),
        joint_region: region.map(joint_region_answer),
        simple_calculations: graph_readings(found),
        starts: found.starts[0],
        starts_that_agree: found.starts[1],
        converged: found.has_converged(),
        at_bounds: found.at_bounds.clone(),
    }
}

fn oil(oil: &TestOil) -> TestOilAnswer {
    TestOilAnswer {
        stated_at_degc: oil.reference,
        recorded_degc: oil.range,
        viscosity_slope_per_degc: oil.law.viscosity_slope,
        density_slope_per_degc: oil.law.density_slope,
    }
}
