//! Spring or transmission between force sensor and load in the linear plant.

use phea_dynamics::analytic::Analytic;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};

use super::chambers::ChamberPolynomials;
use super::supply::{Admittance, Over};
use super::{LinearPlant, Paths};
use crate::actuator::Components;
use crate::line::StiffeningMember;
use crate::linear::polynomial::{product, scaled, shifted, sum};
use crate::series::{ForceFrom, MovingSeries, OilColumn, SeriesSpring};

/// Series element for small motions about an operating point.
///
/// For any element, force and displacement at the sensor follow from those at the load by a matrix
/// with determinant one, so that the element is reciprocal:
///
/// ```text
/// F_s = (alpha F_L + beta t X_L)/t,    X_m = (gamma F_L + delta t X_L)/t
/// spring        alpha = t + m s^2/k,   beta = m s^2,   gamma = 1/k,   delta = 1,   t = 1 + c s/k
/// oil           t = 1,   ((alpha, beta), (gamma, delta)) = K_1 M K_2 M ... K_N+1
///               K = ((1, 0), (1/k, 1)) of a spring,   M = ((1, m s^2 + b s), (0, 1)) of a plug
/// ```
///
/// For Q and D of the plant without it, between rod and sensor:
///
/// ```text
/// Delta = Q (alpha + K gamma) + K D alpha,     B = (Q + K D) beta/K + Q delta       K = K_S
/// V Delta F_s = K alpha w^2 N_u U_sp - K t V Q X_L                        through the sensor
/// V Delta F_L = K t w^2 N_u U_sp - K t V B X_L                            on the load
/// F_d = F_L/t                                                             by the deflection of the spring
/// ```
///
/// The load closes the equations in [`LinearPlant::coefficients`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSeries<S = f64> {
    /// Type of element.
    pub element: LinearElement<S>,
    /// Force that is the output of the plant.
    pub output: SeriesOutput,
}

/// Series element for small motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinearElement<S = f64> {
    /// A spring.
    Spring(LinearSpring<S>),
    /// Oil of a transmission, which is linear.
    Oil(OilColumn<S>),
}

/// Series spring for small motions. Units: N/m, N s/m, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSpring<S = f64> {
    /// Stiffness k of the spring at its deflection.
    pub stiffness: S,
    /// Damping c parallel to it; `None` for no damper.
    pub damping: Option<S>,
    /// Mass m between sensor and spring; `None` for no mass.
    pub mass: Option<S>,
}

/// Output force of a plant with a series element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesOutput {
    /// Force through the force sensor.
    Sensor,
    /// Force k times the deflection of the spring.
    Deflection,
    /// Force on the load.
    OnLoad,
}

impl<S: Scalar> LinearSeries<S> {
    /// Spring about the deflection at which it holds a force in N.
    pub fn of_spring(spring: &SeriesSpring<S>, force: S) -> LinearSeries<S> {
        LinearSeries {
            element: LinearElement::Spring(LinearSpring {
                stiffness: spring.stiffness_under(force),
                damping: spring.damping,
                mass: spring.mass,
            }),
            output: match spring.force_from {
                ForceFrom::Sensor => SeriesOutput::Sensor,
                ForceFrom::Deflection => SeriesOutput::Deflection,
            },
        }
    }

    /// Series element of a rig at a held force in N; `None` without one.
    pub fn of_components(components: &Components<S>, force: S) -> Option<LinearSeries<S>> {
        match components.series.as_ref()?.in_motion(&components.fluid, StiffeningMember::Nominal) {
            MovingSeries::Spring(spring) => Some(LinearSeries::of_spring(&spring, force)),
            MovingSeries::Oil(column) => {
                Some(LinearSeries { element: LinearElement::Oil(column), output: SeriesOutput::Sensor })
            }
        }
    }

    /// Stiffness for slow motions, N/m.
    pub fn stiffness(&self) -> S {
        match &self.element {
            LinearElement::Spring(spring) => spring.stiffness,
            LinearElement::Oil(column) => column.stiffness(),
        }
    }

    /// True if it is a spring without mass or damper, which only makes the force sensor softer.
    pub fn is_pure_spring(&self) -> bool {
        let LinearElement::Spring(spring) = &self.element else { return false };
        spring.damping.is_none() && spring.mass.is_none()
    }

