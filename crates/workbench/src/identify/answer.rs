use std::collections::BTreeMap;

use phea_dynamics::order::sort_by_number;
use phea_hydraulics::servovalve::{LeakageModel, StaticCoefficients};
use serde::Serialize;

use super::files::{TestBody, WarningBody};
use super::misfit::declared_misfit;
use super::numbers;
use super::region::{FoundRegion, RegionBody, body};
use super::{
    Bootstrap, COEFFICIENT_NAMES, ExplainedBy, Identification, Misfit, MisfitPlace,
    NotIdentifiableCombination, Read, TermEvidence, TestOil,
};
use crate::answer::{self, Number, OutputFile, in_toml};
use crate::project::{LEAKAGE_MODELS, Loaded, word_of};

#[derive(Serialize)]
struct IdentifyAnswer<'a> {
    schema: u32,
    version: &'static str,
    command: &'static str,
    project_sha256: Option<&'a str>,
    tests: Vec<TestBody<'a>>,
    warnings: Vec<WarningBody<'a>>,
    flow_coefficients: EdgesBody,
    leakage_coefficients: EdgesBody,
    leakage_shape: EstimateBody,
    tare_flow_m3_per_s: EstimateBody,
    tare_pressure_pa: f64,
    oil_temperature: Option<OilBody>,
    null_bias_v: EstimateBody,
    hysteresis_v: EstimateBody,
    leakage_model: &'static str,
    leakage_models: Vec<ModelBody>,
    leakage_models_difference: Number,
    leakage_model_preferred: Option<&'static str>,
    lap: Option<LapBody>,
    saturation: Option<EstimateBody>,
    leakage_shapes: Option<EdgesBody>,
    terms: Vec<TermBody>,
    bootstrap: Option<BootstrapBody>,
    first_guess: BTreeMap<&'static str, f64>,
    cost: Number,
    residual_rms: Number,
    signals: Vec<SignalBody>,
    misfits: Vec<MisfitBody>,
    correlations: Vec<CorrelationBody>,
    not_identifiable: Vec<NotIdentifiableBody>,
    joint_region: Option<RegionBody>,
    simple_calculations: numbers::SimpleBody,
    starts: usize,
    starts_that_agree: usize,
    converged: bool,
    at_bounds: &'a [&'static str],
}

/// The oil of the tests: degC, 1/degC.
#[derive(Serialize)]
struct OilBody {
    stated_at_degc: Number,
    recorded_degc: [Number; 2],
    viscosity_slope_per_degc: f64,
    density_slope_per_degc: f64,
}

/// Evidence for a term of the valve.
#[derive(Serialize)]
struct TermBody {
    term: &'static str,
    criterion_gain: Number,
    taken: bool,
}

#[derive(Serialize)]
struct LapBody {
    positive: EstimateBody,
    negative: EstimateBody,
}

#[derive(Serialize)]
struct EdgesBody {
    supply_to_a: EstimateBody,
    a_to_tank: EstimateBody,
    supply_to_b: EstimateBody,
    b_to_tank: EstimateBody,
}

