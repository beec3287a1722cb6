//! The numbers of section 5.2 of the thesis, each from the recordings by its equation.

use std::collections::BTreeMap;

use phea_engineering::estimate::Estimate;
use phea_engineering::identify::{COEFFICIENT_NAMES, Identification, NullMethod, NullReading};

use crate::answer::{Answer, KeyList, Keyed, ObjectKey, significant, words};
use crate::document::{Cell, Document, Table};
use crate::project::DeclaredActuator;
use crate::quantity::{DisplayUnit, PRESSURE, VOLTAGE, display};

/// Values read from the recorded curves by the equations of the thesis, section 5.2; null without
/// the test for it.
#[derive(Answer)]
pub(super) struct GraphReadingsAnswer {
    /// Flow coefficient K_vp for positive commands, which extend, m3/(s.Pa^0.5).
    flow_coefficient_extending: Option<f64>,
    /// Flow coefficient K_vp for negative commands, which retract, m3/(s.Pa^0.5).
    flow_coefficient_retracting: Option<f64>,
    /// Flow of the valve over the rated flow, at the rated pressure drop.
    fraction_of_nominal_flow: Option<f64>,
    /// Leakage coefficient K_vinp, m3/(s.Pa^0.5).
    leakage_coefficient: Option<f64>,
    /// Leakage at null, above the tare flow.
    null_leakage_m3_per_s: Option<f64>,
    /// Shape lambda of the leakage, from the width of its curve at half height.
    leakage_shape: Option<f64>,
    /// Flow of the pilot stage, from the base of the leakage curve.
    tare_flow_m3_per_s: Option<f64>,
    /// Pressure drop from supply to tank at which leakage and tare flow are read.
    leakage_pressure_pa: Option<f64>,
    /// Tare flow over the whole leakage at null.
    tare_fraction: Option<f64>,
    /// Mean of the nulls with a rising and a falling command.
    null_bias_v: Option<f64>,
    /// Command at null while the command rises.
    null_rising_v: Option<f64>,
    /// Command at null while the command falls.
    null_falling_v: Option<f64>,
    /// Features that show null while the command rises and while it falls.
    null_methods: [Option<NullMethod>; 2],
    /// Null with a rising command less that with a falling one.
    hysteresis_v: Option<f64>,
    /// Flow gain K_qU near null for positive commands.
    flow_gain_extending_m3_per_s_v: Option<f64>,
    /// Flow gain K_qU near null for negative commands.
    flow_gain_retracting_m3_per_s_v: Option<f64>,
    /// Commands from null, to either side, between which the flow gains are read.
    flow_gain_commands_v: Option<[f64; 2]>,
    /// Pressure drop from supply to tank at which the flow gains are stated.
    flow_gain_pressure_pa: Option<f64>,
    /// Pressure sensitivity K_pU with blocked ports: slope of p_A - p_B over the command.
    pressure_sensitivity_pa_per_v: Option<f64>,
    /// Flow-pressure coefficient K_c at null, m3/(s.Pa); null also for edges with a lap, whose flow
    /// gain at null is not the one that is read.
    flow_pressure_coefficient: Option<f64>,
    /// Confidence intervals of 95 % of the values that have one.
    confidence_95: GraphIntervalsAnswer,
}

/// Confidence intervals of 95 % of values read from curves, each from low to high, in the order of
/// the alphabet.
#[derive(Answer)]
struct GraphIntervalsAnswer {
    #[answer(flatten, interval)]
    intervals: Keyed<GraphReadingKeys, [f64; 2]>,
}

/// Values that may have an interval.
struct GraphReadingKeys;

