//! The record of a run: samples of the machine and its controller, evenly spaced in time.

use phea_hydraulics::machine::SIGNALS;

use super::columns::{self, LOOP_SIGNALS};
use super::parts::SignalParts;
use phea_quantity::Units;

/// Largest number of samples of a run that its record keeps.
const MOST_KEPT: usize = 100_000;

/// The machine and its controller at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// s.
    pub time_s: f64,
    /// N; at a step, the value from then on. `None` in an open loop.
    pub reference_n: Option<f64>,
    /// N, after the prefilter. `None` in an open loop.
    pub filtered_reference_n: Option<f64>,
    /// V, output of the controller, or the command of an open loop.
    pub control_v: f64,
    /// N, external force on the load, if there is one.
    pub external_force_n: Option<f64>,
    /// The signals of the machine, in the order of [`SIGNALS`].
    pub signals: [f64; SIGNALS.len()],
    /// The signals of the control loop, in the order of [`LOOP_SIGNALS`]; in an open loop the
    /// command, without an integral part.
    pub of_loop: [f64; LOOP_SIGNALS.len()],
}

/// The machine and its controller over time: every sample or, in a long run, every second, fourth,
/// eighth and so on, so that no more than a hundred thousand are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// s.
    pub times_s: Vec<f64>,
    /// N; at a step, the value from then on. Empty in an open loop.
    pub reference_n: Vec<f64>,
    /// N, after the prefilter. Empty in an open loop.
    pub filtered_reference_n: Vec<f64>,
    /// V, output of the controller, or the command of an open loop.
    pub control_v: Vec<f64>,
    /// N, external force on the load; empty if there is none.
    pub external_force_n: Vec<f64>,
    /// The signals of the machine, each in the order of [`SIGNALS`].
    pub signals: Vec<[f64; SIGNALS.len()]>,
    /// The signals of the control loop, each in the order of [`LOOP_SIGNALS`].
    pub of_loop: Vec<[f64; LOOP_SIGNALS.len()]>,
    /// Number of samples from one of these to the next.
    pub looks_apart: u64,
    /// The units in which it is shown, with how the rig moves: of one that turns, positions are in
    /// rad and forces in N m.
    pub units: Units,
    /// Which parts the rig has.
    pub parts: SignalParts,
}

impl Default for Record {
    fn default() -> Record {
        Record {
            times_s: vec![],
            reference_n: vec![],
            filtered_reference_n: vec![],
            control_v: vec![],
            external_force_n: vec![],
            signals: vec![],
            of_loop: vec![],
            looks_apart: 1,
            units: Units::default(),
            parts: SignalParts::default(),
        }
    }
}

impl Record {
    /// A column of the table over time; empty for an unknown name, and for one of a part that the
    /// rig lacks.
    pub fn signal(&self, name: &str) -> Vec<f64> {
        columns::signal(self, name)
    }

    /// Allocates memory for this many samples at once, but for no more than a long run keeps.
    pub(super) fn reserve(&mut self, looks: usize) {
        let looks = looks.min(MOST_KEPT + 1);
        self.times_s.reserve(looks);
        self.control_v.reserve(looks);
        self.signals.reserve(looks);
        self.of_loop.reserve(looks);
    }

    /// Keeps the sample of this number, counted from zero, or leaves it out.
    pub(super) fn take(&mut self, number: u64, look: &Look) {
        if !number.is_multiple_of(self.looks_apart) {
            return;
        }
        self.times_s.push(look.time_s);
        self.reference_n.extend(look.reference_n);
        self.filtered_reference_n.extend(look.filtered_reference_n);
        self.control_v.push(look.control_v);
        self.external_force_n.extend(look.external_force_n);
        self.signals.push(look.signals);
        self.of_loop.push(look.of_loop);
        if self.times_s.len() > MOST_KEPT {
            self.halve();
        }
    }

    fn halve(&mut self) {
        let columns = [
            &mut self.times_s,
            &mut self.reference_n,
            &mut self.filtered_reference_n,
            &mut self.control_v,
            &mut self.external_force_n,
        ];
        columns.into_iter().for_each(every_second);
        every_second(&mut self.signals);
        every_second(&mut self.of_loop);
        self.looks_apart *= 2;
    }
}

/// The first, the third and so on.
fn every_second<T>(values: &mut Vec<T>) {
    let mut kept = false;
    values.retain(|_| {
        kept = !kept;
        kept
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However long a run is, its record is short, evenly spaced, and begins with the first sample.
    #[test]
    fn a_record_is_even_and_never_long() {
        let parts = SignalParts { external_force: true, ..SignalParts::default() };
        let mut record = Record { parts, ..Record::default() };
        let looks = 7 * MOST_KEPT as u64 / 2;
        for number in 0..looks {
            let time_s = number as f64;
            let signals = [time_s; SIGNALS.len()];
            let (reference_n, filtered_reference_n, control_v) = (Some(time_s), Some(time_s), time_s);
            let external_force_n = Some(time_s);
            let of_loop = [time_s; LOOP_SIGNALS.len()];
            let look = Look {
                time_s,
                reference_n,
                filtered_reference_n,
                control_v,
                external_force_n,
                signals,
                of_loop,
            };
            record.take(number, &look);
            assert!(record.times_s.len() <= MOST_KEPT);
        }
        assert_eq!(record.looks_apart, 4);
        let expected: Vec<f64> = (0..looks).step_by(4).map(|number| number as f64).collect();
        assert!(record.times_s == expected && record.control_v == expected);
        assert!(record.signal("force_n") == expected && record.reference_n == expected);
        assert!(record.signal("integral_v") == expected);
        assert!(record.filtered_reference_n == expected && record.external_force_n == expected);
    }
}
