//! What is seen of a run on the way: each look goes into the table and the metrics as it comes, and a course is kept for figures.

use std::cell::{Cell, RefCell};

use phea_dynamics::simulation::{Observer, System};
use phea_hydraulics::machine::SIGNALS;

use super::bench::{Bench, Control};
use super::digital::Samples;
use super::files::Table;
use super::{Seen, SimulateError};
use crate::source::WriteError;

/// Most looks of a run that its record keeps.
const MOST_KEPT: usize = 100_000;

/// The machine and its controller at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// s.
    pub time_s: f64,
    /// N; at a step, as it is from then on. `None` in an open loop.
    pub reference_n: Option<f64>,
    /// N, behind the prefilter. `None` in an open loop.
    pub filtered_reference_n: Option<f64>,
    /// V, what the controller gives out, or what is commanded in an open loop.
    pub control_v: f64,
    /// N, on the load from outside, where there is such a force.
    pub external_force_n: Option<f64>,
    /// What the machine tells of itself, in the order of [`SIGNALS`].
    pub signals: [f64; SIGNALS.len()],
}

/// The machine and its controller over time: every look, or of a long run every second, fourth, eighth and so on, so that no
/// more than a hundred thousand are held.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// s.
    pub times_s: Vec<f64>,
    /// N; at a step, as it is from then on. None in an open loop.
    pub reference_n: Vec<f64>,
    /// N, behind the prefilter. None in an open loop.
    pub filtered_reference_n: Vec<f64>,
    /// V, what the controller gives out, or what is commanded in an open loop.
    pub control_v: Vec<f64>,
    /// N, on the load from outside; none where there is no such force.
    pub external_force_n: Vec<f64>,
    /// What the machine tells of itself, each in the order of [`SIGNALS`].
    pub signals: Vec<[f64; SIGNALS.len()]>,
    /// Looks from one of these to the next.
    pub looks_apart: u64,
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
            looks_apart: 1,
        }
    }
}

impl Record {
    /// One of [`SIGNALS`] over time; empty for a name that is none.
    pub fn signal(&self, name: &str) -> Vec<f64> {
        let Some(index) = SIGNALS.iter().position(|signal| *signal == name) else { return Vec::new() };
        self.signals.iter().map(|row| row[index]).collect()
    }

    /// Takes the look of this number, counted from zero, or leaves it out.
    fn take(&mut self, number: u64, look: &Look) {
        if !number.is_multiple_of(self.looks_apart) {
            return;
        }
        self.times_s.push(look.time_s);
        self.reference_n.extend(look.reference_n);
        self.filtered_reference_n.extend(look.filtered_reference_n);
        self.control_v.push(look.control_v);
        self.external_force_n.extend(look.external_force_n);
        self.signals.push(look.signals);
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

/// What metrics are read off, at every look.
#[derive(Debug, Default)]
pub(super) struct Looks {
    times_s: Vec<f64>,
    force_n: Vec<f64>,
    reference_n: Vec<f64>,
    control_v: Vec<f64>,
    /// Highest pressures of chambers A and B so far, Pa.
    pub(super) peak_pressures_pa: [f64; 2],
}

impl Looks {
    fn take(&mut self, look: &Look, Places { force, pressures }: Places) {
        self.times_s.push(look.time_s);
        self.force_n.push(look.signals[force]);
        self.reference_n.extend(look.reference_n);
        self.control_v.push(look.control_v);
        for (peak, place) in self.peak_pressures_pa.iter_mut().zip(pressures) {
            *peak = peak.max(look.signals[place]);
        }
    }

    pub(super) fn seen(&self) -> Seen<'_> {
        Seen {
            times_s: &self.times_s,
            force_n: &self.force_n,
            reference_n: &self.reference_n,
            control_v: &self.control_v,
        }
    }
}

/// Where among the signals is what metrics are read off.
#[derive(Clone, Copy, Debug)]
struct Places {
    force: usize,
    /// Of chambers A and B.
    pressures: [usize; 2],
}

/// Looks at a machine and its controller.
pub(super) struct Looking<'a> {
    bench: &'a Bench,
    /// What a sampled controller did last.
    samples: &'a RefCell<Samples>,
    /// All states.
    wanted: Vec<usize>,
    places: Places,
    /// Looks so far.
    count: u64,
    looks_per_row: u64,
    table: Option<Table<'a>>,
    record: Record,
    looks: Looks,
    /// Whether the table takes no more, and why.
    full: &'a Cell<bool>,
    fault: Option<WriteError>,
}