impl KeyList for GraphReadingKeys {
    fn keys() -> Vec<(ObjectKey, String)> {
        let keys = [
            "flow_coefficient_extending",
            "flow_coefficient_retracting",
            "flow_gain_extending_m3_per_s_v",
            "flow_gain_retracting_m3_per_s_v",
            "flow_pressure_coefficient",
            "hysteresis_v",
            "leakage_coefficient",
            "null_bias_v",
            "null_falling_v",
            "null_leakage_m3_per_s",
            "null_rising_v",
            "pressure_sensitivity_pa_per_v",
            "fraction_of_nominal_flow",
            "tare_flow_m3_per_s",
            "tare_fraction",
        ];
        keys.map(|key| (key.into(), format!("Confidence interval of `{key}`."))).to_vec()
    }
}

words! {
    /// Feature of the recorded curves that shows null.
    NullMethod {
        LeakageCentre => "leakage_centre",
        FlowLines => "flow_lines",
        EqualPressures => "equal_pressures",
    }
}

pub(super) fn graph_readings(identified: &Identification) -> GraphReadingsAnswer {
    let found = &identified.simple;
    let mut intervals = BTreeMap::new();
    let mut read = |name: &'static str, reading: Option<Estimate>| {
        intervals.extend(reading.and_then(|reading| Some((name, reading.bounds()?))));
        reading.map(|reading| reading.value)
    };
    let [extending, retracting] = found.flow_coefficients;
    let [gain_extending, gain_retracting] = found.flow_gains;
    let [rising, falling] = found.nulls;
    GraphReadingsAnswer {
        flow_coefficient_extending: read("flow_coefficient_extending", extending),
        flow_coefficient_retracting: read("flow_coefficient_retracting", retracting),
        fraction_of_nominal_flow: read("fraction_of_nominal_flow", found.fraction_of_nominal),
        leakage_coefficient: read("leakage_coefficient", found.leakage_coefficient()),
        null_leakage_m3_per_s: read("null_leakage_m3_per_s", found.null_leakage),
        leakage_shape: found.leakage_shape,
        tare_flow_m3_per_s: read("tare_flow_m3_per_s", found.tare_flow),
        leakage_pressure_pa: found.leakage_pressure,
        tare_fraction: read("tare_fraction", found.tare_fraction()),
        null_bias_v: read("null_bias_v", found.null_bias()),
        null_rising_v: read("null_rising_v", rising.map(|null| null.command)),
        null_falling_v: read("null_falling_v", falling.map(|null| null.command)),
        null_methods: found.nulls.map(|null| null.map(|null| null.method)),
        hysteresis_v: read("hysteresis_v", found.hysteresis()),
        flow_gain_extending_m3_per_s_v: read("flow_gain_extending_m3_per_s_v", gain_extending),
        flow_gain_retracting_m3_per_s_v: read("flow_gain_retracting_m3_per_s_v", gain_retracting),
        flow_gain_commands_v: found.flow_gain_commands,
        flow_gain_pressure_pa: found.flow_gain_commands.map(|_| found.flow_gain_pressure),
        pressure_sensitivity_pa_per_v: read("pressure_sensitivity_pa_per_v", found.pressure_sensitivity),
        flow_pressure_coefficient: read("flow_pressure_coefficient", coefficient_at_null(identified)),
        confidence_95: GraphIntervalsAnswer {
            intervals: Keyed::new(intervals.into_iter().map(|(name, ends)| (name.into(), ends))),
        },
    }
}

/// K_c at null, if the flow gain that is read is also that at null: for edges without lap.
fn coefficient_at_null(found: &Identification) -> Option<Estimate> {
    found.simple.flow_pressure_coefficient().filter(|_| !found.tested.terms.lap)
}

/// A line of the table: the name of the number, its equation, its unit, and the value that the
/// thesis prints for its valve.
struct NumberLine {
    name: &'static str,
    equation: &'static str,
    unit: DisplayUnit,
    thesis: Option<&'static str>,
}

/// True if the actuator has the valve for which the thesis prints numbers.
pub(crate) fn is_valve_of_thesis(actuator: &DeclaredActuator) -> bool {
    actuator.valve.model.as_ref().is_some_and(|model| model.starts_with(VALVE_OF_THESIS))
}

