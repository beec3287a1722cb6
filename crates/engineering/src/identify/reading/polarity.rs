//! Check for signals with the wrong sign: pairs with opposite tendencies, and the setting that
//! reverses one.
//!
//! A positive command opens the supply to port A. With blocked ports p_A - p_B rises with the
//! command; with joined ports the flow from A to B and the drop p_A - p_B across the meter do.

use phea_hydraulics::servovalve::PortCircuit;

use super::Taken;
use super::error::{
    ColumnSetting, OppositeSignals, RecordedTestError, RecordedTestHint, SignRemedy, TurnedSignal,
};
use crate::project::{Findings, RawFinding, TestSignal};
use crate::table::{Column, MeasuredTable};
use crate::tendency::Tendency;

/// Ratio of the least flow in one direction to the greatest in the other from which a meter
/// indicates the direction: less is noise around zero.
const SIGNED: f64 = 0.1;

/// A file whose signs are checked.
struct CheckedRecording<'a> {
    table: &'a MeasuredTable,
    columns: &'a [(TestSignal, Column)],
    taken: &'a Taken,
}

/// Rejects a recording in which a signal moves against the command.
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

    /// Signal p_A - p_B with its name; that of one port if the other was not recorded.
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

    /// Checks the leakage, which is never negative except for the noise of its meter.
    fn leakage(&self, findings: &mut Findings) {
        let Some(values) = self.taken.of(TestSignal::LeakFlow) else { return };
        let shown: Vec<f64> =
            values.iter().copied().filter(|value| !value.is_nan() && *value != 0.0).collect();
        let negative = shown.iter().filter(|value| **value < 0.0).count();
        let sum: f64 = shown.iter().sum();
        if 2 * negative <= shown.len() || sum >= 0.0 {
            return;
        }
        let name = self.heading(TestSignal::LeakFlow);
        let message = RecordedTestError::NegativeLeakage { name, count: negative, rows: shown.len() };
        let found = self.finding(TestSignal::LeakFlow, message.to_string());
        let found = found.expected(RecordedTestHint::PositiveLeakage.to_string());
        let remedy = self.remedy(TurnedSignal::Flow);
        findings.push(found.help(RecordedTestHint::MeterReversed(remedy).to_string()));
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
            let found = self.finding(TestSignal::Command, message.to_string());
            let found = found.expected(RecordedTestHint::RisingPressure.to_string());
            findings.push(found.help(self.remedies(&[TurnedSignal::Command, TurnedSignal::Ports])));
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
        // the drop across a meter is small: its drift with time may be larger
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
        let (signal, opposite, turned): (TestSignal, Vec<OppositeSignals>, &[TurnedSignal]) =
            match (drop_falls, flow_falls) {
                (Some(drop), Some(flow)) => {
                    let both =
                        [falls(drop_name, &command_name, drop), falls(&flow_name, &command_name, flow)];
                    (TestSignal::Command, both.to_vec(), &[TurnedSignal::Command])
                }
                (None, Some(flow)) => {
                    let over_drop = flow_over_drop.filter(Tendency::is_opposite);
                    let of_drop = over_drop.map(|tendency| falls(&flow_name, drop_name, tendency));
                    let of_command = falls(&flow_name, &command_name, flow);
                    let turned: &[TurnedSignal] = match drop_rises {
                        true => &[TurnedSignal::Flow],
                        false => &[TurnedSignal::Flow, TurnedSignal::Command],
                    };
                    (TestSignal::Flow, std::iter::once(of_command).chain(of_drop).collect(), turned)
                }
                (Some(drop), None) => {
                    let turned: &[TurnedSignal] = match flow_rises {
                        true => &[TurnedSignal::Ports],
                        false => &[TurnedSignal::Command, TurnedSignal::Ports],
                    };
                    let signal = if flow_rises { TestSignal::PressureA } else { TestSignal::Command };
                    (signal, vec![falls(drop_name, &command_name, drop)], turned)
                }
                (None, None) => return,
            };
        let messages: Vec<String> = opposite.iter().map(ToString::to_string).collect();
        let found = self.finding(signal, messages.join(", and "));
        let expected = match &flow {
            Some(_) => RecordedTestHint::RisingFlowAndDrop,
            None => RecordedTestHint::RisingDrop,
        };
        findings.push(found.expected(expected.to_string()).help(self.remedies(turned)));
    }

    /// Signals that may be wrong, each with the setting that reverses it.
    fn remedies(&self, turned: &[TurnedSignal]) -> String {
        let named = turned.iter().map(|one| (one, self.remedy(*one)));
        match turned {
            [_] => named.map(|(what, remedy)| format!("{what}: {remedy}")).collect(),
            _ => {
                let each: Vec<String> = named.map(|(what, remedy)| format!("if {what}, {remedy}")).collect();
                each.join("; ")
            }
        }
    }

    fn remedy(&self, turned: TurnedSignal) -> SignRemedy {
        let is_leakage = self.column(TestSignal::LeakFlow).is_some();
        let signal = match turned {
            TurnedSignal::Command => TestSignal::Command,
            TurnedSignal::Flow if is_leakage => TestSignal::LeakFlow,
            TurnedSignal::Flow => TestSignal::Flow,
            TurnedSignal::Ports => return SignRemedy::Exchange(self.exchanged_ports()),
        };
        match self.column(signal) {
            Some(column) if column.is_reversed => SignRemedy::RemoveReversed(signal.name()),
            _ => SignRemedy::StateReversed(signal.name()),
        }
    }

    /// Columns of the ports, exchanged.
    fn exchanged_ports(&self) -> Vec<ColumnSetting> {
        let both = [TestSignal::PressureA, TestSignal::PressureB];
        let exchanged = both.iter().zip(both.iter().rev()).filter_map(|(of, other)| {
            let column = self.column(*other)?;
            let heading = self.table.heading(column).to_string();
            Some(ColumnSetting { key: of.name(), heading, unit: column.unit.clone() })
        });
        exchanged.collect()
    }
}

/// Error for one signal that falls while another rises.
fn falls(one: &str, other: &str, Tendency { correlation, rows }: Tendency) -> OppositeSignals {
    OppositeSignals { signal: one.to_string(), other: other.to_string(), correlation, rows }
}

/// Flow in the rows in which the meter turns; NaN elsewhere.
fn turning(flow: &[f64]) -> Vec<f64> {
    flow.iter().map(|value| if *value == 0.0 { f64::NAN } else { *value }).collect()
}

/// True for a meter that indicates the direction: some of the flow is negative, beyond its noise.
fn is_signed(flow: &[f64]) -> bool {
    let least = flow.iter().copied().fold(0.0, f64::min);
    let most = flow.iter().copied().fold(0.0, f64::max);
    least < 0.0 && -least >= SIGNED * most
}
