//! The observer of a run: each sample goes into the table, each step into the metrics, and a record
//! is kept for figures.

use std::cell::{Cell, RefCell};

use phea_dynamics::simulation::{Attention, Observer, Stretch};
use phea_machine::{Control, ControllerSample, ControllerSamples};

use super::adjusted::{AdjustmentWatch, AdjustmentWork};
use super::bench::ControlledMachine;
use super::columns::LOOP_SIGNALS;
use super::course::PreparedScenario;
use super::exceeded::{Exceeded, LimitWatch};
use super::files::RunTable;
use super::follower::Follower;
use super::gas::{GasRange, GasWatch};
use super::ledgers::{LedgerWatch, NOT_REQUESTED, RunLedger};
use super::line_limits::LineWatch;
use super::measured::{Measurement, Overlay, Overlaying};
use super::parts::SignalParts;
use super::record::{Look, Record};
use super::sum::SignalSum;
use super::sums;
use super::{Metrics, SimulateError};
use crate::source::WriteError;

/// The observations of a run.
pub(super) struct Sighted {
    pub(super) record: Record,
    /// Metrics of each window.
    pub(super) metrics: Vec<Metrics>,
    /// Highest pressures of chambers A and B, Pa.
    pub(super) peak_pressures_pa: [f64; 2],
    pub(super) measured: Vec<Overlay>,
    /// The limits of the rig that it exceeds.
    pub(super) exceeded: Vec<Exceeded>,
    pub(super) adjustment: Option<AdjustmentWork>,
    /// Ranges of the chambers with gas.
    pub(super) gas: Vec<GasRange>,
    /// The accounts of oil and energy, or why there are none.
    pub(super) ledger: Result<RunLedger, &'static str>,
}

/// The controller at one time.
struct LoopLook {
    /// Reference and filtered reference in N; `None` in an open loop.
    asked_for: Option<[f64; 2]>,
    /// V, output of the controller.
    control_v: f64,
    /// In the order of [`LOOP_SIGNALS`].
    of_loop: [f64; LOOP_SIGNALS.len()],
}

/// Observes a machine and its controller.
pub(super) struct Looking<'a> {
    bench: &'a ControlledMachine,
    /// The last output of a sampled controller.
    samples: &'a RefCell<ControllerSamples>,
    /// All states.
    wanted: Vec<usize>,
    /// Looks so far.
    count: u64,
    looks_per_row: u64,
    table: Option<RunTable<'a>>,
    /// `None` where no samples are kept.
    record: Option<Record>,
    limits: LimitWatch,
    lines: LineWatch,
    adjustment: Option<AdjustmentWatch>,
    gas: Vec<GasWatch>,
    /// `None` where it is not asked for.
    ledger: Option<LedgerWatch>,
    follower: Follower<'a>,
    /// Pressures of chambers A and B; below, the highest so far, Pa.
    pressures: [SignalSum<'a>; 2],
    peak_pressures_pa: [f64; 2],
    overlays: Vec<Overlaying<'a>>,
    /// The error of the table, if it accepts no more rows.
    full: &'a Cell<bool>,
    fault: Option<WriteError>,
}

impl<'a> Looking<'a> {
    pub(super) fn new(
        bench: &'a ControlledMachine,
        samples: &'a RefCell<ControllerSamples>,
        (table, looks_per_row): (Option<RunTable<'a>>, usize),
        measurements: &'a [Measurement],
        full: &'a Cell<bool>,
        (course, band): (&'a PreparedScenario, f64),
    ) -> Looking<'a> {
        let [states, _] = bench.control.size();
        let wanted: Vec<usize> = (0..states).collect();
        let windows = (course.windows.as_slice(), band);
        let follower = Follower::of(bench, &wanted, samples, &course.reference, windows);
        let pressures = sums::pressures(bench, &wanted);
        let gas = GasWatch::of(bench, &wanted);
        let limits = LimitWatch::of(bench);
        let lines = LineWatch::of(bench, &wanted);
        let parts = SignalParts::of(bench);
        Looking {
            bench,
            samples,
            wanted,
            count: 0,
            looks_per_row: looks_per_row as u64,
            table,
            record: None,
            limits,
            lines,
            adjustment: AdjustmentWatch::of(bench),
            gas,
            ledger: None,
            follower,
            pressures,
            peak_pressures_pa: [f64::NEG_INFINITY; 2],
            overlays: measurements.iter().map(|one| Overlaying::new(one, &parts)).collect(),
            full,
            fault: None,
        }
    }

    /// The same, with a record of its samples, about as many as this.
    pub(super) fn keeping(mut self, looks: f64) -> Looking<'a> {
        self.record.get_or_insert_default().reserve(looks as usize);
        self
    }