impl<'a> Looking<'a> {
    pub(super) fn new(
        bench: &'a Bench,
        samples: &'a RefCell<Samples>,
        (table, looks_per_row): (Option<Table<'a>>, usize),
        full: &'a Cell<bool>,
    ) -> Looking<'a> {
        let states = match &bench.control {
            Control::Continuous(closed) => System::<f64>::states(closed.as_ref()),
            Control::Sampled(sampled) => System::<f64>::states(&sampled.held),
            Control::Open(held) => System::<f64>::states(held.as_ref()),
        };
        let place = |name: &str| SIGNALS.iter().position(|signal| *signal == name).unwrap_or_default();
        Looking {
            bench,
            samples,
            wanted: (0..states).collect(),
            places: Places {
                force: place("force_n"),
                pressures: [place("pressure_a_pa"), place("pressure_b_pa")],
            },
            count: 0,
            looks_per_row: looks_per_row as u64,
            table,
            record: Record::default(),
            looks: Looks::default(),
            full,
            fault: None,
        }
    }

    /// What was seen, its table finished.
    ///
    /// # Errors
    /// [`SimulateError::Write`] where a row could not be written.
    pub(super) fn finish(self) -> Result<(Record, Looks), SimulateError> {
        if let Some(fault) = self.fault {
            return Err(SimulateError::Write(fault));
        }
        if let Some(table) = self.table {
            table.finish().map_err(SimulateError::Write)?;
        }
        Ok((self.record, self.looks))
    }

    fn look(&self, time_s: f64, states: &[f64], inputs: &[f64]) -> Look {
        let (asked_for, control_v, others) = match &self.bench.control {
            Control::Continuous(closed) => {
                let signals = closed.signals::<f64, f64>(states, inputs);
                (Some([inputs[0], signals.filtered_reference]), signals.command, &inputs[1..])
            }
            Control::Sampled(_) => {
                let last = self.samples.borrow().last;
                let [filtered, command] =
                    last.map_or([0.0; 2], |sample| [sample.filtered_reference_n, sample.command_v]);
                (Some([inputs[1], filtered]), command, &inputs[2..])
            }
            Control::Open(_) => (None, inputs[0], &inputs[2..]),
        };
        let machine = &self.bench.machine;
        Look {
            time_s,
            reference_n: asked_for.map(|[reference, _]| reference),
            filtered_reference_n: asked_for.map(|[_, filtered]| filtered),
            control_v,
            external_force_n: others.get(2).copied().filter(|_| machine.has_external_force()),
            signals: machine.outputs(states, others),
        }
    }
}

impl Observer for Looking<'_> {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        if self.fault.is_some() {
            return;
        }
        let look = self.look(time_s, states, inputs);
        if let Some(table) = self.table.as_mut().filter(|_| self.count.is_multiple_of(self.looks_per_row))
            && let Err(fault) = table.row(&look)
        {
            self.fault = Some(fault);
            self.full.set(true);
        }
        self.record.take(self.count, &look);
        self.looks.take(&look, self.places);
        self.count += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However long a run is, its record is short, evenly spaced, and begins with the first look.
    #[test]
    fn a_record_is_even_and_never_long() {
        let mut record = Record::default();
        let looks = 7 * MOST_KEPT as u64 / 2;
        for number in 0..looks {
            let time_s = number as f64;
            let signals = [time_s; SIGNALS.len()];
            let (reference_n, filtered_reference_n, control_v) = (Some(time_s), Some(time_s), time_s);
            let external_force_n = Some(time_s);
            let look =
                Look { time_s, reference_n, filtered_reference_n, control_v, external_force_n, signals };
            record.take(number, &look);
            assert!(record.times_s.len() <= MOST_KEPT);
        }
        assert_eq!(record.looks_apart, 4);
        let expected: Vec<f64> = (0..looks).step_by(4).map(|number| number as f64).collect();
        assert!(record.times_s == expected && record.control_v == expected);
        assert!(record.signal("force_n") == expected && record.reference_n == expected);
        assert!(record.filtered_reference_n == expected && record.external_force_n == expected);
    }
}
