//! Follower for the loop of a bench.

use std::cell::RefCell;

use phea_dynamics::simulation::Profile;
use phea_machine::{Control, ControllerSamples};

use super::Window;
use super::bench::ControlledMachine;
use super::divergence::DivergenceWatch;
use super::follower::{CommandSource, Follower};
use super::sums;
use crate::project::Scenario;

/// Windows of a run in which its metrics are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct MetricWindows<'a> {
    /// Windows in the order of their starts.
    windows: &'a [Window],
    /// Band of settling times, percent.
    band_percent: f64,
    /// Duration of the run, s.
    duration_s: f64,
}

impl<'a> MetricWindows<'a> {
    /// Windows in the order of their starts, of a run of this scenario.
    pub(crate) fn of(windows: &'a [Window], scenario: &Scenario) -> MetricWindows<'a> {
        let (band_percent, duration_s) = (scenario.settling_band_percent, scenario.duration);
        MetricWindows { windows, band_percent, duration_s }
    }
}

impl<'a> Follower<'a> {
    /// Follower for the loop of a bench whose observer needs these states.
    pub fn of(
        bench: &'a ControlledMachine,
        wanted: &[usize],
        samples: &'a RefCell<ControllerSamples>,
        reference: &'a Profile,
        metric_windows: MetricWindows<'_>,
    ) -> Follower<'a> {
        let MetricWindows { windows, band_percent, duration_s } = metric_windows;
        let commanded = match &bench.control {
            Control::Continuous(closed) => {
                CommandSource::Continuously(sums::command(bench, wanted), closed.limit())
            }
            Control::Open(_) => CommandSource::Continuously(sums::command(bench, wanted), f64::INFINITY),
            Control::Sampled(_) => CommandSource::Sampled(samples),
        };
        let reference = if matches!(bench.control, Control::Open(_)) { None } else { Some(reference) };
        let [_, inputs] = bench.control.size();
        let range_v = bench.rig.actuator.components().valve.nominal_voltage.min(limit(bench));
        let watch = DivergenceWatch::new(range_v, duration_s, windows);
        Follower::new(sums::force(bench, wanted), commanded, inputs, reference, windows, band_percent)
            .watching(watch)
    }
}

/// Largest magnitude of the command, V.
fn limit(bench: &ControlledMachine) -> f64 {
    match &bench.control {
        Control::Continuous(closed) | Control::Open(closed) => closed.limit(),
        Control::Sampled(sampled) => sampled.command_limit,
    }
}
