//! Observer of a run: adds each sample to the table and each step to the metrics, and records
//! samples for figures.

use std::cell::{Cell, RefCell};

use phea_dynamics::simulation::{Attention, Observer, Stretch};
use phea_machine::{Control, ControllerSample, ControllerSamples};

use super::adjusted::{AdjustmentWatch, AdjustmentWork};
use super::bench::ControlledMachine;
use super::columns::SignalParts;
use super::divergence::Divergence;
use super::exceeded::{Exceeded, LimitWatch};
use super::files::RunTable;
use super::follower::Follower;
use super::gas::{GasRange, GasWatch};
use super::ledgers::{LedgerWatch, NoLedger, RunLedger};
use super::line_limits::LineWatch;
use super::measured::{Measurement, Overlay, Overlaying};
use super::prepared_scenario::PreparedScenario;
use super::record::{ControlSignals, Record, Sample};
use super::sum::SignalSum;
use super::sums;
use super::{Metrics, SimulateError};
use crate::source::WriteError;

/// The observations of a run.
pub(super) struct Sighted<'t> {
    pub(super) record: Record,
    /// Metrics of each window.
    pub(super) metrics: Vec<Metrics>,
    pub(super) divergence: Option<Divergence>,
    /// The table with all rows, not yet named.
    pub(super) table: Option<RunTable<'t>>,
    /// Force at some hundreds of samples, N.
    pub(super) force_n: Vec<f64>,
    /// Highest pressures of chambers A and B, Pa.
    pub(super) peak_pressures_pa: [f64; 2],
    pub(super) measured: Vec<Overlay>,
    /// Limits of the rig that the run exceeds.
    pub(super) exceeded: Vec<Exceeded>,
    pub(super) adjustment: Option<AdjustmentWork>,
    /// Ranges of the chambers with gas.
    pub(super) gas: Vec<GasRange>,
    /// Balances of oil and energy, or the reason why they are absent.
    pub(super) ledger: Result<RunLedger, NoLedger>,
}

/// Signals of the controller at one time.
struct LoopOutput {
    /// Reference and filtered reference, N; `None` in an open loop.
    requested: Option<[f64; 2]>,
    /// Output of the controller, V.
    control_v: f64,
    others: ControlSignals,
}

/// Number of samples at which the force is recorded for comparison.
const FORCES: f64 = 500.0;

