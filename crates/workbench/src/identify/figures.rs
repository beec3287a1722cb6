//! The figures of chapter 5 of the thesis, from recordings and the valve that explains them.

use phea_hydraulics::servovalve::{PortCircuit, TestOutput};

use super::{Identification, Recording, SignalFit, SignalKind};
use crate::figure::{Curve, CurveChart, CurvePanel, CurveStyle, Figure, TestCircuit, TestPorts, Words};
use crate::quantity::{DisplayUnit, PRESSURE, display};

/// Range of commands around null over which the leakage is drawn, percent of the nominal voltage.
const AROUND_NULL: f64 = 6.0;
/// Range of commands around null over which the flow gain is drawn, percent of the nominal voltage.
const NEAR_NULL: f64 = 4.0;
/// Range of commands around null over which the pressure sensitivity is drawn, percent of the
/// nominal voltage.
const CLOSE_TO_NULL: f64 = 2.5;

const COMMAND: &str = "Command U_C (% of nominal)";
const WAYS: [(&str, bool); 2] = [("rising command", true), ("falling command", false)];

/// The figures, section by section.
pub(crate) struct ValveFigures {
    /// Circuits of the tests.
    pub(crate) circuits: Vec<Figure>,
    /// Recorded signals over time.
    pub(crate) series: Vec<Figure>,
    /// Readings of the curves.
    pub(crate) curves: Vec<Figure>,
    /// Tests against the model.
    pub(crate) comparison: Vec<Figure>,
    /// Residuals of the model.
    pub(crate) residuals: Vec<Figure>,
}

impl ValveFigures {
    pub(crate) fn of(found: &Identification) -> ValveFigures {
        let all = || found.recordings.iter().enumerate();
        let leaking = all().find(|(_, one)| one.signal(SignalKind::LeakFlow).is_some());
        let mut read = Vec::new();
        read.extend(leaking.map(|(_, one)| leakage(found, one)));
        read.extend(flow_gain(found));
        read.extend(pressure_sensitivity(found));
        let comparison = leaking.map(|(index, _)| WAYS.map(|way| against_model(found, index, way)));
        ValveFigures {
            circuits: circuits(found),
            series: all().map(|(index, one)| series(found, index, one)).collect(),
            curves: read,
            comparison: comparison.into_iter().flatten().collect(),
            residuals: vec![residuals(found)],
        }
    }

    pub(crate) fn all(self) -> Vec<Figure> {
        let ValveFigures { circuits, series, curves, comparison, residuals } = self;
        [circuits, series, curves, comparison, residuals].concat()
    }
}

fn circuits(found: &Identification) -> Vec<Figure> {
    let supply = display(found.usual_drop(), &PRESSURE, 3);
    let drawn = |circuit: PortCircuit| {
        let (ports, rows, [name, title, caption]) = match circuit {
            PortCircuit::Blocked => (
                TestPorts::Blocked,
                ["ports blocked", "recorded over U_C:", "leakage with tare flow,", "pressures at A and B"],
                [
                    "circuit_blocked",
                    "Test with blocked ports",
                    "Circuit of the tests with blocked ports, internal leakage and pressure gain (Ledezma 2019, Figure 5.3).",
                ],
            ),
            PortCircuit::Connected => (
                TestPorts::Joined,
                ["ports joined", "through the meter", "recorded over U_C:", "flow, pressures at A and B"],
                [
                    "circuit_joined",
                    "Metering test",
                    "Circuit of the metering test (Ledezma 2019, Figure 5.6).",
                ],
            ),
        };
        let rows = rows.map(str::to_string).to_vec();
        let chart = TestCircuit { ports, supply_rows: vec![supply.clone()], rows };
        chart.draw(&Words::new(name, title, caption))
    };
    let has = |circuit: &PortCircuit| found.recordings.iter().any(|one| one.circuit == *circuit);
    [PortCircuit::Blocked, PortCircuit::Connected].into_iter().filter(has).map(drawn).collect()
}

