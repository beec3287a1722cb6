//! What is seen of a run on the way: each look goes into the table, each step into the metrics, and a course is kept for figures.

use std::cell::{Cell, RefCell};

use phea_dynamics::simulation::{Attention, Observer, Stretch};
use phea_hydraulics::machine::SIGNALS;

use super::bench::{Bench, Control};
use super::columns::{self, LOOP_SIGNALS};
use super::course::Course;
use super::digital::{Sample, Samples};
use super::files::Table;
use super::follower::Follower;
use super::measured::{Measurement, Overlay, Overlaying};
use super::sums::{self, Sum};
use super::{Metrics, SimulateError};
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
    /// What the control loop tells of itself, in the order of [`LOOP_SIGNALS`]; in an open loop what is commanded, and nothing that integrates.
    pub of_loop: [f64; LOOP_SIGNALS.len()],
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
    /// What the control loop tells of itself, each in the order of [`LOOP_SIGNALS`].
    pub of_loop: Vec<[f64; LOOP_SIGNALS.len()]>,
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
            of_loop: vec![],
            looks_apart: 1,
        }
    }
}

impl Record {
    /// A column of the table over time; empty for a name that is none.
    pub fn signal(&self, name: &str) -> Vec<f64> {
        columns::signal(self, name)
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

/// What was seen of a run.
pub(super) struct Sighted {
    pub(super) record: Record,
    /// Of each window.
    pub(super) metrics: Vec<Metrics>,
    /// Highest pressures of chambers A and B, Pa.
    pub(super) peak_pressures_pa: [f64; 2],
    pub(super) measured: Vec<Overlay>,
}

/// Looks at a machine and its controller.
pub(super) struct Looking<'a> {
    bench: &'a Bench,
    /// What a sampled controller did last.
    samples: &'a RefCell<Samples>,
    /// All states.
    wanted: Vec<usize>,
    /// Looks so far.
    count: u64,
    looks_per_row: u64,
    table: Option<Table<'a>>,
    record: Record,
    follower: Follower<'a>,
    /// Of chambers A and B, and the highest so far, Pa.
    pressures: [Sum; 2],
    peak_pressures_pa: [f64; 2],
    overlays: Vec<Overlaying<'a>>,
    /// Whether the table takes no more, and why.
    full: &'a Cell<bool>,
    fault: Option<WriteError>,
}

impl<'a> Looking<'a> {
    pub(super) fn new(
        bench: &'a Bench,
        samples: &'a RefCell<Samples>,
        (table, looks_per_row): (Option<Table<'a>>, usize),
        measurements: &'a [Measurement],
        full: &'a Cell<bool>,
        (course, band): (&'a Course, f64),
    ) -> Looking<'a> {
        let [states, _] = sums::size(&bench.control);
        let wanted: Vec<usize> = (0..states).collect();
        let windows = (course.windows.as_slice(), band);
        let follower = Follower::of(bench, &wanted, samples, &course.reference, windows);
        let pressures = sums::pressures(bench, &wanted);
        Looking {
            bench,
            samples,
            wanted,
            count: 0,
            looks_per_row: looks_per_row as u64,
            table,
            record: Record::default(),
            follower,
            pressures,
            peak_pressures_pa: [f64::NEG_INFINITY; 2],
            overlays: measurements.iter().map(Overlaying::new).collect(),
            full,
            fault: None,
        }
    }

    /// What was seen, its table finished.
    ///
    /// # Errors
    /// [`SimulateError::Write`] where a row could not be written.
    pub(super) fn finish(self) -> Result<Sighted, SimulateError> {
        if let Some(fault) = self.fault {
            return Err(SimulateError::Write(fault));
        }
        if let Some(table) = self.table {
            table.finish().map_err(SimulateError::Write)?;
        }
        let measured = self.overlays.into_iter().map(Overlaying::finish).collect();
        let metrics = self.follower.metrics();
        Ok(Sighted { record: self.record, metrics, peak_pressures_pa: self.peak_pressures_pa, measured })
    }

    fn look(&self, time_s: f64, states: &[f64], inputs: &[f64]) -> Look {
        let (asked_for, control_v, of_loop, others) = match &self.bench.control {
            Control::Continuous(closed) => {
                let signals = closed.signals::<f64, f64>(states, inputs);
                let (arriving, integral) =
                    (closed.arriving_command(states, inputs), closed.integral_part(states));
                let of_loop = [arriving, signals.wanted, integral, signals.measurement];
                (Some([inputs[0], signals.filtered_reference]), signals.command, of_loop, &inputs[1..])
            }
            Control::Sampled(_) => {
                let last = self.samples.borrow().last;
                let of_sample = |number: fn(&Sample) -> f64| last.as_ref().map_or(0.0, number);
                let of_loop = [
                    inputs[0],
                    of_sample(|sample| sample.unlimited_v),
                    of_sample(|sample| sample.integral_v),
                    of_sample(|sample| sample.measurement_n),
                ];
                let filtered = of_sample(|sample| sample.filtered_reference_n);
                (Some([inputs[1], filtered]), of_sample(|sample| sample.command_v), of_loop, &inputs[2..])
            }
            Control::Open(held) => {
                let [_, measured] = held.sampled::<f64, f64>(states, inputs);
                (None, inputs[0], [inputs[0], inputs[0], 0.0, measured], &inputs[2..])
            }
        };
        let machine = &self.bench.machine;
        Look {
            time_s,
            reference_n: asked_for.map(|[reference, _]| reference),
            filtered_reference_n: asked_for.map(|[_, filtered]| filtered),
            control_v,
            external_force_n: others.get(2).copied().filter(|_| machine.has_external_force()),
            signals: machine.outputs(states, others),
            of_loop,
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
        for overlay in &mut self.overlays {
            overlay.take(&look);
        }
        self.count += 1;
    }

    fn attention(&self) -> Attention {
        Attention::Everything
    }

    fn follow(&mut self, stretch: &Stretch<'_>) {
        self.follower.follow(stretch);
        for (sum, peak) in self.pressures.iter().zip(&mut self.peak_pressures_pa) {
            let pressure = sum.over(stretch.states);
            if pressure.bounds()[1] > *peak {
                *peak = peak.max(pressure.extremes([0.0, 1.0])[1]);
            }
        }
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
