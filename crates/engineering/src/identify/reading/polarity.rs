//! Signals with the wrong sign: which one goes against which, and the setting that turns it.
//!
//! A positive command opens the supply to port A. With blocked ports p_A - p_B rises with the
//! command; with joined ports the flow from A to B and the drop p_A - p_B across the meter do.

use phea_hydraulics::servovalve::PortCircuit;

use super::Taken;
use crate::project::{Findings, RawFinding, TestSignal};
use crate::table::{Column, MeasuredTable};
use crate::tendency::Tendency;

/// The least flow in one direction, over the greatest in the other, by which a meter indicates the
/// direction: less is noise around zero.
const SIGNED: f64 = 0.1;

/// Signal that may have the wrong sign.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Turned {
    Command,
    Flow,
    Ports,
}

/// A file whose signs are checked.
struct CheckedRecording<'a> {
    table: &'a MeasuredTable,
    columns: &'a [(TestSignal, Column)],
    taken: &'a Taken,
}

/// Refuses a recording in which a signal goes against the command.
pub(super) fn check(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    taken: &Taken,
    circuit: PortCircuit,
    findings: &mut Findings,
) {
    let checked = CheckedRecording { table, columns, taken };
    match circuit {
        PortCircuit::Blocked => {
            checked.leakage(findings);
            checked.blocked_ports(findings);
        }
        PortCircuit::Connected => checked.joined_ports(findings),
    }
}