    /// The same, with the accounts of oil and energy.
    pub(super) fn accounting(mut self) -> Looking<'a> {
        self.ledger = Some(LedgerWatch::of(self.bench));
        self
    }

    /// The observations, with the table finished.
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
        Ok(Sighted {
            record: self.record.unwrap_or_default(),
            metrics,
            peak_pressures_pa: self.peak_pressures_pa,
            measured,
            exceeded: self.limits.finish().into_iter().chain(self.lines.found()).collect(),
            adjustment: self.adjustment.map(AdjustmentWatch::finish),
            gas: self.gas.into_iter().filter_map(GasWatch::finish).collect(),
            ledger: self.ledger.map_or(Err(NOT_REQUESTED), LedgerWatch::finish),
        })
    }

    /// Whether anything takes the signals of the machine.
    fn needs_signals(&self) -> bool {
        self.table.is_some()
            || self.record.is_some()
            || !self.overlays.is_empty()
            || self.limits.wants_signals()
    }

    /// What the controller sees and gives out, and the inputs of the machine alone.
    fn loop_look<'i>(&self, states: &[f64], inputs: &'i [f64]) -> (LoopLook, &'i [f64]) {
        let (asked_for, control_v, mut of_loop, others) = match &self.bench.control {
            Control::Continuous(closed) => {
                let signals = closed.signals::<f64, f64>(states, inputs);
                let (arriving, integral) =
                    (closed.arriving_command(states, inputs), closed.integral_part(states));
                let of_loop = [arriving, signals.wanted, integral, signals.measurement, 0.0];
                (Some([inputs[0], signals.filtered_reference]), signals.command, of_loop, &inputs[1..])
            }
            Control::Sampled(_) => {
                let last = self.samples.borrow().last;
                let of_sample = |number: fn(&ControllerSample) -> f64| last.as_ref().map_or(0.0, number);
                let of_loop = [
                    inputs[0],
                    of_sample(|sample| sample.unlimited_v),
                    of_sample(|sample| sample.integral_v),
                    of_sample(|sample| sample.measurement_n),
                    0.0,
                ];
                let filtered = of_sample(|sample| sample.filtered_reference_n);
                (Some([inputs[1], filtered]), of_sample(|sample| sample.command_v), of_loop, &inputs[2..])
            }
            Control::Open(held) => {
                let [_, measured] = held.sampled::<f64, f64>(states, inputs);
                (None, inputs[0], [inputs[0], inputs[0], 0.0, measured, 0.0], &inputs[2..])
            }
        };
        let [.., virtual_force] = &mut of_loop;
        *virtual_force = self.bench.control.sensed().given_way::<f64, f64>(states, others);
        (LoopLook { asked_for, control_v, of_loop }, others)
    }

    fn look(&self, time_s: f64, of_loop: LoopLook, states: &[f64], others: &[f64]) -> Look {
        let LoopLook { asked_for, control_v, of_loop } = of_loop;
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
        let (of_loop, others) = self.loop_look(states, inputs);
        self.limits.take_loop(time_s, of_loop.asked_for.map(|[reference, _]| reference), of_loop.control_v);
        if !self.needs_signals() {
            self.count += 1;
            return;
        }
        let look = self.look(time_s, of_loop, states, others);
        self.limits.take_signals(time_s, &look.signals);
        if let Some(table) = self.table.as_mut().filter(|_| self.count.is_multiple_of(self.looks_per_row))
            && let Err(fault) = table.row(&look)
        {
            self.fault = Some(fault);
            self.full.set(true);
        }
        if let Some(record) = &mut self.record {
            record.take(self.count, &look);
        }
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
        self.lines.follow(stretch);
        self.gas.iter_mut().for_each(|gas| gas.follow(stretch));
        if let Some(ledger) = &mut self.ledger {
            ledger.follow(self.bench, stretch);
        }
        if let Some(adjustment) = &mut self.adjustment {
            adjustment.follow(self.bench, stretch);
        }
        for (sum, peak) in self.pressures.iter().zip(&mut self.peak_pressures_pa) {
            let pressure = sum.over(stretch.states);
            if pressure.bounds()[1] > *peak {
                *peak = peak.max(pressure.extremes([0.0, 1.0])[1]);
            }
        }
    }
}
