//! Who follows the loop of a bench.

use std::cell::RefCell;

use phea_dynamics::simulation::Profile;
use phea_machine::{Control, ControllerSamples};

use super::Window;
use super::bench::ControlledMachine;
use super::follower::{CommandSource, Follower};
use super::sums;

impl<'a> Follower<'a> {
    /// Of the loop of a bench whose observer wants these states, in windows in the order of their
    /// starts; the band of settling times in percent.
    pub fn of(
        bench: &'a ControlledMachine,
        wanted: &[usize],
        samples: &'a RefCell<ControllerSamples>,
        reference: &'a Profile,
        (windows, band): (&[Window], f64),
    ) -> Follower<'a> {
        let commanded = match &bench.control {
            Control::Continuous(closed) => {
                CommandSource::Continuously(sums::command(bench, wanted), closed.limit())
            }
            Control::Open(_) => CommandSource::Continuously(sums::command(bench, wanted), f64::INFINITY),
            Control::Sampled(_) => CommandSource::Sampled(samples),
        };
        let reference = if matches!(bench.control, Control::Open(_)) { None } else { Some(reference) };
        let [_, inputs] = bench.control.size();
        Follower::new(sums::force(bench, wanted), commanded, inputs, reference, (windows, band))
    }
}
