//! The spring between force sensor and load in the linear plant.

use phea_dynamics::analytic::Analytic;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};

use super::supply::{Admittance, Over};
use super::{ChamberPolynomials, LinearPlant, Paths};
use crate::linear::polynomial::{product, scaled, shifted, sum};
use crate::series::{ForceFrom, SeriesElement};

/// A series element for small motions about an operating point. Units: N/m, N s/m, kg.
///
/// ```text
/// T = c s + k,   mu = m s^2,   K = K_S,   E = mu + T + K                  spring, mass and sensor
/// Delta = Q E + D K (mu + T),   B = (mu + K) Q + D K mu                   Q and D of the plant without it
/// V Delta F_s = K (mu + T) w^2 N_u U_sp - K T V Q X_L                     through the sensor
/// V Delta F_L = K T w^2 N_u U_sp - T V B X_L                              on the load
/// F_d = k/T F_L                                                           by the deflection of the spring
/// ```
///
/// [`LinearPlant::coefficients`] closes them with the load. Everything is divided by k, so that the
/// equations of a rigid spring are those without one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSeries<S = f64> {
    /// Stiffness k of the spring there.
    pub stiffness: S,
    /// Damping c beside it; `None` for no damper.
    pub damping: Option<S>,
    /// Mass m between sensor and spring; `None` for no mass.
    pub mass: Option<S>,
    /// Which force is the output of the plant.
    pub output: SeriesOutput,
}

/// The force that a plant with a series element gives out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesOutput {
    /// Through the force sensor.
    Sensor,
    /// k times the deflection of the spring.
    Deflection,
    /// On the load: through spring and damper.
    OnLoad,
}

impl<S: Scalar> LinearSeries<S> {
    /// The element about the deflection at which it holds a force in N.
    pub fn new(element: &SeriesElement<S>, force: S) -> LinearSeries<S> {
        LinearSeries {
            stiffness: element.stiffness_under(force),
            damping: element.damping,
            mass: element.mass,
            output: match element.force_from {
                ForceFrom::Sensor => SeriesOutput::Sensor,
                ForceFrom::Deflection => SeriesOutput::Deflection,
            },
        }
    }
}

/// T/k, mu and mu/k and one, as polynomials or as their values.
struct Terms<T> {
    one: T,
    tied: T,
    inertia: Option<[T; 2]>,
}

/// What a series element is between. `driven` is K w^2 N_u, `spool` V, `fed` what the velocity of
/// the load adds to `driven` for a unit of its motion.
struct Between<'a, S, T> {
    chambers: &'a ChamberPolynomials<T>,
    moved: &'a T,
    driven: &'a T,
    spool: &'a T,
    fed: Option<&'a T>,
    sensor: S,
    load: Option<[T; 2]>,
    /// Of a linkage, r^2 by which the force on the load counts there; `None` for one.
    share: Option<S>,
}

