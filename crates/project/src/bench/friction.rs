//! `[bench.friction]`: runs of the cylinder that its friction is identified from.

use crate::key::{key, plain};
use crate::visitor::Visitor;
use phea_quantity::{ANGULAR_FREQUENCY, FORCE, LENGTH, RATIO, TIME, VELOCITY};

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
    /// m, steps in which the position is read; zero: none.
    pub position_resolution: f64,
    /// The run that shakes the piston on its bristles.
    pub shaken: ShakenFriction,
}

/// A force of several frequencies, below the static friction, that repeats: the mass rings on its
/// bristles, and their damping shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShakenFriction {
    /// N, greatest force; absent: a third of the static friction.
    pub force: Option<f64>,
    /// rad/s, lowest and highest frequency; absent: around that at which the mass rings.
    pub frequencies: Option<[f64; 2]>,
    /// How many frequencies, at most.
    pub lines: u32,
    /// s, after which the force repeats.
    pub period: f64,
    /// How many periods are recorded.
    pub periods: u32,
    /// s, between two rows.
    pub sample_time: f64,
}

impl Default for ShakenFriction {
    fn default() -> ShakenFriction {
        ShakenFriction {
            force: None,
            frequencies: None,
            lines: 12,
            period: 0.05,
            periods: 20,
            sample_time: 2e-4,
        }
    }
}

impl ShakenFriction {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let usual = ShakenFriction::default();
        let k = key("force", &FORCE, "Greatest force; absent: a third of the static friction.");
        v.optional(k.positive(), &mut self.force);
        let doc = "Lowest and highest frequency; absent: 0.4 and 1.7 times that at which the mass rings on its bristles.";
        v.pair(key("frequencies", &ANGULAR_FREQUENCY, doc).positive(), &mut self.frequencies);
        let k = key("lines", &RATIO, "How many frequencies, at most, multiples of that of the period.");
        v.count(k.at_least(1.0).at_most(40.0).or(f64::from(usual.lines)), &mut self.lines);
        let k = key("period", &TIME, "Time after which the force repeats.").positive().at_most(1e4);
        v.quantity(k.or(usual.period), &mut self.period);
        let k = key("periods", &RATIO, "How many periods are recorded; one more goes before.").at_least(3.0);
        v.count(k.at_most(1e4).or(f64::from(usual.periods)), &mut self.periods);
        let k = key("sample_time", &TIME, "Time between two rows of the shaken piston.").at_least(1e-6);
        v.quantity(k.at_most(1.0).or(usual.sample_time), &mut self.sample_time);
    }
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
            position_resolution: 0.0,
            shaken: ShakenFriction::default(),
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
        let k = key("position_resolution", &LENGTH, "Steps in which the position is read; 0: none.");
        v.quantity(k.not_negative().or(0.0), &mut self.position_resolution);
        self.visit_shaken(v);
    }
    fn visit_shaken<V: Visitor>(&mut self, v: &mut V) {
        let doc = "A force of several frequencies, below the static friction, that shakes the piston.";
        let usual = ShakenFriction::default();
        let mut shaken = Some(self.shaken).filter(|shaken| *shaken != usual);
        v.table(plain("shaken", doc), &mut shaken, ShakenFriction::visit);
        self.shaken = shaken.unwrap_or(usual);
    }
}