/// Observer of a machine and its controller.
pub(super) struct RunObserver<'a, 't> {
    bench: &'a ControlledMachine,
    /// The last output of a sampled controller.
    samples: &'a RefCell<ControllerSamples>,
    /// Indices of all states.
    wanted: Vec<usize>,
    /// Number of samples so far.
    count: u64,
    samples_per_row: u64,
    table: Option<RunTable<'t>>,
    /// Recorded samples; `None` if none are recorded.
    record: Option<Record>,
    limits: LimitWatch,
    lines: LineWatch,
    adjustment: Option<AdjustmentWatch>,
    gas: Vec<GasWatch>,
    /// Balances of oil and energy; `None` if they are not requested.
    ledger: Option<LedgerWatch>,
    follower: Follower<'a>,
    /// Pressures of chambers A and B; in `peak_pressures_pa` the highest so far, Pa.
    pressures: [SignalSum<'a>; 2],
    peak_pressures_pa: [f64; 2],
    overlays: Vec<Overlaying<'a>>,
    /// Detail in which the steps are evaluated.
    attention: Attention,
    /// Number of samples between two recorded forces; in `force_n` those forces, N.
    apart: u64,
    force_n: Vec<f64>,
    prepared: &'a PreparedScenario,
    /// The error of the table, if it accepts no more rows.
    full: &'a Cell<bool>,
    fault: Option<WriteError>,
}

impl<'a, 't> RunObserver<'a, 't> {
    pub(super) fn new(
        bench: &'a ControlledMachine,
        samples: &'a RefCell<ControllerSamples>,
        (table, samples_per_row): (Option<RunTable<'t>>, usize),
        measurements: &'a [Measurement],
        full: &'a Cell<bool>,
        (prepared, band, duration_s): (&'a PreparedScenario, f64, f64),
    ) -> RunObserver<'a, 't> {
        let [states, _] = bench.control.size();
        let wanted: Vec<usize> = (0..states).collect();
        let windows = (prepared.windows.as_slice(), band, duration_s);
        let follower = Follower::of(bench, &wanted, samples, &prepared.reference, windows);
        let pressures = sums::pressures(bench, &wanted);
        let gas = GasWatch::of(bench, &wanted);
        let limits = LimitWatch::of(bench);
        let lines = LineWatch::of(bench, &wanted);
        let parts = SignalParts::of(bench);
        RunObserver {
            bench,
            samples,
            wanted,
            count: 0,
            samples_per_row: samples_per_row as u64,
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
            attention: Attention::Everything,
            apart: 1,
            force_n: Vec::new(),
            prepared,
            full,
            fault: None,
        }
    }

    /// Sets the detail in which steps are evaluated, and records some hundreds of values of the
    /// force out of about `looks` samples.
    pub(super) fn following(self, attention: Attention, looks: f64) -> RunObserver<'a, 't> {
        RunObserver { attention, apart: (looks / FORCES).ceil().max(1.0) as u64, ..self }
    }

    /// Records the samples, of which there are about `looks`.
    pub(super) fn keeping(mut self, looks: f64) -> RunObserver<'a, 't> {
        self.record.get_or_insert_default().reserve(looks as usize);
        self
    }

    /// Omits the limits of lines.
    pub(super) fn without_line_limits(mut self) -> RunObserver<'a, 't> {
        self.lines = LineWatch::default();
        self
    }

    /// Records the balances of oil and energy.
    pub(super) fn accounting(mut self) -> RunObserver<'a, 't> {
        self.ledger = Some(LedgerWatch::of(self.bench));
        self
    }

    /// The observations.
    ///
    /// # Errors
    /// [`SimulateError::Write`] if a row could not be written.
    pub(super) fn finish(self) -> Result<Sighted<'t>, SimulateError> {
        if let Some(fault) = self.fault {
            return Err(SimulateError::Write(fault));
        }
        let measured = self.overlays.into_iter().map(Overlaying::finish).collect();
        let metrics = self.follower.metrics();
        Ok(Sighted {
            divergence: self.follower.divergence(&self.prepared.other_inputs()),
            table: self.table,
            force_n: self.force_n,
            record: self.record.unwrap_or_default(),
            metrics,
            peak_pressures_pa: self.peak_pressures_pa,
            measured,
            exceeded: self.limits.finish().into_iter().chain(self.lines.found()).collect(),
            adjustment: self.adjustment.map(AdjustmentWatch::finish),
            gas: self.gas.into_iter().filter_map(GasWatch::finish).collect(),
            ledger: self.ledger.map_or(Err(NoLedger::NotRequested), LedgerWatch::finish),
        })
    }

    /// True if any observer needs the signals of the machine.
    fn needs_signals(&self) -> bool {
        self.table.is_some()
            || self.record.is_some()
            || !self.overlays.is_empty()
            || self.limits.wants_signals()
    }

    /// Signals and output of the controller, and the inputs of the machine without those of the
    /// controller.
    fn loop_sample<'i>(&self, states: &[f64], inputs: &'i [f64]) -> (LoopOutput, &'i [f64]) {
        let (requested, control_v, mut signals, others) = match &self.bench.control {
            Control::Continuous(closed) => {
                let signals = closed.signals::<f64, f64>(states, inputs);
                let (arriving, integral) =
                    (closed.arriving_command(states, inputs), closed.integral_part(states));
                let others = ControlSignals {
                    command_v: arriving,
                    unlimited_v: signals.wanted,
                    integral_v: integral,
                    measurement_n: signals.measurement,
                    virtual_force_n: 0.0,
                };
                (Some([inputs[0], signals.filtered_reference]), signals.command, others, &inputs[1..])
            }
            Control::Sampled(_) => {
                let last = self.samples.borrow().last;
                let of_sample = |number: fn(&ControllerSample) -> f64| last.as_ref().map_or(0.0, number);
                let others = ControlSignals {
                    command_v: inputs[0],
                    unlimited_v: of_sample(|sample| sample.unlimited_v),
                    integral_v: of_sample(|sample| sample.integral_v),
                    measurement_n: of_sample(|sample| sample.measurement_n),
                    virtual_force_n: 0.0,
                };
                let filtered = of_sample(|sample| sample.filtered_reference_n);
                (Some([inputs[1], filtered]), of_sample(|sample| sample.command_v), others, &inputs[2..])
            }
            Control::Open(held) => {
                let [_, measured, _] = held.sampled::<f64, f64>(states, inputs);
                let others = ControlSignals {
                    command_v: inputs[0],
                    unlimited_v: inputs[0],
                    measurement_n: measured,
                    ..ControlSignals::default()
                };
                (None, inputs[0], others, &inputs[2..])
            }
        };
        signals.virtual_force_n = self.bench.control.sensed().given_way::<f64, f64>(states, others);
        (LoopOutput { requested, control_v, others: signals }, others)
    }

    fn sample(&self, time_s: f64, of_loop: LoopOutput, states: &[f64], others: &[f64]) -> Sample {
        let LoopOutput { requested, control_v, others: control } = of_loop;
        let machine = &self.bench.machine;
        Sample {
            time_s,
            reference_n: requested.map(|[reference, _]| reference),
            filtered_reference_n: requested.map(|[_, filtered]| filtered),
            control_v,
            external_force_n: others.get(2).copied().filter(|_| machine.has_external_force()),
            machine: machine.signals(states, others),
            control,
        }
    }
}

impl Observer for RunObserver<'_, '_> {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        if self.fault.is_some() {
            return;
        }
        let (of_loop, others) = self.loop_sample(states, inputs);
        self.limits.take_loop(time_s, of_loop.requested.map(|[reference, _]| reference), of_loop.control_v);
        if self.count.is_multiple_of(self.apart) {
            self.force_n.push(self.follower.force_n(states));
        }
        if !self.needs_signals() {
            self.count += 1;
            return;
        }
        let sample = self.sample(time_s, of_loop, states, others);
        self.limits.take_signals(time_s, &sample.machine);
        if let Some(table) = self.table.as_mut().filter(|_| self.count.is_multiple_of(self.samples_per_row))
            && let Err(fault) = table.row(&sample)
        {
            self.fault = Some(fault);
            self.full.set(true);
        }
        if let Some(record) = &mut self.record {
            record.take(self.count, &sample);
        }
        for overlay in &mut self.overlays {
            overlay.take(&sample);
        }
        self.count += 1;
    }

    fn attention(&self) -> Attention {
        self.attention
    }

    fn needs_accurate_solution(&self, stretch: &Stretch<'_>) -> bool {
        self.follower.needs_accurate_solution(stretch)
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
