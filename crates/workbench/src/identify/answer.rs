use serde::Serialize;

use super::files::{TestBody, WarningBody};
use super::{COEFFICIENT_NAMES, Identification, Read, SimpleCalculations, Untold};
use crate::answer::{self, Number, OutputFile};
use crate::project::Loaded;
use crate::quantity::print_bare;

#[derive(Serialize)]
struct Body<'a> {
    schema: u32,
    version: &'static str,
    command: &'static str,
    project_sha256: Option<&'a str>,
    tests: Vec<TestBody<'a>>,
    warnings: Vec<WarningBody<'a>>,
    flow_coefficients: EdgesBody,
    leakage_coefficients: EdgesBody,
    leakage_shape: Estimate,
    tare_flow_m3_per_s: Estimate,
    tare_pressure_pa: f64,
    null_bias_v: Estimate,
    hysteresis_v: Estimate,
    residual_rms: Number,
    signals: Vec<SignalBody>,
    correlations: Vec<CorrelationBody>,
    not_told: Vec<UntoldBody>,
    simple_calculations: SimpleBody,
    starts: usize,
    starts_that_agree: usize,
    converged: bool,
    at_bounds: &'a [&'static str],
}

#[derive(Serialize)]
struct EdgesBody {
    supply_to_a: Estimate,
    a_to_tank: Estimate,
    supply_to_b: Estimate,
    b_to_tank: Estimate,
}

