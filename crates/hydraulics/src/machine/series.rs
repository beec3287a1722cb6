use phea_dynamics::scalar::Scalar;

use super::equations::constant;
use super::{Machine, MachineState, Motion};
use crate::force_sensor;
use crate::series::{ForceFrom, SeriesElement};

/// Which states a series element has. The state `deflection` is that of the force sensor, except
/// where the spring has neither damper nor mass: both carry the same force then, so that one of the
/// deflections gives the other, and the state is that of the spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum SeriesStates {
    /// There is no such element.
    #[default]
    Absent,
    /// Neither damper nor mass: no additional states.
    Spring,
    /// A damper without a mass: the deflection of the spring.
    Damped,
    /// A mass: the deflection of the spring and the velocity of the mass.
    Mass,
}

impl SeriesStates {
    pub(super) fn of<S>(element: Option<&SeriesElement<S>>) -> SeriesStates {
        match element {
            None => SeriesStates::Absent,
            Some(SeriesElement { mass: Some(_), .. }) => SeriesStates::Mass,
            Some(SeriesElement { damping: Some(_), .. }) => SeriesStates::Damped,
            Some(_) => SeriesStates::Spring,
        }
    }
}

/// What connects the rod with the load, at one instant. Units: m, N, m/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint<T> {
    /// Of the piston, x.
    pub(super) position: T,
    /// x - x_m.
    pub(super) sensor_deflection: T,
    /// Through the force sensor.
    pub(super) sensed: T,
    /// On the load.
    pub(super) on_load: T,
    /// Behind the sensor: velocity v_m, that of the load without a series element.
    pub(super) behind_sensor: T,
    /// Of the spring: d and d'; zero without one.
    pub(super) spring: Motion<T>,
    /// Rate of the state `deflection`.
    pub(super) deflection_rate: T,
    /// Rates of the states of a series element.
    pub(super) series_rates: Motion<T>,
}

impl<S: Scalar> Machine<S> {
    /// What connects the rod with its load.
    #[inline(always)]
    pub(super) fn joint<T: Scalar + From<S>>(&self, state: &MachineState<T>, load: &Motion<T>) -> Joint<T> {
        if let Some(series) = &self.series {
            return self.joint_through(series, [state.deflection, state.velocity], &state.series, load);
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

    /// Apart, so that machines without a series element do not carry its code along.
    ///
    /// ```text
    /// spring alone   K_S d_S = F_el(d),  d' (1 + F_el'(d)/K_S) = v - v_L
    /// damper         c d' + ... = K_S d_S - F_f(d),   d_S' = v - v_L - d'
    /// mass           m dv_m/dt = K_S d_S - F_L,   d' = v_m - v_L,   d_S' = v - v_m
    /// ```
    #[inline(never)]
    fn joint_through<T: Scalar + From<S>>(
        &self,
        series: &SeriesElement<S>,
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

    /// The force that is measured, in N: through the sensor, or by the deflection of the spring.
    #[inline(always)]
    pub(super) fn measured_force<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> T {
        match &self.series {
            None => force_sensor::force(constant(self.sensor_stiffness), state.deflection),
            Some(series) => self.measured_through(series, state.deflection, state.series.position),
        }
    }

    #[inline(never)]
    fn measured_through<T: Scalar + From<S>>(
        &self,
        series: &SeriesElement<S>,
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

    /// Typical magnitudes of the deflections of sensor and spring at a force, and of the velocity of
    /// the mass between them.
    pub(super) fn typical_joint(&self, force: S, swing: impl Fn(S) -> S) -> (S, Motion<S>) {
        let sensor = force / self.sensor_stiffness;
        let Some(series) = &self.series else {
            return (sensor, Motion { position: sensor, velocity: sensor });
        };
        let spring = force / series.stiffness;
        let velocity = series.mass.map_or(spring, swing);
        let own = if self.layout.series() == SeriesStates::Spring { spring } else { sensor };
        (own, Motion { position: spring, velocity })
    }
}

impl Machine {
    /// The states of what connects rod and load where it holds a force in N at rest, in motion at a
    /// velocity in m/s; and how far the piston is ahead of the load, in m.
    pub(super) fn held_joint(&self, force: f64, velocity: f64) -> (f64, Motion, f64) {
        let sensor = force / self.sensor_stiffness;
        let Some(series) = &self.series else {
            return (sensor, Motion { position: 0.0, velocity: 0.0 }, sensor);
        };
        let spring = series.deflection_under(force);
        let own = if self.layout.series() == SeriesStates::Spring { spring } else { sensor };
        (own, Motion { position: spring, velocity }, sensor + spring)
    }
}