const VALVE_OF_THESIS: &str = "moog_760_c263a";

/// The numbers with their equations, and next to them those printed in the thesis if the valve is
/// the one of its rig.
pub(crate) fn write(found: &Identification, of_thesis: bool, out: &mut Document) {
    let mut headings = vec!["number", "read", "95 % from", "to", "unit", "by"];
    headings.extend(of_thesis.then_some("Ledezma (2019)"));
    let rows = lines(found).into_iter().filter_map(|(line, reading)| {
        let reading = reading?;
        let number = |value: f64| Cell::number_in(value, 4, line.unit);
        let ends = reading.bounds().map(|ends| ends.map(number));
        let [low, high] = ends.unwrap_or([Cell::Missing, Cell::Missing]);
        let mut cells = vec![
            Cell::from(line.name),
            number(reading.value),
            low,
            high,
            Cell::unit(line.unit.symbol),
            Cell::Equation(line.equation.to_string()),
        ];
        cells.extend(of_thesis.then(|| line.thesis.map(|number| Cell::Code(number.to_string())).into()));
        Some(cells)
    });
    let table = Table::new(headings).with(rows);
    if table.is_empty() {
        return;
    }
    out.section(if of_thesis { "Numbers of section 5.2" } else { "Numbers read by hand" }, table);
    out.sentences(of_thesis.then(|| "The last column is what the thesis prints of the valve of its rig, a Moog 760 C263-A at 70 bar. Equation 4.12 is corrected: each of two edges takes half the drop. The peak that it states as 1.67 % is of the measured 88 % of the rated flow. The data sheet of that valve allows a tare flow of 42.6 to 65.0 % of the leakage at null.".to_string()));
    out.sentences(read_at(found));
    out.sentences(null_offset(found));
}

/// Pressures and commands at which the numbers were read.
fn read_at(found: &Identification) -> Vec<String> {
    let simple = &found.simple;
    let bar = |pressure: f64| display(pressure, &PRESSURE, 3);
    let leakage = simple
        .leakage_pressure
        .map(|pressure| format!("Leakage and tare flow are read at {} from supply to tank.", bar(pressure)));
    let gain = simple.flow_gain_commands.map(|commands| {
        let [from, to] = commands.map(|command| display(command, &VOLTAGE, 3));
        let drop = bar(simple.flow_gain_pressure);
        format!("The flow gain is read between {from} and {to} from null, and stated at {drop} from supply to tank without load.")
    });
    let lap = (found.tested.terms.lap && simple.flow_gain_commands.is_some()).then(|| {
        "The edges have a lap: at null the flow gain is another than beyond it, so that K_c at null does not follow from these numbers; the \
         coefficients above give both."
            .to_string()
    });
    leakage.into_iter().chain(gain).chain(lap).collect()
}

/// By which a null was found.
fn null_equation(null: Option<NullReading>) -> &'static str {
    match null.map(|null| null.method) {
        Some(NullMethod::FlowLines) => "between zeros of q(U)",
        Some(NullMethod::EqualPressures) => "p_A = p_B",
        Some(NullMethod::LeakageCentre) | None => "centre of q_leak(U)",
    }
}

/// Distance of the null that was read from the identified one, if it exceeds its interval, in a
/// sentence with the reason.
fn null_offset(found: &Identification) -> Option<String> {
    let read = found.simple.null_bias()?;
    let null_bias = COEFFICIENT_NAMES.iter().position(|(name, _)| *name == "null_bias")?;
    found.estimates.get(null_bias)?.as_ref()?;
    let offset = read.value - found.coefficients.null_bias;
    let reason = match found.simple.nulls[0]?.method {
        NullMethod::LeakageCentre => "the leakage curve of unequal edges is not even about null",
        NullMethod::FlowLines => "where the straight lines begin the spool still remembers its last reversal",
        NullMethod::EqualPressures => "unequal edges balance the ports away from null",
    };
    let [low, high] = read.interval;
    (!(low..=high).contains(&found.coefficients.null_bias)).then(|| {
        format!(
            "Null as read lies {} mV {} the identified null bias: {reason}.",
            significant(1e3 * offset.abs(), 2),
            if offset > 0.0 { "above" } else { "below" },
        )
    })
}