/// Name of the file without folder and ending.
fn stem(recording: &Recording) -> &str {
    let name = recording.file.rsplit(['/', '\\']).next().unwrap_or(&recording.file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn percent(found: &Identification, command: f64) -> f64 {
    100.0 * command / found.tested.nominal_voltage
}

/// p_A and p_B of a row in Pa; of joined ports from their mean and difference.
fn port_pressures(recording: &Recording, row: usize) -> Option<[f64; 2]> {
    let at = |kind| recording.signal(kind)?.values.get(row).copied()?;
    let mean: Option<f64> = at(SignalKind::MeanPressure);
    if let Some(mean) = mean {
        let half = recording.inputs.get(row)?.load_pressure / 2.0;
        return Some([mean + half, mean - half]);
    }
    Some([at(SignalKind::PressureA)?, at(SignalKind::PressureB)?])
}

/// The signal of a flow, and its name.
fn flow_signal(recording: &Recording) -> Option<(SignalKind, &'static str)> {
    let kinds = [
        (SignalKind::LeakFlow, "Leakage (L/min)"),
        (SignalKind::PortFlow, "Flow (L/min)"),
        (SignalKind::PortFlowMagnitude, "Flow (L/min)"),
    ];
    kinds.into_iter().find(|(kind, _)| recording.signal(*kind).is_some())
}

/// Temperature, command, flow and pressures over time.
fn series(found: &Identification, index: usize, recording: &Recording) -> Figure {
    let (bar, litre) = (DisplayUnit::BAR, DisplayUnit::LITRE_PER_MINUTE);
    let times = || recording.times.iter().copied();
    let mut panels = Vec::new();
    if let Some(temperature) = &recording.oil_temperature {
        let points = times().zip(temperature.iter().copied());
        panels.push(CurvePanel::new("Oil (°C)", 64.0, vec![Curve::line(points, 0)]));
    }
    let commands = recording.inputs.iter().map(|input| percent(found, input.command));
    panels.push(CurvePanel::new("U_C (%)", 78.0, vec![Curve::line(times().zip(commands), 0)]));
    if let Some((kind, title)) = flow_signal(recording) {
        let values = recording.signal(kind).map(|signal| signal.values.clone()).unwrap_or_default();
        let shown = values.iter().map(|value| litre.of(value.unwrap_or(0.0)));
        panels.push(CurvePanel::new(title, 100.0, vec![Curve::line(times().zip(shown), 0)]));
    }
    let supply = recording.inputs.iter().map(|input| bar.of(input.supply.pressure));
    let mut pressures = vec![Curve::line(times().zip(supply), 0)];
    for port in 0..2 {
        let of_row = |(row, time): (usize, f64)| {
            Some((time, bar.of(port_pressures(recording, row)?.get(port).copied()?)))
        };
        pressures.push(Curve::line(times().enumerate().filter_map(of_row), port + 1));
    }
    panels.push(CurvePanel::new("Pressure (bar)", 120.0, pressures));
    let ends = [recording.times.first(), recording.times.last()].map(|time| time.copied().unwrap_or(0.0));
    let legend = ["p_S", "p_A", "p_B"].into_iter().enumerate();
    let chart = CurveChart {
        x_title: "Time (s)".to_string(),
        x_range: ends,
        panels,
        legend: legend.map(|(series, name)| (name.to_string(), CurveStyle::Line(series))).collect(),
    };
    let name = stem(recording);
    let caption = format!(
        "What was recorded in {}, over time: command, flow and pressures (Ledezma 2019, Figures 5.4, 5.7 and 5.8).",
        recording.file
    );
    let title = format!("Recorded: {}", name.replace('_', " "));
    chart.draw(&Words::new(format!("series_{}_{name}", index + 1), title, caption))
}

/// Curve of each branch in one direction: the command in percent, and the value that `of` returns
/// for a row.
fn over_command(
    found: &Identification,
    recording: &Recording,
    rising: bool,
    of: impl Fn(usize) -> Option<f64>,
) -> Vec<Vec<(f64, f64)>> {
    let point = |row: usize| Some((percent(found, recording.inputs.get(row)?.followed_command), of(row)?));
    let branches = recording.branches().into_iter().filter(|branch| branch.rises == rising);
    let points = branches.map(|branch| branch.rows.filter_map(point).collect::<Vec<_>>());
    points.filter(|points| !points.is_empty()).collect()
}

/// A line for each branch.
fn lines(branches: Vec<Vec<(f64, f64)>>, series: usize) -> impl Iterator<Item = Curve> {
    branches.into_iter().map(move |points| Curve::line(points, series))
}

/// A chart over the command, up to this distance on either side of zero, percent.
fn over_commands(reach: f64, panels: Vec<CurvePanel>, legend: Vec<(String, CurveStyle)>) -> CurveChart {
    CurveChart { x_title: COMMAND.to_string(), x_range: [-reach, reach], panels, legend }
}

/// The greatest command of all recordings, percent.
fn greatest_command(found: &Identification) -> f64 {
    let commands = found.recordings.iter().flat_map(|one| &one.inputs).map(|input| input.command.abs());
    percent(found, commands.fold(0.0, f64::max)).ceil()
}

/// Marks at both nulls.
fn null_marks(found: &Identification) -> Vec<(f64, String)> {
    let nulls = found.simple.nulls.into_iter().zip(["rising", "falling"]);
    nulls
        .filter_map(|(null, way)| Some((percent(found, null?.command.value), format!("null {way}"))))
        .collect()
}

fn ways_legend(kind: impl Fn(usize) -> CurveStyle) -> Vec<(String, CurveStyle)> {
    WAYS.into_iter().enumerate().map(|(index, (name, _))| (name.to_string(), kind(index))).collect()
}

fn leakage(found: &Identification, recording: &Recording) -> Figure {
    let litre = DisplayUnit::LITRE_PER_MINUTE;
    let value = |row: usize| {
        let value = recording.signal(SignalKind::LeakFlow)?.values.get(row).copied()?;
        value.map(|value| litre.of(value))
    };
    let shown = WAYS.into_iter().enumerate();
    let lines =
        shown.flat_map(|(index, (_, rising))| lines(over_command(found, recording, rising, value), index));
    let mut only = CurvePanel::new("Leakage with tare flow (L/min)", 250.0, lines.collect());
    only.marked = null_marks(found);
    let chart = over_commands(AROUND_NULL, vec![only], ways_legend(CurveStyle::Line));
    let caption = "Internal leakage around null with rising and with falling command; the base is the tare flow, and the centres of both curves lie a hysteresis apart (Ledezma 2019, Figure 5.5). Every branch is drawn; the first begins without the memory of a reversal.";
    chart.draw(&Words::new("leakage_both_ways", "Internal leakage both ways", caption))
}

/// Flow with its direction according to the model if the meter does not indicate it.
fn signed_flow(recording: &Recording, outputs: &[TestOutput], row: usize) -> Option<f64> {
    let (kind, _) = flow_signal(recording)?;
    let value = recording.signal(kind)?.values.get(row).copied()??;
    let direction = outputs.get(row)?.port_flow;
    let signed = if kind == SignalKind::PortFlow { value } else { value.copysign(direction) };
    Some(DisplayUnit::LITRE_PER_MINUTE.of(signed))
}

/// Flow over the command by each meter, and around null.
fn flow_gain(found: &Identification) -> Vec<Figure> {
    let metered: Vec<(usize, &Recording)> = found
        .recordings
        .iter()
        .enumerate()
        .filter(|(_, one)| one.circuit == PortCircuit::Connected)
        .collect();
    if metered.is_empty() {
        return Vec::new();
    }
    let whole = metered.iter().enumerate().map(|(series, (index, one))| {
        let outputs = found.outputs_of(*index, &found.coefficients);
        let both = WAYS
            .into_iter()
            .flat_map(|(_, rising)| over_command(found, one, rising, |row| signed_flow(one, &outputs, row)))
            .flatten();
        Curve::dots(both, series)
    });
    let names = metered.iter().enumerate();
    let most = greatest_command(found);
    let chart = over_commands(
        most,
        vec![CurvePanel::new("Flow from A to B (L/min)", 260.0, whole.collect())],
        names.map(|(series, (_, one))| (stem(one).replace('_', " "), CurveStyle::Dots(series))).collect(),
    );
    let caption = "Flow over the command by each meter, with the direction of the model where the meter does not indicate it; where the large meter reads zero there are no readings (Ledezma 2019, Figure 5.9).";
    let first = chart.draw(&Words::new("flow_gain", "Flow gain", caption));
    vec![first, flow_gain_at_null(found, &metered)]
}

fn flow_gain_at_null(found: &Identification, metered: &[(usize, &Recording)]) -> Figure {
    let litre = DisplayUnit::LITRE_PER_MINUTE;
    let mut shown = Vec::new();
    let finest = metered.last();
    for (series, (_, rising)) in WAYS.into_iter().enumerate() {
        let read = metered.iter().flat_map(|(index, one)| {
            let outputs = found.outputs_of(*index, &found.coefficients);
            over_command(found, one, rising, |row| signed_flow(one, &outputs, row)).into_iter().flatten()
        });
        shown.push(Curve::dots(read, series));
        if let Some((index, one)) = finest {
            let outputs = found.outputs_of(*index, &found.coefficients);
            let flow = |row: usize| outputs.get(row).map(|output| litre.of(output.port_flow));
            shown.extend(lines(over_command(found, one, rising, flow), series));
        }
    }
    let mut legend = ways_legend(CurveStyle::Dots);
    legend.extend(
        ways_legend(CurveStyle::Line).into_iter().map(|(name, style)| (format!("model, {name}"), style)),
    );
    let chart =
        over_commands(NEAR_NULL, vec![CurvePanel::new("Flow from A to B (L/min)", 260.0, shown)], legend);
    let caption = "The same around null, both ways: between the curves lies the hysteresis (Ledezma 2019, Figure 5.10). Lines are the identified valve.";
    chart.draw(&Words::new("flow_gain_at_null", "Flow gain around null", caption))
}

fn pressure_sensitivity(found: &Identification) -> Option<Figure> {
    let blocked = found.recordings.iter().filter(|one| one.circuit == PortCircuit::Blocked);
    let near = |one: &&Recording| {
        let inputs = one.inputs.iter();
        inputs.filter(|input| percent(found, input.command).abs() < CLOSE_TO_NULL).count()
    };
    let recording = blocked.filter(|one| port_pressures(one, 0).is_some()).max_by_key(near)?;
    let bar = DisplayUnit::BAR;
    let load = |row: usize| port_pressures(recording, row).map(|[a, b]| bar.of(a - b));
    let shown = WAYS.into_iter().enumerate();
    let lines =
        shown.flat_map(|(index, (_, rising))| lines(over_command(found, recording, rising, load), index));
    let only = CurvePanel::new("p_A - p_B (bar)", 250.0, lines.collect()).with_zero_line();
    let chart = over_commands(CLOSE_TO_NULL, vec![only], ways_legend(CurveStyle::Line));
    let caption = "Load pressure over the command with blocked ports: its slope at zero is the pressure sensitivity (Ledezma 2019, section 5.3). Every branch is drawn; the first begins without the memory of a reversal.";
    Some(chart.draw(&Words::new("pressure_sensitivity", "Pressure sensitivity", caption)))
}

/// A recorded signal, the unit it is shown in, and its value in the model.
type ShownSignal = (SignalKind, DisplayUnit, fn(&TestOutput) -> f64);

/// A leakage test compared with the model, in one direction, with residuals.
fn against_model(found: &Identification, index: usize, (way, rising): (&str, bool)) -> Figure {
    let (bar, litre) = (DisplayUnit::BAR, DisplayUnit::LITRE_PER_MINUTE);
    let outputs = found.outputs_of(index, &found.coefficients);
    let recording = found.recordings.get(index);
    let shown: [ShownSignal; 3] = [
        (SignalKind::LeakFlow, litre, |output| output.leak_flow),
        (SignalKind::PressureA, bar, |output| output.pressure_a),
        (SignalKind::PressureB, bar, |output| output.pressure_b),
    ];
    let titles = [("Leakage (L/min)", "\u{394}q (L/min)", 0..1), ("Pressure (bar)", "\u{394}p (bar)", 1..3)];
    let mut panels = Vec::new();
    for (title, residual, which) in titles {
        let (mut both, mut left) = (Vec::new(), Vec::new());
        for (series, (kind, unit, of)) in
            shown.iter().enumerate().filter(|(series, _)| which.contains(series))
        {
            let Some(recording) = recording else { continue };
            let Some(signal) = recording.signal(*kind) else { continue };
            let measured = |row: usize| signal.values.get(row).copied().flatten().map(|value| unit.of(value));
            let model = |row: usize| outputs.get(row).map(|output| unit.of(of(output)));
            let read = over_command(found, recording, rising, measured);
            both.push(Curve::dots(read.into_iter().flatten(), series));
            both.extend(lines(over_command(found, recording, rising, model), series));
            let rest = |row: usize| Some(model(row)? - measured(row)?);
            let remains = over_command(found, recording, rising, rest);
            left.push(Curve::dots(remains.into_iter().flatten(), series));
        }
        panels.push(CurvePanel::new(title, 130.0, both));
        panels.push(CurvePanel::new(residual, 76.0, left).with_zero_line());
    }
    let names = ["leakage", "p_A", "p_B"].into_iter().enumerate();
    let mut legend: Vec<(String, CurveStyle)> =
        names.map(|(series, name)| (format!("{name}, test"), CurveStyle::Dots(series))).collect();
    legend.extend(
        ["leakage", "p_A", "p_B"]
            .into_iter()
            .enumerate()
            .map(|(series, name)| (format!("{name}, model"), CurveStyle::Line(series))),
    );
    let chart = over_commands(AROUND_NULL, panels, legend);
    let figure = if rising { "5.12" } else { "5.11" };
    let caption = format!(
        "Leakage test and identified valve with {way}: leakage, pressures at both ports, and what is left of each (Ledezma 2019, Figure {figure})."
    );
    let name = if rising { "test_and_model_rising" } else { "test_and_model_falling" };
    chart.draw(&Words::new(name, format!("Test and model, {way}"), caption))
}

/// Residuals of every signal, over the command.
fn residuals(found: &Identification) -> Figure {
    let most = greatest_command(found);
    let one = |signal: &SignalFit| {
        let recording = found.recordings.get(signal.recording)?;
        let unit = if signal.kind.is_pressure() { DisplayUnit::BAR } else { DisplayUnit::LITRE_PER_MINUTE };
        let residuals = found.residuals(signal, &found.coefficients);
        let both = recording.inputs.iter().zip(residuals);
        let points = both.filter_map(|(input, rest)| Some((percent(found, input.command), unit.of(rest?))));
        let short = match signal.kind {
            SignalKind::PressureA => "p_A",
            SignalKind::PressureB => "p_B",
            SignalKind::MeanPressure => "p",
            _ => "q",
        };
        let title = format!("{short} ({})", unit.symbol);
        let label = vec![(-most, stem(recording).replace('_', " "))];
        let residual = CurvePanel::new(title, 62.0, vec![Curve::dots(points, 0)]).with_zero_line();
        Some(CurvePanel { marked: label, ..residual })
    };
    let chart = over_commands(most, found.signals.iter().filter_map(one).collect(), vec![]);
    let caption = "What the identified valve leaves of every recorded signal, over the command: noise alone where the model is right.";
    chart.draw(&Words::new("residuals", "Residuals", caption))
}