impl<S: Scalar> LinearSeries<S> {
    /// All paths through the element, divided by k; `load` is its own polynomial and that of its
    /// ground.
    fn paths<T: Admittance<S> + Clone>(&self, terms: &Terms<T>, between: &Between<'_, S, T>) -> Paths<T> {
        let Between { chambers: ChamberPolynomials { own, .. }, moved, driven, spool, sensor, .. } = *between;
        let Terms { one, tied, inertia } = terms;
        let minus = |value: T| value.by(S::from(-1.0));
        let free = inertia.as_ref().map_or(tied.clone(), |[_, scaled]| tied.plus(scaled));
        let all = free.plus(&one.by(sensor / self.stiffness));
        let delta = moved.times(&all).plus(&own.times(&free).by(sensor));
        let held = spool.times(&delta);
        let pushed = inertia.as_ref().map_or((*moved).clone(), |[inertia, _]| {
            let inert = moved.times(inertia).by(S::from(1.0) / sensor);
            moved.plus(&inert).plus(&own.times(inertia))
        });
        let fed_as = |factor: Option<&T>| match (between.fed, factor) {
            (Some(fed), Some(factor)) => Some(fed.times(factor)),
            (Some(fed), None) => Some((*fed).clone()),
            (None, _) => None,
        };
        let with = |path: T, fed: Option<T>| fed.map_or(path.clone(), |fed| path.plus(&fed));
        let by_motion = minus(spool.times(&pushed).by(sensor));
        let ground = match self.output {
            SeriesOutput::Sensor => {
                with(minus(spool.times(moved).times(tied).by(sensor)), fed_as(Some(&free)))
            }
            SeriesOutput::Deflection => with(by_motion, fed_as(None)),
            SeriesOutput::OnLoad => with(by_motion, fed_as(None)).times(tied),
        };
        let shared = |path: T| match between.share {
            Some(share) => path.by(share),
            None => path,
        };
        let through = shared(driven.times(tied));
        let Some([load, ground_of_load]) = &between.load else {
            let command = match self.output {
                SeriesOutput::Sensor => driven.times(&free),
                SeriesOutput::Deflection => (*driven).clone(),
                SeriesOutput::OnLoad => through.clone(),
            };
            return Paths { command, ground, sensed: held.clone(), fed: None, driven: through, held };
        };
        let command = match self.output {
            SeriesOutput::Sensor => {
                let resisted = free.times(load);
                let resisted = inertia
                    .as_ref()
                    .map_or(resisted.clone(), |[mu, _]| resisted.plus(&shared(tied.times(mu))));
                driven.times(&resisted)
            }
            SeriesOutput::Deflection => driven.times(load),
            SeriesOutput::OnLoad => driven.times(tied).times(load),
        };
        let reached = shared(spool.times(&pushed).times(tied).by(sensor));
        Paths {
            command,
            ground: ground.times(ground_of_load),
            sensed: held.times(load).plus(&reached),
            fed: fed_as(Some(tied)).map(shared),
            driven: through,
            held,
        }
    }

    fn polynomials(&self) -> Terms<Vec<S>> {
        let (one, zero) = (S::from(1.0), S::from(0.0));
        Terms {
            one: vec![one],
            tied: self.damping.map_or(vec![one], |damping| vec![damping / self.stiffness, one]),
            inertia: self.mass.map(|mass| [vec![mass, zero, zero], vec![mass / self.stiffness, zero, zero]]),
        }
    }
}

/// What lies beyond the force sensor, at one frequency and, falling, above it.
pub(super) struct BeyondSensor {
    /// At most the velocity there over the force through the sensor, where it makes the sensor's own
    /// deflection less, in m/(s N).
    pub(super) yielding: f64,
    /// At most the share of that force which reaches the load, and the output of the plant over it.
    pub(super) passed: f64,
    pub(super) output: f64,
}

impl LinearSeries {
    /// Bounds at a frequency w in rad/s; of the load, displacement and velocity per newton. `None`
    /// where this frequency is too low for them.
    ///
    /// ```text
    /// v_m = Y F_s,   Y = 1/(m s + Z),   1/Z = s/T + Y_L                  F_L = Z Y F_s
    /// without m   Y = s/T + Y_L: spring and damper yield with the sensor, Im (s/T) >= 0, and F_L = F_s
    /// with m      |Z| <= |T/s|/(1 - |T/s| |Y_L|) = Z_0,   |Y| <= 1/(w m - Z_0)
    /// ```
    pub(super) fn beyond_sensor(&self, w: f64, [yielding, speed]: [f64; 2]) -> Option<BeyondSensor> {
        let Some(mass) = self.mass else { return Some(BeyondSensor { yielding, passed: 1.0, output: 1.0 }) };
        let damping = self.damping.unwrap_or(0.0);
        let tied = {
            let spring = self.stiffness / w;
            (damping * damping + spring * spring).sqrt()
        };
        let left = 1.0 - tied * speed;
        let yielding = 1.0 / (w * mass - tied / left);
        let passed = tied / left * yielding;
        let output = if self.output == SeriesOutput::Sensor { 1.0 } else { passed };
        (left > 0.0 && yielding > 0.0).then_some(BeyondSensor { yielding, passed, output })
    }