#[derive(Clone, Serialize)]
struct EstimateBody {
    value: f64,
    confidence_95: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bootstrap_95: Option<[Number; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
}

#[derive(Serialize)]
struct ModelBody {
    model: &'static str,
    criterion: Number,
    residual_rms: Number,
    coefficients: BTreeMap<&'static str, f64>,
}

#[derive(Serialize)]
struct BootstrapBody {
    repetitions: usize,
    failed: usize,
    block_rows: usize,
}

#[derive(Serialize)]
struct SignalBody {
    file: String,
    signal: &'static str,
    unit: &'static str,
    rows: usize,
    rms: Number,
    scale: Number,
    range: Number,
    neighbour_correlation: Number,
}

#[derive(Serialize)]
struct MisfitBody {
    file: String,
    signal: &'static str,
    share: Number,
    neighbour_correlation: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    greatest: Option<MisfitPlaceBody>,
}

#[derive(Serialize)]
struct MisfitPlaceBody {
    command_rises: bool,
    command_v: [Number; 2],
    mean_share: Number,
}

#[derive(Serialize)]
struct CorrelationBody {
    coefficients: [&'static str; 2],
    correlation: Number,
}

#[derive(Serialize)]
struct NotIdentifiableBody {
    coefficients: Vec<&'static str>,
    shares: Vec<f64>,
    standard_deviation: Number,
    identifiable_by: Vec<&'static str>,
}

/// The coefficient that a project leaves out where it may be zero.
const HYSTERESIS: &str = "hysteresis";

/// The coefficients of which zero is a value like any other.
pub(super) const EITHER_SIGN: [&str; 3] = ["null_bias", "lap.positive", "lap.negative"];

/// Correlations below this magnitude are not listed.
const REMARKABLE: f64 = 0.9;

/// The JSON object of `identify`, with or without a project.
pub fn json(
    loaded: Option<&Loaded>,
    found: &Identification,
    read: &Read,
    region: Option<&FoundRegion>,
) -> String {
    let has = found.tested.terms;
    let EstimatesOfValve { flow, leakage, tare_flow, null_bias, hysteresis, lap, saturation, shapes } =
        estimates(found);
    let body = IdentifyAnswer {
        schema: answer::SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        command: "identify",
        project_sha256: loaded.map(|loaded| loaded.sha256.as_str()),
        tests: read.tests(found),
        warnings: read.warnings(found),
        flow_coefficients: flow,
        leakage_coefficients: leakage,
        leakage_shape: shapes.supply_to_a.clone(),
        tare_flow_m3_per_s: tare_flow,
        tare_pressure_pa: found.tested.tare_reference_drop,
        oil_temperature: found.oil.as_ref().map(oil_body),
        null_bias_v: null_bias,
        hysteresis_v: hysteresis,
        leakage_model: word(found.tested.leakage_model),
        leakage_models: found.evidence.models.iter().map(|one| model(found, one)).collect(),
        leakage_models_difference: Number(found.evidence.difference()),
        leakage_model_preferred: found.evidence.preferred().map(word),
        lap: has.lap.then_some(lap),
        saturation: has.saturation.then_some(saturation),
        leakage_shapes: has.leakage_by_edge.then_some(shapes),
        terms: found.terms.iter().map(term).collect(),
        bootstrap: found.bootstrap.as_ref().map(bootstrap_body),
        first_guess: by_name(found, &found.first_guess),
        cost: Number(found.cost),
        residual_rms: Number(found.residual_rms),
        signals: signals(found),
        misfits: found.misfits().iter().map(|misfit| misfit_body(found, misfit)).collect(),
        correlations: correlations(found)
            .into_iter()
            .map(|(coefficients, correlation)| CorrelationBody {
                coefficients,
                correlation: Number(correlation),
            })
            .collect(),
        not_identifiable: found.not_identifiable.iter().map(not_identifiable).collect(),
        joint_region: region.map(body),
        simple_calculations: numbers::simple_body(found),
        starts: found.starts[0],
        starts_that_agree: found.starts[1],
        converged: found.has_converged(),
        at_bounds: &found.at_bounds,
    };
    // every number that may not exist is one of `Number` or `Option`
    serde_json::to_string_pretty(&body).unwrap_or_default()
}

/// The coefficients with their intervals, those too that the model of the numbers has not.
struct EstimatesOfValve {
    flow: EdgesBody,
    leakage: EdgesBody,
    tare_flow: EstimateBody,
    null_bias: EstimateBody,
    hysteresis: EstimateBody,
    lap: LapBody,
    saturation: EstimateBody,
    shapes: EdgesBody,
}

fn estimates(found: &Identification) -> EstimatesOfValve {
    let numbers = found.coefficients.to_array();
    let bootstrap = |index: usize| found.bootstrap.as_ref()?.intervals.get(index).copied();
    let all = numbers.into_iter().zip(found.estimates).enumerate();
    let mut estimates = all.map(|(index, (value, estimate))| EstimateBody {
        value,
        confidence_95: estimate.map(|estimate| estimate.interval),
        bootstrap_95: estimate.and(bootstrap(index)).map(|ends| ends.map(Number)),
        reason: estimate.is_none().then_some("the data do not determine it"),
    });
    let mut next = || {
        let none = EstimateBody { value: f64::NAN, confidence_95: None, bootstrap_95: None, reason: None };
        estimates.next().unwrap_or(none)
    };
    let mut edges =
        || EdgesBody { supply_to_a: next(), a_to_tank: next(), supply_to_b: next(), b_to_tank: next() };
    let (flow, leakage) = (edges(), edges());
    let [supply_to_a, tare_flow, null_bias, hysteresis] = [next(), next(), next(), next()];
    let lap = LapBody { positive: next(), negative: next() };
    let saturation = next();
    let shapes = EdgesBody { supply_to_a, a_to_tank: next(), supply_to_b: next(), b_to_tank: next() };
    EstimatesOfValve { flow, leakage, tare_flow, null_bias, hysteresis, lap, saturation, shapes }
}

/// The name of a model in the project file.
pub(super) fn word(model: LeakageModel) -> &'static str {
    word_of(&LEAKAGE_MODELS, &model)
}

fn term(evidence: &TermEvidence) -> TermBody {
    let TermEvidence { term, gain, taken } = *evidence;
    TermBody { term: term.name(), criterion_gain: Number(gain), taken }
}

fn model(found: &Identification, explained: &ExplainedBy) -> ModelBody {
    ModelBody {
        model: word(explained.model),
        criterion: Number(explained.criterion),
        residual_rms: Number(explained.residual_rms),
        coefficients: by_name(found, &explained.coefficients),
    }
}

/// The coefficients of the model of the numbers.
fn by_name(found: &Identification, coefficients: &StaticCoefficients) -> BTreeMap<&'static str, f64> {
    let all = coefficients.to_array();
    let one = |index: usize| Some((COEFFICIENT_NAMES.get(index)?.0, *all.get(index)?));
    found.in_model().filter_map(one).collect()
}

