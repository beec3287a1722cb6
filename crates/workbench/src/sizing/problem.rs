use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::line::{Hose, Line, Member};
use phea_hydraulics::stiffness::{StiffnessModel, StrokeStiffness, chamber_compliance};

use super::Decision;
use crate::answer::significant;

/// What the procedure needs to know, every value resolved. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SizingProblem {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// Useful piston area A_u, m2.
    pub useful_area: f64,
    /// Bulk modulus of the fluid beta_0, Pa.
    pub fluid_modulus: f64,
    /// Density of the fluid, kg/m3.
    pub density: f64,
    /// Stiffness K_S of load cell and environment, N/m.
    pub sensor_stiffness: f64,
    /// Flow gain K_qU at null, m3/(s V).
    pub flow_gain: f64,
    /// Flow-pressure coefficient K_c at null, m3/(s Pa).
    pub flow_pressure_coefficient: f64,
    /// The largest K_c of the project's uncertainty, where it states one.
    pub flow_pressure_coefficient_maximum: Option<f64>,
    /// Desired closed-loop time constant tau_d, s.
    pub time_constant: f64,
    /// Where tau_d comes from, in words.
    pub time_constant_origin: String,
    /// Largest flow through the hose, m3/s.
    pub maximum_flow: f64,
    /// What limits the flow, in words.
    pub maximum_flow_origin: String,
    /// Recommended oil velocities, lowest and highest, m/s.
    pub oil_velocity: [f64; 2],
    /// The least proportional gain that is practical, V/N.
    pub minimum_gain: f64,
    /// Hose that can be had, for both lines together, m.
    pub stock_length: Option<f64>,
    /// Acceptable length of each line, m.
    pub hose_length: [f64; 2],
    /// Supply pressure, Pa.
    pub supply_pressure: f64,
    /// The stiffness model the project declares.
    pub model: StiffnessModel,
    /// The hoses to choose from.
    pub hoses: Vec<HoseOption>,
    /// Bores on the market beside those of the hoses, with their names, m.
    pub market_bores: Vec<(String, f64)>,
}

/// A hose of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct HoseOption {
    /// Name in the catalogue.
    pub name: String,
    /// Its bore, expansion and stiffening.
    pub hose: Hose,
    /// Working pressure, Pa, where known.
    pub working_pressure: Option<f64>,
    /// Minimum bend radius, m, where known.
    pub minimum_bend_radius: Option<f64>,
}

impl SizingProblem {
    /// Hydraulic stiffness that gives the desired time constant under gain K_p, N/m; infinite or negative below the
    /// pole, where no transmission is stiff enough.
    ///
    /// ```text
    /// K_H = K_S A_u^2 / (K_S tau_d (K_c0 + A_u K_p K_qU) - A_u^2)                               thesis (6.16)
    /// ```
    pub fn stiffness_for_gain(&self, gain: f64) -> f64 {
        let area_squared = self.useful_area * self.useful_area;
        let flow = self.flow_pressure_coefficient + self.useful_area * gain * self.flow_gain;
        self.sensor_stiffness * area_squared
            / (self.sensor_stiffness * self.time_constant * flow - area_squared)
    }

    /// Gain that gives the desired time constant at hydraulic stiffness K_H, V/N.
    ///
    /// ```text
    /// K_p = (A_u (K_H + K_S)/(tau_d K_H K_S) - K_c0/A_u) / K_qU                                 thesis (6.27)
    /// ```
    pub fn gain_for_stiffness(&self, stiffness: f64) -> f64 {
        let equivalent = stiffness * self.sensor_stiffness / (stiffness + self.sensor_stiffness);
        let loss = self.flow_pressure_coefficient / self.useful_area;
        (self.useful_area / (self.time_constant * equivalent) - loss) / self.flow_gain
    }

    /// The gain at which equation 6.16 has its pole, V/N: the limit of equation 6.27 for an infinite K_H.
    pub fn pole_gain(&self) -> f64 {
        let loss = self.flow_pressure_coefficient / self.useful_area;
        (self.useful_area / (self.time_constant * self.sensor_stiffness) - loss) / self.flow_gain
    }

    /// Time constant of the first-order closed loop at this stiffness and gain, s.
    ///
    /// ```text
    /// tau = A_u^2 / (K_eq (K_c + A_u K_p K_qU)),  K_eq = K_H K_S/(K_H + K_S)                    thesis (6.14)
    /// ```
    pub fn closed_loop_time_constant(
        &self,
        stiffness: f64,
        gain: f64,
        flow_pressure_coefficient: f64,
    ) -> f64 {
        let equivalent = stiffness * self.sensor_stiffness / (stiffness + self.sensor_stiffness);
        let flow = flow_pressure_coefficient + self.useful_area * gain * self.flow_gain;
        self.useful_area * self.useful_area / (equivalent * flow)
    }

    /// Steady-state gain K_SS of the closed loop, which equation 6.16 drops.
    ///
    /// ```text
    /// K_SS = A_u K_p K_qU / (K_c + A_u K_p K_qU)                                                thesis (6.15)
    /// ```
    pub fn steady_state_gain(&self, gain: f64, flow_pressure_coefficient: f64) -> f64 {
        let flow = self.useful_area * gain * self.flow_gain;
        flow / (flow_pressure_coefficient + flow)
    }

    /// Stiffness over the stroke with a hose of this length on each side.
    pub fn stroke_stiffness(&self, hose: Hose, length: f64, model: StiffnessModel) -> StrokeStiffness {
        let line = Line::Hose { hose, length };
        chamber_compliance(model, self.fluid_modulus, &self.cylinder, [&line, &line], Member::Nominal)
            .over_stroke()
    }

    /// Length of each line when the stock is shared, or the longest acceptable one, whichever is shorter, m.
    pub fn available_length(&self) -> f64 {
        let longest = self.hose_length[1];
        self.stock_length.map_or(longest, |stock| longest.min(stock / 2.0))
    }

    pub(super) fn decisions(&self) -> Vec<Decision> {
        let number = |value| significant(value, 4);
        vec![
            Decision {
                step: "a",
                text: format!(
                    "System data: A_u = {} m2, stroke {} m, beta_0 = {} Pa, K_S = {} N/m, K_qU = {} m3/(s V), K_c0 = {} m3/(s Pa).",
                    number(self.useful_area),
                    number(self.cylinder.stroke),
                    number(self.fluid_modulus),
                    number(self.sensor_stiffness),
                    number(self.flow_gain),
                    number(self.flow_pressure_coefficient)
                ),
            },
            Decision {
                step: "b",
                text: format!(
                    "Time constant tau_d = {} s: {}.",
                    number(self.time_constant),
                    self.time_constant_origin
                ),
            },
        ]
    }
}
