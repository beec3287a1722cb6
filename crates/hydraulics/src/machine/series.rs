use phea_dynamics::scalar::{Parameters, Scalar};

use super::equations::constant;
use super::{Machine, MachineState, Motion};
use crate::force_sensor;
use crate::series::{ForceFrom, MovingSeries, OilColumn, SeriesSpring};

/// States of a series element in [`MachineState`]; those of a transmission follow the states of
/// gas. The state `deflection` is that of the force sensor, unless the spring has neither damper
/// nor mass: then both carry the same force, one deflection determines the other, and the state is
/// that of the spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum SeriesStates {
    /// No spring.
    #[default]
    Absent,
    /// Spring with neither damper nor mass: no additional states.
    Spring,
    /// Damper without a mass: the deflection of the spring.
    Damped,
    /// Mass: the deflection of the spring and the velocity of the mass.
    Mass,
}

impl SeriesStates {
    pub(super) fn of<S>(element: Option<&MovingSeries<S>>) -> SeriesStates {
        match element {
            None | Some(MovingSeries::Oil(_)) => SeriesStates::Absent,
            Some(MovingSeries::Spring(SeriesSpring { mass: Some(_), .. })) => SeriesStates::Mass,
            Some(MovingSeries::Spring(SeriesSpring { damping: Some(_), .. })) => SeriesStates::Damped,
            Some(MovingSeries::Spring(_)) => SeriesStates::Spring,
        }
    }
}

/// Joint that holds a force at rest, or in steady motion.
pub(super) struct HeldJoint {
    /// State `deflection`.
    pub(super) deflection: f64,
    /// States of a spring.
    pub(super) series: Motion,
    /// States of a transmission.
    pub(super) columns: Vec<f64>,
    /// Distance of the piston ahead of the load, m.
    pub(super) ahead: f64,
    /// Force on the load, N.
    pub(super) on_load: f64,
}

/// Connection of the rod with the load, at one instant. Units: m, N, m/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint<T> {
    /// Position x of the piston.
    pub(super) position: T,
    /// Sensor deflection x - x_m.
    pub(super) sensor_deflection: T,
    /// Force through the force sensor.
    pub(super) sensed: T,
    /// Force on the load.
    pub(super) on_load: T,
    /// Velocity v_m behind the sensor, that of the load without a series element.
    pub(super) behind_sensor: T,
    /// Deflection d of the spring, or of all oil of a transmission, and its rate; zero without one.
    pub(super) spring: Motion<T>,
    /// Rate of the state `deflection`.
    pub(super) deflection_rate: T,
    /// Rates of the states of a series element.
    pub(super) series_rates: Motion<T>,
}

impl<S: Scalar> Machine<S> {
    /// Connection of the rod with its load, at a state by name and as a vector.
    #[inline(always)]
    pub(super) fn joint<T: Scalar + From<S>>(
        &self,
        state: &MachineState<T>,
        vector: &[T],
        load: &Motion<T>,
    ) -> Joint<T> {
        let own = [state.deflection, state.velocity];
        match &self.series {
            Some(MovingSeries::Spring(spring)) => {
                return self.joint_through(spring, own, &state.series, load);
            }
            Some(MovingSeries::Oil(column)) => {
                return self.joint_through_oil(column, own, self.layout.columns(vector), load);
            }
            None => {}
        }
        let sensed = force_sensor::force(constant(self.sensor_stiffness), state.deflection);
        let zero = T::from(0.0);
        Joint {
            position: load.position + state.deflection,
            sensor_deflection: state.deflection,
            sensed,
            on_load: sensed,
            behind_sensor: load.velocity,
            spring: Motion { position: zero, velocity: zero },
            deflection_rate: state.velocity - load.velocity,
            series_rates: Motion { position: zero, velocity: zero },
        }
    }