#[derive(Clone, Serialize)]
struct Estimate {
    value: f64,
    confidence_95: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
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
struct CorrelationBody {
    coefficients: [&'static str; 2],
    correlation: Number,
}

#[derive(Serialize)]
struct UntoldBody {
    coefficients: Vec<&'static str>,
    shares: Vec<f64>,
    standard_deviation: Number,
    told_by: Vec<&'static str>,
}

#[derive(Serialize)]
struct SimpleBody {
    flow_coefficient_extending: Option<f64>,
    flow_coefficient_retracting: Option<f64>,
    leakage_coefficient: Option<f64>,
    leakage_shape: Option<f64>,
    tare_flow_m3_per_s: Option<f64>,
    null_bias_v: Option<f64>,
    hysteresis_v: Option<f64>,
}

/// Correlations below this magnitude are not listed.
const REMARKABLE: f64 = 0.9;

/// The JSON object of `identify`, beside a project or not.
pub fn json(loaded: Option<&Loaded>, found: &Identification, read: &Read) -> String {
    let numbers = found.coefficients.to_array();
    let mut estimates = numbers.into_iter().zip(found.intervals).map(|(value, confidence_95)| Estimate {
        value,
        confidence_95,
        reason: confidence_95.is_none().then_some("the data do not tell it"),
    });
    let mut next =
        || estimates.next().unwrap_or(Estimate { value: f64::NAN, confidence_95: None, reason: None });
    let mut edges =
        || EdgesBody { supply_to_a: next(), a_to_tank: next(), supply_to_b: next(), b_to_tank: next() };
    let (flow_coefficients, leakage_coefficients) = (edges(), edges());
    let body = Body {
        schema: answer::SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        command: "identify",
        project_sha256: loaded.map(|loaded| loaded.sha256.as_str()),
        tests: read.tests(found),
        warnings: read.warnings(),
        flow_coefficients,
        leakage_coefficients,
        leakage_shape: next(),
        tare_flow_m3_per_s: next(),
        tare_pressure_pa: found.tested.tare_reference_drop,
        null_bias_v: next(),
        hysteresis_v: next(),
        residual_rms: Number(found.residual_rms),
        signals: signals(found),
        correlations: correlations(found)
            .into_iter()
            .map(|(coefficients, correlation)| CorrelationBody {
                coefficients,
                correlation: Number(correlation),
            })
            .collect(),
        not_told: found.untold.iter().map(untold).collect(),
        simple_calculations: simple(&found.simple),
        starts: found.starts[0],
        starts_that_agree: found.starts[1],
        converged: found.has_converged(),
        at_bounds: &found.at_bounds,
    };
    // every number that may not exist is one of `Number` or `Option`
    serde_json::to_string_pretty(&body).unwrap_or_default()
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

/// Pairs of coefficients that move together, the closest first.
pub(super) fn correlations(found: &Identification) -> Vec<([&'static str; 2], f64)> {
    let names = || COEFFICIENT_NAMES.iter().map(|(name, _)| *name).enumerate();
    let pairs = names().flat_map(|(i, first)| {
        names().filter(move |(j, _)| *j > i).map(move |(j, second)| (i, j, [first, second]))
    });
    let mut listed: Vec<([&'static str; 2], f64)> = pairs
        .filter_map(|(i, j, both)| {
            let correlation = *found.correlations.get(i * COEFFICIENT_NAMES.len() + j)?;
            let told = found.intervals.get(i)?.is_some() && found.intervals.get(j)?.is_some();
            (told && correlation.abs() > REMARKABLE).then_some((both, correlation))
        })
        .collect();
    listed.sort_by(|(_, first), (_, second)| second.abs().total_cmp(&first.abs()));
    listed
}

fn untold(untold: &Untold) -> UntoldBody {
    UntoldBody {
        coefficients: untold.shares.iter().map(|(name, _)| *name).collect(),
        shares: untold.shares.iter().map(|(_, share)| *share).collect(),
        standard_deviation: Number(untold.deviation),
        told_by: untold.told_by.iter().map(|test| test.name()).collect(),
    }
}

fn simple(found: &SimpleCalculations) -> SimpleBody {
    let [extending, retracting] = found.flow_coefficients;
    SimpleBody {
        flow_coefficient_extending: extending,
        flow_coefficient_retracting: retracting,
        leakage_coefficient: found.leakage_coefficient,
        leakage_shape: found.leakage_shape,
        tare_flow_m3_per_s: found.tare_flow,
        null_bias_v: found.null_bias(),
        hysteresis_v: found.hysteresis(),
    }
}

/// The table `[valve]` of a project with what was identified: what the data do not tell is a comment.
pub fn files(found: &Identification) -> Vec<OutputFile> {
    let numbers = found.coefficients.to_array();
    let line = |index: usize| {
        let (name, unit) = COEFFICIENT_NAMES.get(index).copied().unwrap_or_default();
        let value = numbers.get(index).copied().unwrap_or(f64::NAN);
        let key = name.rsplit('.').next().unwrap_or(name);
        let text = match unit {
            "1" | "m3/(s.Pa^0.5)" => in_toml(value, 5),
            unit => format!("\"{} {unit}\"", in_toml(value, 5)),
        };
        match found.intervals.get(index).copied().flatten() {
            Some([low, high]) => {
                let ends = [low, high].map(|end| in_toml(end, 4));
                format!("{key} = {text}    # 95 %: {} to {}\n", ends[0], ends[1])
            }
            None => format!("# {key}: the data do not tell it\n"),
        }
    };
    let lines = |range: std::ops::Range<usize>| range.map(line).collect::<String>();
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let text = format!(
        "# Identified by phea from {}.\n[valve]\nnominal_voltage = \"{} V\"\ntransition_pressure = \"{} Pa\"\ntare_pressure = \"{} Pa\"\n{}\n[valve.flow_coefficients]    # m3/(s.Pa^0.5)\n{}\n[valve.leakage_coefficients]\n{}",
        files.join(", "),
        in_toml(found.tested.nominal_voltage, 6),
        in_toml(found.tested.transition_pressure, 6),
        in_toml(found.tested.tare_reference_drop, 6),
        lines(8..12),
        lines(0..4),
        lines(4..8),
    );
    vec![OutputFile { name: "valve.toml".to_string(), bytes: text.into_bytes() }]
}

/// A number with this many significant digits as TOML writes it.
fn in_toml(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    print_bare(rounded)
}