    /// Coefficient beta: the force through the sensor that does not reach the load, per unit motion
    /// of the load; `None` if both forces are equal.
    pub fn held_back(&self) -> Option<Vec<S>> {
        match &self.element {
            LinearElement::Spring(spring) => spring.mass.map(|mass| vec![mass, S::from(0.0), S::from(0.0)]),
            LinearElement::Oil(column) => column.matrix(&plug_polynomials(column)).lag,
        }
    }
}

/// Entries of the matrix: t, alpha, beta, K_S gamma and delta, as polynomials or as their values;
/// `None` for a beta of zero and a delta of one.
struct SeriesMatrix<T> {
    tied: T,
    force: T,
    lag: Option<T>,
    yields: T,
    moved: Option<T>,
}

/// Plant on either side of a series element. `driven` is K w^2 N_u, `spool` V, `fed` the
/// contribution of the load's velocity to `driven` per unit of its motion.
struct Between<'a, S, T> {
    chambers: &'a ChamberPolynomials<T>,
    moved: &'a T,
    driven: &'a T,
    spool: &'a T,
    fed: Option<&'a T>,
    sensor: S,
    load: Option<[T; 2]>,
    /// Factor r^2 of a linkage for the force on the load; `None` for one.
    fraction: Option<S>,
}

