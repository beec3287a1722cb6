use phea_dynamics::scalar::Scalar;

use super::super::laminar_friction::UNSTEADY_FRICTION;
use super::{Creep, Segments};

/// Content of a line, without the capacity that belongs to its chamber.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineContent<T> {
    /// Volume taken up since zero gauge pressure, m3.
    pub(crate) oil: T,
    /// Energy, J.
    pub(crate) energy: T,
    /// Dissipation into heat, W.
    pub(crate) heat: T,
}

impl<S: Scalar> Segments<S> {
    /// Content of the line at a chamber pressure in Pa.
    ///
    /// ```text
    /// capacity   C p             C p^2/2                                      each but that of the chamber
    /// wall       C_r w           C_r w^2/2            C_r (p - w)^2/theta     a spring behind its damper
    /// plug       0               I q^2/2              R q^2
    /// friction   0               (4 m/n) I u^2/2      4 m (nu/R^2) I (q - u)^2     each lag an inertance parallel to a resistance
    /// ```
    ///
    /// A line is linear and passes on volumes, so that these squares are exact. In steady flow plug
    /// and lags together hold 4/3 of I q^2/2, the kinetic energy of Poiseuille's parabola.
    pub(crate) fn content<T: Scalar + From<S>>(&self, chamber_pressure: T, state: &[T]) -> LineContent<T> {
        let (zero, half) = (<T as From<f64>>::from(0.0), <T as From<f64>>::from(0.5));
        let segments = <T as From<f64>>::from(self.count.max(1) as f64);
        let part = |whole: S| <T as From<S>>::from(whole) / segments;
        let (pressures, rest) = state.split_at(self.count);
        let (flows, rest) = rest.split_at(self.count);
        let (walls, lags) = rest.split_at(self.creeping());
        let mut content = LineContent { oil: zero, energy: zero, heat: zero };
        for (node, pressure) in pressures.iter().enumerate() {
            let capacity = part(self.compliance) * if node == 0 { half } else { <T as From<f64>>::from(1.0) };
            content.oil = content.oil + capacity * *pressure;
            content.energy = content.energy + half * capacity * pressure.squared();
        }
        for flow in flows {
            content.energy = content.energy + half * part(self.inertance) * flow.squared();
            content.heat = content.heat + part(self.resistance) * flow.squared();
        }
        for (flow, lagging) in flows.iter().zip(lags.chunks(UNSTEADY_FRICTION.len())) {
            for (behind, (corner, weight)) in lagging.iter().zip(UNSTEADY_FRICTION) {
                let inertance = part(self.inertance) * <T as From<f64>>::from(4.0 * weight / corner);
                let rate = <T as From<S>>::from(self.viscous_rate) * <T as From<f64>>::from(corner);
                content.energy = content.energy + half * inertance * behind.squared();
                content.heat = content.heat + inertance * rate * (*flow - *behind).squared();
            }
        }
        if let Some(Creep { compliance, retardation_time }) = self.creep {
            for (node, (wall, pressure)) in
                walls.iter().zip(pressures.iter().chain([&chamber_pressure])).enumerate()
            {
                let at_end = self.count > 0 && (node == 0 || node == self.count);
                let capacity = part(compliance) * if at_end { half } else { <T as From<f64>>::from(1.0) };
                let behind = *pressure - *wall;
                content.oil = content.oil + capacity * *wall;
                content.energy = content.energy + half * capacity * wall.squared();
                content.heat =
                    content.heat + capacity * behind.squared() / <T as From<S>>::from(retardation_time);
            }
        }
        content
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Conduit, LaminarFriction};
    use super::*;

    /// The kinetic energy of a parabolic profile, which is not a condition of the fit: half of rho
    /// times the integral of v^2 is 4/3 of that of a plug.
    #[test]
    fn steady_flow_has_the_energy_of_a_parabola() {
        let conduit = Conduit {
            length: 1.5,
            bore: 12.7e-3,
            density: 870.0,
            kinematic_viscosity: 46e-6,
            effective_bulk_modulus: 2.609e8,
        };
        let line = Segments::new(&conduit, 5, LaminarFriction::FrequencyDependent).unwrap();
        let flow = 2e-4;
        let [moving, still] = [flow, 0.0].map(|flow| {
            let mut state = line.steady_state(35e5, flow);
            state[..5].fill(0.0);
            line.content(35e5, &state)
        });
        let plug = 0.5 * conduit.inertance() * flow * flow;
        assert!((moving.energy / plug - 4.0 / 3.0).abs() < 3e-3);
        assert!((moving.heat / (conduit.steady_resistance() * flow * flow) - 1.0).abs() < 1e-12);
        assert_eq!([still.energy, still.heat, still.oil], [0.0; 3]);
    }
}
