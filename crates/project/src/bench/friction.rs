//! `[bench.friction]`: runs of the cylinder that its friction is identified from.

use crate::key::key;
use crate::visitor::Visitor;
use phea_quantity::{FORCE, LENGTH, RATIO, TIME, VELOCITY};

/// The runs, and the instrument of the position; the pressures are measured as in the other tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionBench {
    /// m/s, of the slowest run at a constant velocity.
    pub slowest: f64,
    /// m/s, of the fastest.
    pub fastest: f64,
    /// How many velocities there are, each both ways.
    pub velocities: u32,
    /// s, that a velocity is kept.
    pub run_time: f64,
    /// s, from one velocity to the next.
    pub change_time: f64,
    /// s, in which the force rises from zero to its peak.
    pub ramp_time: f64,
    /// N, greatest force; absent: 1.3 times the static friction.
    pub peak_force: Option<f64>,
    /// How often a part of the static friction is put on slowly and let go quickly before the ramp.
    pub releases: u32,
    /// s, in which it is let go.
    pub release_time: f64,
    /// s, between two rows.
    pub sample_time: f64,
    /// m, root mean square of the noise of the position.
    pub position_noise: f64,
}

impl Default for FrictionBench {
    fn default() -> FrictionBench {
        FrictionBench {
            slowest: 5e-4,
            fastest: 0.1,
            velocities: 12,
            run_time: 0.5,
            change_time: 0.05,
            ramp_time: 0.5,
            peak_force: None,
            releases: 0,
            release_time: 3e-3,
            sample_time: 1e-3,
            position_noise: 1e-6,
        }
    }
}

impl FrictionBench {
    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("slowest", &VELOCITY, "Velocity of the slowest run.").positive().or(5e-4);
        v.quantity(k, &mut self.slowest);
        let k = key("fastest", &VELOCITY, "Velocity of the fastest run.").positive().or(0.1);
        v.quantity(k, &mut self.fastest);
        let k = key("velocities", &RATIO, "How many velocities there are, in equal ratios, each both ways.");
        v.count(k.at_least(1.0).at_most(100.0).or(12.0), &mut self.velocities);
        let k = key("run_time", &TIME, "How long each velocity is kept.").positive().at_most(1e4).or(0.5);
        v.quantity(k, &mut self.run_time);
        let k = key("change_time", &TIME, "Time from one velocity to the next, in a straight line.");
        v.quantity(k.positive().at_most(1e4).or(0.05), &mut self.change_time);
        let k = key("ramp_time", &TIME, "Time in which the force rises from zero to its peak.");
        v.quantity(k.positive().at_most(1e4).or(0.5), &mut self.ramp_time);
        let k = key("peak_force", &FORCE, "Greatest force; absent: 1.3 times the static friction.");
        v.optional(k.positive(), &mut self.peak_force);
        let k = key(
            "releases",
            &RATIO,
            "How often 70 % of the static friction is put on slowly and let go quickly before the ramp.",
        );
        v.count(k.not_negative().at_most(100.0).or(0.0), &mut self.releases);
        let k = key("release_time", &TIME, "Time in which it is let go.").positive().at_most(10.0).or(3e-3);
        v.quantity(k, &mut self.release_time);
        let k = key("sample_time", &TIME, "Time between two rows.").at_least(1e-5).at_most(10.0).or(1e-3);
        v.quantity(k, &mut self.sample_time);
        let k = key("position_noise", &LENGTH, "Root mean square of the noise of the position.");
        v.quantity(k.not_negative().or(1e-6), &mut self.position_noise);
    }
}