impl<S: Scalar> LinearSeries<S> {
    /// All paths through the element; `load` has the polynomial of the load and that of its ground.
    fn paths<T: Admittance<S> + Clone>(
        &self,
        matrix: &SeriesMatrix<T>,
        between: &Between<'_, S, T>,
    ) -> Paths<T> {
        let Between { chambers: ChamberPolynomials { own, .. }, moved, driven, spool, sensor, .. } = *between;
        let SeriesMatrix { tied, force: free, lag, yields, moved: carried } = matrix;
        let minus = |value: T| value.by(S::from(-1.0));
        let delta = moved.times(&free.plus(yields)).plus(&own.times(free).by(sensor));
        let held = spool.times(&delta);
        let carried = carried.as_ref().map_or((*moved).clone(), |carried| moved.times(carried));
        let pushed = lag.as_ref().map_or(carried.clone(), |lag| {
            let inert = moved.times(lag).by(S::from(1.0) / sensor);
            carried.plus(&inert).plus(&own.times(lag))
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
                with(minus(spool.times(moved).times(tied).by(sensor)), fed_as(Some(free)))
            }
            SeriesOutput::Deflection => with(by_motion, fed_as(None)),
            SeriesOutput::OnLoad => with(by_motion, fed_as(None)).times(tied),
        };
        let shared = |path: T| match between.fraction {
            Some(fraction) => path.by(fraction),
            None => path,
        };
        let through = shared(driven.times(tied));
        let Some([load, ground_of_load]) = &between.load else {
            let command = match self.output {
                SeriesOutput::Sensor => driven.times(free),
                SeriesOutput::Deflection => (*driven).clone(),
                SeriesOutput::OnLoad => through.clone(),
            };
            return Paths { command, ground, sensed: held.clone(), fed: None, driven: through, held };
        };
        let command = match self.output {
            SeriesOutput::Sensor => {
                let resisted = free.times(load);
                let resisted =
                    lag.as_ref().map_or(resisted.clone(), |lag| resisted.plus(&shared(tied.times(lag))));
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

    /// Matrix as polynomials, for a sensor of this stiffness in N/m.
    fn polynomials(&self, sensor: S) -> SeriesMatrix<Vec<S>> {
        let (one, zero) = (S::from(1.0), S::from(0.0));
        match &self.element {
            LinearElement::Spring(spring) => {
                let tied = spring.damping.map_or(vec![one], |damping| vec![damping / spring.stiffness, one]);
                let scaled = spring.mass.map(|mass| vec![mass / spring.stiffness, zero, zero]);
                SeriesMatrix {
                    force: scaled.map_or(tied.clone(), |scaled| tied.plus(&scaled)),
                    tied,
                    lag: spring.mass.map(|mass| vec![mass, zero, zero]),
                    yields: vec![sensor / spring.stiffness],
                    moved: None,
                }
            }
            LinearElement::Oil(column) => column.matrix(&plug_polynomials(column)).yielding(sensor),
        }
    }
}

/// Polynomials one and m s^2 + b s of an oil column.
fn plug_polynomials<S: Scalar>(column: &OilColumn<S>) -> [Vec<S>; 2] {
    [vec![S::from(1.0)], vec![column.mass, column.damping, S::from(0.0)]]
}

impl<S: Scalar> OilColumn<S> {
    /// Matrix of the oil column, from one and m s^2 + b s, as polynomials or as their values; with
    /// gamma in place of K_S gamma.
    fn matrix<T: Admittance<S> + Clone>(&self, [one, plug]: &[T; 2]) -> SeriesMatrix<T> {
        let spring = |plugs: usize| S::from(1.0) / self.stiffness_behind(plugs);
        // (alpha, beta) and (gamma, delta) of the first spring, then of each plug and the spring
        // behind it
        let (mut force, mut lag) = (one.clone(), one.by(S::from(0.0)));
        let (mut yields, mut moved) = (one.by(spring(0)), one.clone());
        for plugs in 1..=self.segments {
            lag = lag.plus(&force.times(plug));
            moved = moved.plus(&yields.times(plug));
            force = force.plus(&lag.by(spring(plugs)));
            yields = yields.plus(&moved.by(spring(plugs)));
        }
        SeriesMatrix { tied: one.clone(), force, lag: Some(lag), yields, moved: Some(moved) }
    }
}

impl<T> SeriesMatrix<T> {
    /// Matrix for a sensor of this stiffness in N/m.
    fn yielding<S>(self, sensor: S) -> SeriesMatrix<T>
    where
        T: Admittance<S>,
    {
        SeriesMatrix { yields: self.yields.by(sensor), ..self }
    }
}

/// Bounds for the part beyond the force sensor, at one frequency and, decreasing, above it.
pub(super) struct BeyondSensor {
    /// Largest ratio of the velocity there to the force through the sensor, if it reduces the
    /// sensor's own deflection, m/(s N).
    pub(super) yielding: f64,
    /// Largest fraction of that force which reaches the load, and the output of the plant over it.
    pub(super) passed: f64,
    pub(super) output: f64,
}

/// Largest ratio of the force that passes a mass to the force before it, and of the velocity of the
/// mass to that force; from w m, the impedance of the spring behind it, and the mobility behind
/// that. `None` at too low a frequency.
fn beyond_mass(inertia: f64, tied: f64, speed: f64) -> Option<(f64, f64)> {
    let left = 1.0 - tied * speed;
    let yielding = 1.0 / (inertia - tied / left);
    (left > 0.0 && yielding > 0.0).then_some((tied / left * yielding, yielding))
}

impl LinearSeries {
    /// Bounds at a frequency w in rad/s, from displacement and velocity of the load per newton.
    /// `None` if this frequency is too low for them.
    ///
    /// ```text
    /// v_m = Y F_s,   Y = 1/(m s + Z),   1/Z = s/T + Y_L                  F_L = Z Y F_s
    /// without m   Y = s/T + Y_L: spring and damper yield with the sensor, Im (s/T) >= 0, and F_L = F_s
    /// with m      |Z| <= |T/s|/(1 - |T/s| |Y_L|) = Z_0,   |Y| <= 1/(w m - Z_0)
    /// oil         likewise from plug to plug, |m s + b| >= w m; its first spring yields with the sensor
    /// ```
    pub(super) fn beyond_sensor(&self, w: f64, [yielding, speed]: [f64; 2]) -> Option<BeyondSensor> {
        let (passed, yielding) = match &self.element {
            LinearElement::Spring(LinearSpring { mass: None, .. }) => {
                return Some(BeyondSensor { yielding, passed: 1.0, output: 1.0 });
            }
            LinearElement::Spring(LinearSpring { stiffness, damping, mass: Some(mass) }) => {
                let (damping, spring) = (damping.unwrap_or(0.0), stiffness / w);
                beyond_mass(w * mass, (damping * damping + spring * spring).sqrt(), speed)?
            }
            LinearElement::Oil(column) => {
                (1..=column.segments).rev().try_fold((1.0, speed), |(passed, speed), plugs| {
                    let (more, speed) =
                        beyond_mass(w * column.mass, column.stiffness_behind(plugs) / w, speed)?;
                    Some((passed * more, speed))
                })?
            }
        };
        let output = if self.output == SeriesOutput::Sensor { 1.0 } else { passed };
        Some(BeyondSensor { yielding, passed, output })
    }

    /// Frequency in rad/s above all modes of the element on a sensor of this stiffness in N/m;
    /// `None` for an element without modes.
    pub(super) fn fastest_rad_per_s(&self, sensor: f64) -> Option<f64> {
        match &self.element {
            LinearElement::Spring(spring) => Some(((sensor + spring.stiffness) / spring.mass?).sqrt()),
            LinearElement::Oil(column) => Some(column.fastest_rad_per_s()),
        }
    }

    /// Frequency in rad/s below which the resistance of a transmission is less than its springs;
    /// `None` without a transmission.
    pub(super) fn slowest_rad_per_s(&self) -> Option<f64> {
        let LinearElement::Oil(column) = &self.element else { return None };
        let resisted = column.damping * column.segments as f64;
        (resisted > 0.0).then(|| column.stiffness() / resisted)
    }

    /// All numbers of the element: it is passive if none is negative.
    pub(super) fn numbers(&self) -> Vec<f64> {
        match &self.element {
            LinearElement::Spring(spring) => {
                [Some(spring.stiffness), spring.damping, spring.mass].into_iter().flatten().collect()
            }
            LinearElement::Oil(column) => {
                vec![column.end_stiffness, column.inner_stiffness, column.mass, column.damping]
            }
        }
    }

    /// Matrix at s, for a sensor of this stiffness in N/m.
    fn values<A: Analytic>(&self, s: A, sensor: f64) -> SeriesMatrix<Over<A>> {
        let one = A::from(1.0);
        match &self.element {
            LinearElement::Spring(spring) => {
                let tied = spring.damping.map_or(one, |damping| s.scaled(damping / spring.stiffness) + one);
                let inert = |mass: f64| (s * s).scaled(mass);
                let free = spring.mass.map_or(tied, |mass| tied + inert(mass / spring.stiffness));
                SeriesMatrix {
                    tied: Over(tied),
                    force: Over(free),
                    lag: spring.mass.map(|mass| Over(inert(mass))),
                    yields: Over(A::from(sensor / spring.stiffness)),
                    moved: None,
                }
            }
            LinearElement::Oil(column) => {
                let plug = (s * s).scaled(column.mass) + s.scaled(column.damping);
                column.matrix(&[Over(one), Over(plug)]).yielding(sensor)
            }
        }
    }

    /// Paths of a plant without polynomials at s; `driven` includes the spool.
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
            fraction: terms.and_then(|terms| terms.fraction),
        };
        let Paths { command, ground, sensed, fed, driven, held } =
            self.paths(&self.values(s, plant.sensor_stiffness), &between);
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
    /// Coefficients as in [`LinearPlant::coefficients`] with a series element. `driven` is K w^2
    /// N_u, `moved` Q.
    pub(super) fn coefficients_through(
        &self,
        series: &LinearSeries<S>,
        chambers: &ChamberPolynomials<Vec<S>>,
        [moved, driven, spool]: [Vec<S>; 3],
    ) -> PlantCoefficients<S> {
        let shows = &self.velocity_sensor;
        let fed = self.load_velocity_feed_forward.map(|gain| shows.shown(shifted(&scaled(gain, &driven))));
        // the filter of the velocity that is fed forward, if there is one: d_v times every other
        // path
        let filtered =
            |path: &Vec<S>| if fed.is_some() { shows.filtered(path.clone()) } else { path.clone() };
        let matrix = series.polynomials(self.sensor_stiffness);
        let paths = |[driven, spool]: [&Vec<S>; 2], load: Option<[Vec<S>; 2]>| {
            let (moved, fed, sensor) = (&moved, fed.as_ref(), self.sensor_stiffness);
            let fraction = self.load.terms().and_then(|terms| terms.fraction);
            series.paths(&matrix, &Between { chambers, moved, driven, spool, fed, sensor, load, fraction })
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
                    // measured rate of X_0 itself
                    rate: disturbance.map(|disturbance| RateNumerators {
                        command: vec![S::from(0.0)],
                        disturbance,
                        inner: None,
                    }),
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