    /// Separate function, so that machines without a series element do not contain its code.
    ///
    /// ```text
    /// only a spring  K_S d_S = F_el(d),  d' (1 + F_el'(d)/K_S) = v - v_L
    /// damper         c d' + ... = K_S d_S - F_f(d),   d_S' = v - v_L - d'
    /// mass           m dv_m/dt = K_S d_S - F_L,   d' = v_m - v_L,   d_S' = v - v_m
    /// ```
    #[inline(never)]
    fn joint_through<T: Scalar + From<S>>(
        &self,
        series: &SeriesSpring<S>,
        [own_deflection, velocity]: [T; 2],
        element: &Motion<T>,
        load: &Motion<T>,
    ) -> Joint<T> {
        let series = series.convert(&mut constant::<S, T>);
        let sensor: T = constant(self.sensor_stiffness);
        let (zero, one) = (T::from(0.0), T::from(1.0));
        let closing = velocity - load.velocity;
        if self.layout.series() == SeriesStates::Spring {
            let deflection = own_deflection;
            let sensed = series.elastic_force(deflection);
            let rate = closing / (one + series.elastic_slope(deflection) / sensor);
            return Joint {
                position: load.position + deflection + sensed / sensor,
                sensor_deflection: sensed / sensor,
                sensed,
                on_load: sensed,
                behind_sensor: load.velocity + rate,
                spring: Motion { position: deflection, velocity: rate },
                deflection_rate: rate,
                series_rates: Motion { position: zero, velocity: zero },
            };
        }
        let deflection = element.position;
        let sensed = force_sensor::force(sensor, own_deflection);
        let damping = series.damping.unwrap_or(zero);
        let (rate, on_load, acceleration) = match series.mass {
            None => (series.rate_under(damping, sensed, deflection), sensed, zero),
            Some(mass) => {
                let rate = element.velocity - load.velocity;
                let damped = series.spring_force(deflection) + damping * rate;
                let on_load = damped + series.ends_force(deflection, rate);
                (rate, on_load, (sensed - on_load) / mass)
            }
        };
        Joint {
            position: load.position + deflection + own_deflection,
            sensor_deflection: own_deflection,
            sensed,
            on_load,
            behind_sensor: load.velocity + rate,
            spring: Motion { position: deflection, velocity: rate },
            deflection_rate: closing - rate,
            series_rates: Motion { position: rate, velocity: acceleration },
        }
    }

    /// Joint through a transmission. The first spring carries the force of the sensor, so that both
    /// deform together:
    ///
    /// ```text
    /// k_1 d_1 = K_S d_S,    d_S' (1 + K_S/k_1) = v - u_1
    /// ```
    #[inline(never)]
    fn joint_through_oil<T: Scalar + From<S>>(
        &self,
        column: &OilColumn<S>,
        [own_deflection, velocity]: [T; 2],
        columns: &[T],
        load: &Motion<T>,
    ) -> Joint<T> {
        let column = column.convert(&mut constant::<S, T>);
        let sensor: T = constant(self.sensor_stiffness);
        let one = T::from(1.0);
        let sensed = force_sensor::force(sensor, own_deflection);
        let fraction = sensor / column.end_stiffness;
        let (mut deflection, mut last) = (own_deflection * fraction, T::from(f64::NAN));
        for (_, behind) in plugs(columns) {
            deflection = deflection + behind;
            last = behind;
        }
        let first = columns.first().copied().unwrap_or(T::from(f64::NAN));
        let own_rate = (velocity - first) / (one + fraction);
        let behind_sensor = velocity - own_rate;
        Joint {
            position: load.position + deflection + own_deflection,
            sensor_deflection: own_deflection,
            sensed,
            on_load: column.end_stiffness * last,
            behind_sensor,
            spring: Motion { position: deflection, velocity: behind_sensor - load.velocity },
            deflection_rate: own_rate,
            series_rates: Motion { position: T::from(0.0), velocity: T::from(0.0) },
        }
    }

    /// Rates of the states of a transmission, given the force of the sensor at one end and the
    /// velocity of the load at the other.
    ///
    /// ```text
    /// m du_j/dt = f_j - f_j+1 - b u_j          dd_j+1/dt = u_j - u_j+1,  v_L after the last plug
    /// ```
    #[inline(never)]
    pub(super) fn write_column_rates<T: Scalar + From<S>>(
        &self,
        column: &OilColumn<S>,
        columns: &[T],
        [sensed, load_velocity]: [T; 2],
        rates: &mut [T],
    ) {
        let column = column.convert(&mut constant::<S, T>);
        let velocities = plugs(columns).map(|(velocity, _)| velocity);
        let next = velocities.skip(1).chain([load_velocity]);
        let mut before = sensed;
        let states = plugs(columns).zip(next).enumerate();
        for ((plug, ((velocity, deflection), next)), rates) in states.zip(rates.chunks_exact_mut(2)) {
            let behind = column.stiffness_behind(plug + 1) * deflection;
            let left = before - behind - column.damping * velocity;
            rates.copy_from_slice(&[left / column.mass, velocity - next]);
            before = behind;
        }
    }