    fn values<A: Analytic>(&self, s: A) -> Terms<Over<A>> {
        let one = A::from(1.0);
        let tied = self.damping.map_or(one, |damping| s.scaled(damping / self.stiffness) + one);
        let inertia =
            self.mass.map(|mass| [mass, mass / self.stiffness].map(|mass| Over((s * s).scaled(mass))));
        Terms { one: Over(one), tied: Over(tied), inertia }
    }

    /// The paths of a plant without polynomials at s; `driven` includes the spool.
    pub(super) fn responding<A: Analytic>(
        &self,
        plant: &LinearPlant,
        s: A,
        chambers: ChamberPolynomials<A>,
        [moved, driven, fed]: [A; 3],
    ) -> Paths<A> {
        let ChamberPolynomials { own, driven: by_spool, displaced } = chambers;
        let chambers =
            ChamberPolynomials { own: Over(own), driven: Over(by_spool), displaced: Over(displaced) };
        let terms = plant.load.terms();
        let load = terms.map(|terms| terms.at(s).map(Over));
        let fed = plant.load_velocity_feed_forward.map(|_| Over(fed));
        let between = Between {
            chambers: &chambers,
            moved: &Over(moved),
            driven: &Over(driven),
            spool: &Over(A::from(1.0)),
            fed: fed.as_ref(),
            sensor: plant.sensor_stiffness,
            load,
            share: terms.and_then(|terms| terms.share),
        };
        let Paths { command, ground, sensed, fed, driven, held } = self.paths(&self.values(s), &between);
        Paths {
            command: command.0,
            ground: ground.0,
            sensed: sensed.0,
            fed: fed.map(|fed| fed.0),
            driven: driven.0,
            held: held.0,
        }
    }
}

impl<S: Scalar> LinearPlant<S> {
    /// [`LinearPlant::coefficients`] with a series element. `driven` is K w^2 N_u, `moved` Q.
    pub(super) fn coefficients_through(
        &self,
        series: &LinearSeries<S>,
        chambers: &ChamberPolynomials<Vec<S>>,
        [moved, driven, spool]: [Vec<S>; 3],
    ) -> PlantCoefficients<S> {
        let shows = &self.velocity_sensor;
        let fed = self.load_velocity_feed_forward.map(|gain| shows.shown(shifted(&scaled(gain, &driven))));
        // the filter of the velocity that is fed forward, where one is: d_v times every path but that
        let filtered =
            |path: &Vec<S>| if fed.is_some() { shows.filtered(path.clone()) } else { path.clone() };
        let terms = series.polynomials();
        let paths = |[driven, spool]: [&Vec<S>; 2], load: Option<[Vec<S>; 2]>| {
            let (moved, fed, sensor) = (&moved, fed.as_ref(), self.sensor_stiffness);
            let share = self.load.terms().and_then(|terms| terms.share);
            series.paths(&terms, &Between { chambers, moved, driven, spool, fed, sensor, load, share })
        };
        let behind_filter = [filtered(&driven), filtered(&spool)];
        let behind_filter = [&behind_filter[0], &behind_filter[1]];
        match self.load.terms() {
            None => {
                let Paths { command, held, .. } = paths([&driven, &spool], None);
                let Paths { ground, held: denominator, .. } = paths(behind_filter, None);
                let disturbance = shows.gain.map(|gain| shifted(&scaled(gain, &held)));
                PlantCoefficients {
                    command: RationalCoefficients { numerator: command, denominator: held },
                    disturbance: Some(self.beside_motion(ground, denominator)),
                    dead_time_s: S::from(0.0),
                    // what is shown of the rate of X_0 itself
                    rate: disturbance
                        .map(|disturbance| RateNumerators { command: vec![S::from(0.0)], disturbance }),
                }
            }
            Some(terms) => {
                let of_ground = terms.ground.to_vec();
                let load = Some([terms.own().to_vec(), of_ground.clone()]);
                let Paths { command, ground, sensed, fed, driven, held } = paths(behind_filter, load);
                let denominator =
                    fed.map_or(sensed.clone(), |fed| sum(&sensed, &scaled(S::from(-1.0), &fed)));
                let moved = [driven, product(&held, &of_ground)];
                self.of_yielding_load([command, ground], moved, denominator)
            }
        }
    }
}