fn bootstrap_body(found: &Bootstrap) -> BootstrapBody {
    BootstrapBody { repetitions: found.repetitions, failed: found.failed, block_rows: found.block_rows }
}

fn signals(found: &Identification) -> Vec<SignalBody> {
    let one = |signal: &super::SignalFit| SignalBody {
        file: found.recordings.get(signal.recording).map_or(String::new(), |one| one.file.clone()),
        signal: signal.kind.name(),
        unit: if signal.kind.is_pressure() { "Pa" } else { "m3/s" },
        rows: signal.rows,
        rms: Number(signal.rms),
        scale: Number(signal.scale),
        range: Number(signal.range),
        neighbour_correlation: Number(signal.correlation),
    };
    found.signals.iter().map(one).collect()
}

fn oil_body(oil: &TestOil) -> OilBody {
    OilBody {
        stated_at_degc: Number(oil.reference),
        recorded_degc: oil.range.map(Number),
        viscosity_slope_per_degc: oil.law.viscosity_slope,
        density_slope_per_degc: oil.law.density_slope,
    }
}

fn misfit_body(found: &Identification, misfit: &Misfit) -> MisfitBody {
    let place = |place: MisfitPlace| MisfitPlaceBody {
        command_rises: place.is_rising,
        command_v: place.command.map(Number),
        mean_share: Number(place.fraction),
    };
    MisfitBody {
        file: found.recordings.get(misfit.recording).map_or(String::new(), |one| one.file.clone()),
        signal: misfit.kind.name(),
        share: Number(misfit.fraction),
        neighbour_correlation: Number(misfit.correlation),
        greatest: misfit.place.map(place),
    }
}