impl CheckedRecording<'_> {
    fn column(&self, signal: TestSignal) -> Option<&Column> {
        self.columns.iter().find(|(one, _)| *one == signal).map(|(_, column)| column)
    }

    fn heading(&self, signal: TestSignal) -> String {
        self.column(signal).map_or(String::new(), |column| format!("`{}`", self.table.heading(column)))
    }

    fn finding(&self, signal: TestSignal, message: String) -> RawFinding {
        let place = self.column(signal).and_then(|column| self.table.headings.get(column.index));
        RawFinding::error(place.map(|heading| heading.place).unwrap_or_default(), message)
    }

    /// p_A - p_B with its name; that of one port where the other was not recorded.
    fn pressure_of_ports(&self) -> Option<(String, Vec<f64>)> {
        let [a, b] = [TestSignal::PressureA, TestSignal::PressureB].map(|signal| self.taken.of(signal));
        let [name_a, name_b] = [TestSignal::PressureA, TestSignal::PressureB].map(|one| self.heading(one));
        match (a, b) {
            (Some(a), Some(b)) => {
                let drop = a.iter().zip(b).map(|(a, b)| a - b).collect();
                Some((format!("{name_a} less {name_b}"), drop))
            }
            (Some(a), None) => Some((name_a, a.to_vec())),
            (None, Some(b)) => Some((format!("minus {name_b}"), b.iter().map(|b| -b).collect())),
            (None, None) => None,
        }
    }

    /// A leakage is never negative but for the noise of its meter.
    fn leakage(&self, findings: &mut Findings) {
        let Some(values) = self.taken.of(TestSignal::LeakFlow) else { return };
        let shown: Vec<f64> =
            values.iter().copied().filter(|value| !value.is_nan() && *value != 0.0).collect();
        let negative = shown.iter().filter(|value| **value < 0.0).count();
        let sum: f64 = shown.iter().sum();
        if 2 * negative <= shown.len() || sum >= 0.0 {
            return;
        }
        let heading = self.heading(TestSignal::LeakFlow);
        let message = format!("{heading} is negative in {negative} of {} rows", shown.len());
        let found = self.finding(TestSignal::LeakFlow, message);
        let found = found.expected("a leakage from the supply, which is positive");
        findings.push(found.help(format!("the meter is reversed: {}", self.cure(Turned::Flow))));
    }

    fn blocked_ports(&self, findings: &mut Findings) {
        let Some((name, pressures)) = self.pressure_of_ports() else { return };
        let (Some(command), Some(times)) =
            (self.taken.of(TestSignal::Command), self.taken.of(TestSignal::Time))
        else {
            return;
        };
        let tendency = Tendency::without_drift(&pressures, command, times);
        let tendency = tendency.or_else(|| Tendency::of(&pressures, command));
        if let Some(tendency) = tendency.filter(Tendency::is_opposite) {
            let message = falls(&name, &self.heading(TestSignal::Command), tendency);
            let found = self.finding(TestSignal::Command, message);
            let found = found.expected("a positive command opens the supply to port A, whose pressure rises");
            findings.push(found.help(self.cures(&[Turned::Command, Turned::Ports])));
        }
    }

    fn joined_ports(&self, findings: &mut Findings) {
        let (Some(command), Some(times)) =
            (self.taken.of(TestSignal::Command), self.taken.of(TestSignal::Time))
        else {
            return;
        };
        let has_both = [TestSignal::PressureA, TestSignal::PressureB].map(|one| self.taken.of(one).is_some());
        let drop = self.pressure_of_ports().filter(|_| has_both == [true, true]);
        let flow = self.taken.of(TestSignal::Flow).map(turning).filter(|flow| is_signed(flow));
        let [command_name, flow_name] = [TestSignal::Command, TestSignal::Flow].map(|one| self.heading(one));
        // the drop across a meter is small: what drifts with time may be larger
        let of_drop = drop.as_ref().and_then(|(_, drop)| Tendency::without_drift(drop, command, times));
        let of_flow = flow.as_ref().and_then(|flow| {
            Tendency::without_drift(flow, command, times).or_else(|| Tendency::of(flow, command))
        });
        let flow_over_drop = flow
            .as_ref()
            .zip(drop.as_ref())
            .and_then(|(flow, (_, drop))| Tendency::without_drift(flow, drop, times));
        let drop_name = drop.as_ref().map_or("", |(name, _)| name.as_str());
        let [drop_falls, flow_falls] = [of_drop, of_flow].map(|one| one.filter(Tendency::is_opposite));
        let [drop_rises, flow_rises] =
            [of_drop, of_flow].map(|one| one.is_some_and(|tendency| tendency.is_alike()));
        let (signal, messages, turned): (TestSignal, Vec<String>, &[Turned]) = match (drop_falls, flow_falls)
        {
            (Some(drop), Some(flow)) => {
                let both = [falls(drop_name, &command_name, drop), falls(&flow_name, &command_name, flow)];
                (TestSignal::Command, both.to_vec(), &[Turned::Command])
            }
            (None, Some(flow)) => {
                let over_drop = flow_over_drop.filter(Tendency::is_opposite);
                let of_drop = over_drop.map(|tendency| falls(&flow_name, drop_name, tendency));
                let message = falls(&flow_name, &command_name, flow);
                let turned: &[Turned] =
                    if drop_rises { &[Turned::Flow] } else { &[Turned::Flow, Turned::Command] };
                (TestSignal::Flow, std::iter::once(message).chain(of_drop).collect(), turned)
            }
            (Some(drop), None) => {
                let turned: &[Turned] =
                    if flow_rises { &[Turned::Ports] } else { &[Turned::Command, Turned::Ports] };
                let signal = if flow_rises { TestSignal::PressureA } else { TestSignal::Command };
                (signal, vec![falls(drop_name, &command_name, drop)], turned)
            }
            (None, None) => return,
        };
        let found = self.finding(signal, messages.join(", and "));
        let found = found.expected(match &flow {
            Some(_) => {
                "flow from port A to port B, and the drop across the meter, that rise with the command"
            }
            None => "a drop from port A to port B across the meter that rises with the command",
        });
        findings.push(found.help(self.cures(turned)));
    }

    /// Signals that may be wrong, each with the setting that turns it.
    fn cures(&self, turned: &[Turned]) -> String {
        let named = turned.iter().map(|one| {
            let what = match one {
                Turned::Command => "the command is reversed",
                Turned::Flow => "the flow meter is reversed",
                Turned::Ports => "the pressures of the ports are exchanged",
            };
            (what, self.cure(*one))
        });
        match turned {
            [_] => named.map(|(what, cure)| format!("{what}: {cure}")).collect(),
            _ => {
                let each: Vec<String> = named.map(|(what, cure)| format!("if {what}, {cure}")).collect();
                each.join("; ")
            }
        }
    }

    fn cure(&self, turned: Turned) -> String {
        let place = "in its `[[identify.recording]]` of a project";
        let is_leakage = self.column(TestSignal::LeakFlow).is_some();
        let signal = match turned {
            Turned::Command => TestSignal::Command,
            Turned::Flow if is_leakage => TestSignal::LeakFlow,
            Turned::Flow => TestSignal::Flow,
            Turned::Ports => return format!("state {} {place}", self.exchanged_ports()),
        };
        let key = signal.name();
        match self.column(signal) {
            Some(column) if column.is_reversed => format!("remove `reversed = true` of `{key}` {place}"),
            _ => format!("state `{key} = {{ reversed = true }}` {place}"),
        }
    }

    /// The columns of the ports, each for the other one.
    fn exchanged_ports(&self) -> String {
        let both = [TestSignal::PressureA, TestSignal::PressureB];
        let exchanged = both.iter().zip(both.iter().rev()).filter_map(|(of, other)| {
            let column = self.column(*other)?;
            let (heading, unit) = (self.table.heading(column), &column.unit);
            Some(format!("`{} = {{ column = \"{heading}\", unit = \"{unit}\" }}`", of.name()))
        });
        exchanged.collect::<Vec<_>>().join(" and ")
    }
}

/// One signal falls while another rises.
fn falls(one: &str, other: &str, Tendency { correlation, rows }: Tendency) -> String {
    format!("{one} falls while {other} rises (correlation {correlation:.2} over {rows} rows)")
}

/// The flow where the meter turns; NaN elsewhere.
fn turning(flow: &[f64]) -> Vec<f64> {
    flow.iter().map(|value| if *value == 0.0 { f64::NAN } else { *value }).collect()
}

/// True of a meter that indicates the direction: some of the flow is negative, beyond its noise.
fn is_signed(flow: &[f64]) -> bool {
    let least = flow.iter().copied().fold(0.0, f64::min);
    let most = flow.iter().copied().fold(0.0, f64::max);
    least < 0.0 && -least >= SIGNED * most
}