    /// Lowest pressure in the oil of a transmission, Pa.
    #[inline(never)]
    pub(super) fn least_oil_pressure<T: Scalar + From<S>>(
        &self,
        column: &OilColumn<S>,
        sensed: T,
        columns: &[T],
    ) -> T {
        let column = column.convert(&mut constant::<S, T>);
        let forces = column.forces(sensed, plugs(columns).map(|(_, deflection)| deflection));
        column.pressure(forces.into_iter().fold(sensed, |least, force| least.minimum(force)))
    }

    /// Measured force, N: through the sensor, or by the deflection of the spring.
    #[inline(always)]
    pub(super) fn measured_force<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        match &self.series {
            None | Some(MovingSeries::Oil(_)) => {
                force_sensor::force(constant(self.sensor_stiffness), state.deflection)
            }
            Some(MovingSeries::Spring(spring)) => {
                self.measured_through(spring, state.deflection, state.series.position)
            }
        }
    }

    #[inline(never)]
    fn measured_through<T: Scalar + From<S>>(
        &self,
        series: &SeriesSpring<S>,
        own_deflection: T,
        of_element: T,
    ) -> T {
        let series = series.convert(&mut constant::<S, T>);
        let alone = self.layout.series() == SeriesStates::Spring;
        let deflection = if alone { own_deflection } else { of_element };
        match series.force_from {
            ForceFrom::Deflection => series.spring_force(deflection),
            ForceFrom::Sensor if alone => series.elastic_force(deflection),
            ForceFrom::Sensor => force_sensor::force(constant(self.sensor_stiffness), own_deflection),
        }
    }

    /// Typical magnitudes of the deflections of sensor and spring at a force, and of the velocity
    /// of the mass between them.
    pub(super) fn typical_joint(&self, force: S, swing: impl Fn(S) -> S) -> (S, Motion<S>) {
        let sensor = force / self.sensor_stiffness;
        let Some(MovingSeries::Spring(series)) = &self.series else {
            return (sensor, Motion { position: sensor, velocity: sensor });
        };
        let spring = force / series.stiffness;
        let velocity = series.mass.map_or(spring, swing);
        let own = if self.layout.series() == SeriesStates::Spring { spring } else { sensor };
        (own, Motion { position: spring, velocity })
    }
}

/// Velocity of each plug of oil and deflection of the spring behind it.
pub(super) fn plugs<T: Copy>(columns: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    columns.chunks_exact(2).map(|pair| (pair[0], pair[1]))
}

impl<S: Scalar> Machine<S> {
    /// Typical magnitudes of the states of a transmission at a force in N, in their order.
    pub(super) fn typical_columns(&self, force: S) -> Vec<S> {
        let Some(MovingSeries::Oil(column)) = &self.series else { return Vec::new() };
        let swing = force / (column.end_stiffness * column.mass).sqrt();
        let of = |plug: usize| [swing, force / column.stiffness_behind(plug + 1)];
        (0..column.segments).flat_map(of).collect()
    }
}

impl Machine {
    /// States of the connection of rod and load with a sensor force in N at rest, or in motion at a
    /// velocity in m/s.
    pub(super) fn held_joint(&self, force: f64, velocity: f64) -> HeldJoint {
        let sensor = force / self.sensor_stiffness;
        let none = Motion { position: 0.0, velocity: 0.0 };
        let joint = |deflection, series, ahead| HeldJoint {
            deflection,
            series,
            columns: Vec::new(),
            ahead,
            on_load: force,
        };
        match &self.series {
            None => joint(sensor, none, sensor),
            Some(MovingSeries::Spring(series)) => {
                let spring = series.deflection_under(force);
                let own = if self.layout.series() == SeriesStates::Spring { spring } else { sensor };
                joint(own, Motion { position: spring, velocity }, sensor + spring)
            }
            Some(MovingSeries::Oil(column)) => {
                let forces = column.steady_forces(force, velocity);
                let deflections: Vec<f64> =
                    forces.iter().enumerate().map(|(j, force)| force / column.stiffness_behind(j)).collect();
                HeldJoint {
                    columns: deflections.iter().skip(1).flat_map(|one| [velocity, *one]).collect(),
                    on_load: forces.last().copied().unwrap_or(f64::NAN),
                    ..joint(sensor, none, sensor + deflections.iter().sum::<f64>())
                }
            }
        }
    }
}