/// Pairs of coefficients that move together, the closest first.
pub(super) fn correlations(found: &Identification) -> Vec<([&'static str; 2], f64)> {
    let names = || COEFFICIENT_NAMES.iter().map(|(name, _)| *name).enumerate();
    let pairs = names().flat_map(|(i, first)| {
        names().filter(move |(j, _)| *j > i).map(move |(j, second)| (i, j, [first, second]))
    });
    let mut listed: Vec<([&'static str; 2], f64)> = pairs
        .filter_map(|(i, j, both)| {
            let correlation = *found.correlations.get(i * COEFFICIENT_NAMES.len() + j)?;
            let are_identified = found.estimates.get(i)?.is_some() && found.estimates.get(j)?.is_some();
            (are_identified && correlation.abs() > REMARKABLE).then_some((both, correlation))
        })
        .collect();
    sort_by_number(&mut listed, |(_, correlation)| -correlation.abs());
    listed
}

fn not_identifiable(found: &NotIdentifiableCombination) -> NotIdentifiableBody {
    NotIdentifiableBody {
        coefficients: found.components.iter().map(|(name, _)| *name).collect(),
        shares: found.components.iter().map(|(_, component)| *component).collect(),
        standard_deviation: Number(found.deviation),
        identifiable_by: found.identifiable_by.iter().map(|test| test.name()).collect(),
    }
}

/// The table `[valve]` of a project with what was identified: what the data do not determine is a
/// comment.
pub fn files(found: &Identification) -> Vec<OutputFile> {
    let numbers = found.coefficients.to_array();
    let line = |index: usize| {
        let (name, unit) = COEFFICIENT_NAMES.get(index).copied().unwrap_or_default();
        let value = numbers.get(index).copied().unwrap_or(f64::NAN);
        let key = match name {
            "leakage_shape" if found.tested.terms.leakage_by_edge => "supply_to_a",
            name => name.rsplit('.').next().unwrap_or(name),
        };
        let text = match unit {
            "1" | "m3/(s.Pa^0.5)" => in_toml(value, 5),
            unit => format!("\"{} {unit}\"", in_toml(value, 5)),
        };
        match found.estimates.get(index).copied().flatten().map(|estimate| estimate.interval) {
            Some([low, high]) if low == 0.0 && name == HYSTERESIS => {
                format!("# {key}: at most {} V\n", in_toml(high, 4))
            }
            Some([low, high]) if low == 0.0 && !EITHER_SIGN.contains(&name) => {
                format!("{key} = {text}    # 95 %: at most {}\n", in_toml(high, 4))
            }
            Some([low, high]) => {
                let ends = [low, high].map(|end| in_toml(end, 4));
                format!("{key} = {text}    # 95 %: {} to {}\n", ends[0], ends[1])
            }
            None => format!("# {key}: the data do not determine it\n"),
        }
    };
    let lines = |range: std::ops::Range<usize>| range.map(line).collect::<String>();
    let has = found.tested.terms;
    let whole = [
        if has.leakage_by_edge { lines(9..12) } else { lines(8..12) },
        if has.saturation { line(14) } else { String::new() },
    ];
    let mut more = String::new();
    if has.lap {
        more.push_str(&format!("\n[valve.lap]    # over full travel\n{}", lines(12..14)));
    }
    if has.leakage_by_edge {
        let shapes = line(8) + &lines(15..18);
        more.push_str(&format!("\n[valve.leakage_shapes]\n{shapes}"));
    }
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let misfit = declared_misfit(found).map(|one| format!("misfit = {}\n", one.in_toml()));
    let misfit = misfit.unwrap_or_default();
    let text = format!(
        "# Identified by phea from {}.\n[valve]\nnominal_voltage = \"{} V\"\ntransition_pressure = \"{} Pa\"\ntare_pressure = \"{} Pa\"\nleakage_model = \"{}\"\n{}{misfit}\n[valve.flow_coefficients]    # m3/(s.Pa^0.5)\n{}\n[valve.leakage_coefficients]\n{}{more}",
        files.join(", "),
        in_toml(found.tested.nominal_voltage, 6),
        in_toml(found.tested.transition_pressure, 6),
        in_toml(found.tested.tare_reference_drop, 6),
        word(found.tested.leakage_model),
        whole.concat(),
        lines(0..4),
        lines(4..8),
    );
    vec![OutputFile { name: "valve.toml".to_string(), bytes: text.into_bytes() }]
}
