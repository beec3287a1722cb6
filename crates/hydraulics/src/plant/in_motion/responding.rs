//! What robust design asks of a plant without polynomials.

use num_complex::Complex64;
use phea_dynamics::analytic::{Disc, Jet};
use phea_dynamics::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::super::{ChamberDynamics, LinearLoad, Plant};
use super::PlantInMotion;

/// How far below the slowest and above the fastest thing of a plant its response is its own.
const BELOW: f64 = 0.01;
const ABOVE_SPOOL: f64 = 20.0;
const ABOVE_QUARTER_WAVE: f64 = 40.0;

impl RespondingPlant for PlantInMotion {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        self.response(Complex64::new(0.0, frequency_rad_per_s))
    }

    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc {
        Jet::enclosed(Disc::of_frequencies(frequencies_rad_per_s), |s| {
            let [command, _] = self.response(s);
            command
        })
    }

    /// The rig at rest: lines pass flow through their steady resistance R, and have yielded all that they ever do.
    ///
    /// ```text
    /// p_port = p + R q,   q = K_q U - K_c p_port      so that q = K_q/(1 + K_c R) U - K_c/(1 + K_c R) p
    /// ```
    fn slow(&self) -> PlantCoefficients<f64> {
        let of = |value: fn(&super::Side) -> f64| [value(&self.sides[0]), value(&self.sides[1])];
        let passing = |side: &super::Side| 1.0 + side.flow_pressure * side.line.resistance();
        let slow = [passing(&self.sides[0]), passing(&self.sides[1])];
        let over = |values: [f64; 2]| [values[0] / slow[0], values[1] / slow[1]];
        let chambers = ChamberDynamics::TwoPressures {
            areas: of(|side| side.area),
            compliances: of(|side| {
                side.compliance - side.line.chamber_compliance() + side.line.static_compliance()
            }),
            flow_gains: over(of(|side| side.flow_gain)),
            flow_pressures: over(of(|side| side.flow_pressure)),
        };
        Plant { chambers, ..self.plant }.coefficients()
    }

    /// Nothing behind the valve gives energy, so that no more reaches the piston than a source with the conductance K_c can give, and the
    /// piston moves no faster than its friction spends that:
    ///
    /// ```text
    /// f_v |v|^2 <= (K_qA^2/K_cA + K_qB^2/K_cB)/4 |U_sp|^2
    /// F_e = K_e (x_C - x_L) = v/(s/K_e + Y_L)                     Y_L: velocity of the load over its force
    /// |P(jw)| <= |v/U_sp| w_n^2/(w^2 - w_n^2) / (w/K_e - w/(M_L w^2 - K_L))       each factor falls from where it is positive
    /// ```
    fn roll_off(&self, frequency_rad_per_s: f64) -> Option<f64> {
        let friction = self.plant.viscous_friction;
        let given: f64 = self
            .sides
            .iter()
            .filter(|side| side.flow_gain != 0.0)
            .map(|side| side.flow_gain * side.flow_gain / (4.0 * side.flow_pressure))
            .sum();
        let velocity = (given / friction).sqrt();
        let w = frequency_rad_per_s;
        let natural = self.plant.valve_natural_frequency;
        let spool = natural * natural / (w * w - natural * natural);
        let yielding = match self.plant.load {
            LinearLoad::Yielding { mass, stiffness, .. } if mass > 0.0 => w / (mass * w * w - stiffness),
            LinearLoad::Yielding { .. } | LinearLoad::Prescribed => 0.0,
        };
        let held = w / self.plant.sensor_stiffness - yielding;
        let bound = velocity * spool / held;
        let falls = spool > 0.0 && held > 0.0 && yielding >= 0.0;
        (self.is_passive() && falls && bound.is_finite()).then_some(bound)
    }

    fn range_rad_per_s(&self) -> [f64; 2] {
        let slowest = self.sides.iter().map(|side| {
            let line = side.line.static_compliance() - side.line.chamber_compliance();
            (side.flow_pressure + self.plant.internal_leakage) / (side.compliance + line)
        });
        let slowest = slowest.fold(f64::INFINITY, f64::min).min(self.plant.valve_natural_frequency);
        let quarter_wave = self.quarter_wave_rad_per_s().unwrap_or(0.0);
        let modes = self.sides.iter().map(|side| side.line.fastest_rad_per_s());
        let fastest = modes.fold(ABOVE_QUARTER_WAVE * quarter_wave, f64::max);
        let fastest = fastest.max(ABOVE_SPOOL * self.plant.valve_natural_frequency);
        let slowest = if slowest > 0.0 { slowest } else { self.plant.valve_natural_frequency };
        [BELOW * slowest, fastest]
    }

    fn echo_s(&self) -> f64 {
        let delays = self.sides.iter().flat_map(|side| side.line.delays());
        2.0 * delays.fold(0.0, f64::max)
    }
}
