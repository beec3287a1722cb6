//! Table `[bench.friction]`: runs of the cylinder from which its friction is identified.

use phea_quantity::{ANGULAR_FREQUENCY, FORCE, LENGTH, RATIO, TIME, VELOCITY};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Runs, and the instrument of the position; the pressures are measured as in the other tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionBench {
    /// Lowest constant velocity, m/s.
    pub slowest: f64,
    /// Highest constant velocity, m/s.
    pub fastest: f64,
    /// Number of velocities, each in both directions.
    pub velocities: u32,
    /// Duration of a run at one velocity, s.
    pub run_time: f64,
    /// Time of the change from one velocity to the next, s.
    pub change_time: f64,
    /// Time in which the force rises from zero to its peak, s.
    pub ramp_time: f64,
    /// Greatest force, N; if absent, 1.3 times the static friction.
    pub peak_force: Option<f64>,
    /// Number of releases before the ramp: part of the static friction is applied slowly and
    /// released quickly.
    pub releases: u32,
    /// Time of a release, s.
    pub release_time: f64,
    /// Time between two rows, s.
    pub sample_time: f64,
    /// Root mean square of the noise of the position, m.
    pub position_noise: f64,
    /// Resolution of the position, m; zero for none.
    pub position_resolution: f64,
    /// Run that shakes the piston on its bristles.
    pub shaken: ShakenFriction,
}

/// Periodic force of several frequencies, below the static friction: the mass rings on its
/// bristles, which reveals their damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShakenFriction {
    /// Greatest force, N; if absent, a third of the static friction.
    pub force: Option<f64>,
    /// Lowest and highest frequency, rad/s; if absent, around the ringing frequency of the mass.
    pub frequencies: Option<[f64; 2]>,
    /// Largest number of frequencies.
    pub lines: u32,
    /// Period of the force, s.
    pub period: f64,
    /// Number of recorded periods.
    pub periods: u32,
    /// Time between two rows, s.
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