/// Names of both flow gains and of the pressure sensitivity.
fn slopes(has_lap: bool) -> [&'static str; 3] {
    match has_lap {
        false => [
            "flow gain at null K_qU, positive command",
            "flow gain at null K_qU, negative command",
            "pressure sensitivity at null K_pU",
        ],
        true => [
            "flow gain beyond the lap K_qU, positive command",
            "flow gain beyond the lap K_qU, negative command",
            "pressure sensitivity where p_A = p_B, K_pU",
        ],
    }
}

fn lines(found: &Identification) -> Vec<(NumberLine, Option<Estimate>)> {
    const COEFFICIENT: &str = "m3/(s.Pa^0.5)";
    let simple = &found.simple;
    let line = |name, equation, symbol, thesis| {
        let unit = if symbol == "%" { DisplayUnit::PERCENT } else { DisplayUnit { symbol, in_si: 1.0 } };
        NumberLine { name, equation, unit, thesis }
    };
    let [extending, retracting] = simple.flow_coefficients;
    let [gain_extending, gain_retracting] = simple.flow_gains;
    let [rising, falling] = simple.nulls;
    let tare = line("tare flow q_tare", "base of q_leak(U)", "m3/s", Some("7.55e-6"));
    let leak = line("leakage at null q_vin", "peak of q_leak(U) - q_tare", "m3/s", Some("9.31e-6"));
    let fraction = line("tare flow in the leakage at null", "q_tare/(q_tare + q_vin)", "%", Some("44.77"));
    let inner =
        line("leakage coefficient K_vinp", "q_vin/sqrt(2 p_S)  (4.13)", COEFFICIENT, Some("2.488e-9"));
    let ext = line(
        "flow coefficient K_vp, positive command",
        "dq/du/sqrt(p_S/2)  (4.12)",
        COEFFICIENT,
        Some("2.97e-7"),
    );
    let ret = line("flow coefficient K_vp, negative command", "likewise", COEFFICIENT, Some("2.97e-7"));
    let rated = line("flow, share of the rated one", "K_vp sqrt(p_n/2)/q_n", "%", Some("88"));
    let width = line("hysteresis", "U_rising - U_falling", "V", Some("0.128"));
    let [positive, negative, equal] = slopes(found.tested.terms.lap);
    let gain = line(positive, "dq/dU", "m3/(s.V)", Some("5.4e-5"));
    let back = line(negative, "likewise", "m3/(s.V)", Some("5.4e-5"));
    let sensitivity = line(equal, "d(p_A - p_B)/dU", "Pa/V", None);
    let coefficient =
        line("flow-pressure coefficient at null K_c", "K_qU/K_pU", "m3/(s.Pa)", Some("6.42e-13"));
    vec![
        (tare, simple.tare_flow),
        (leak, simple.null_leakage),
        (fraction, simple.tare_fraction()),
        (inner, simple.leakage_coefficient()),
        (ext, extending),
        (ret, retracting),
        (rated, simple.fraction_of_nominal),
        (
            line("null, rising command", null_equation(rising), "V", Some("0.078")),
            rising.map(|null| null.command),
        ),
        (
            line("null, falling command", null_equation(falling), "V", Some("-0.05")),
            falling.map(|null| null.command),
        ),
        (width, simple.hysteresis()),
        (gain, gain_extending),
        (back, gain_retracting),
        (sensitivity, simple.pressure_sensitivity),
        (coefficient, coefficient_at_null(found)),
    ]
}
