//! Table `[linear]`: the linear model's parameters.

use phea_quantity::{
    ANGULAR_FREQUENCY, AREA, DAMPING, FLOW_GAIN, FLOW_PRESSURE_COEFFICIENT, MASS, RATIO, STIFFNESS,
};
use phea_table::Visitor;
use phea_table::{Key, key};

/// Parameters of the linear model that are stated directly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    /// Viscous friction f_v, N·s/m.
    pub viscous_friction: Option<f64>,
    /// Flow gain K_qU, m³/(s·V).
    pub flow_gain: Option<f64>,
    /// Flow-pressure coefficient K_c, m³/(s·Pa).
    pub flow_pressure_coefficient: Option<f64>,
    /// Hydraulic stiffness K_H, N/m.
    pub hydraulic_stiffness: Option<f64>,
    /// Natural frequency of the valve, rad/s.
    pub valve_natural_frequency: Option<f64>,
    /// Damping ratio ξ_v.
    pub valve_damping_ratio: Option<f64>,
    /// Moving mass M, kg.
    pub moving_mass: Option<f64>,
    /// Piston area A_u, m².
    pub piston_area: Option<f64>,
    /// Sensor stiffness K_S, N/m.
    pub sensor_stiffness: Option<f64>,
}

/// Parameter of the linear model, and its dependencies.
#[derive(Clone, Copy, Debug)]
pub struct LinearParameter {
    /// Key, in `[linear]` and `[uncertainty]`.
    pub key: Key,
    /// Numbers of the project on which it depends directly, and not only through the pressures of
    /// the operating point. Numbers of one line are listed as of both. A test compares the lists
    /// with the effects of changed numbers of a rig.
    pub depends_on: &'static [&'static str],
}

impl LinearParameter {
    /// True if it depends on the number at a path.
    pub fn follows_from(&self, path: &str) -> bool {
        let of_one = ["line.a.", "line.b."].into_iter().find_map(|side| path.strip_prefix(side));
        self.depends_on.iter().any(|known| match of_one {
            Some(key) => known.strip_prefix("line.") == Some(key),
            None => *known == path,
        })
    }
}

/// Paths on which the valve coefficients depend.
const VALVE: &[&str] = &[
    "valve.flow_coefficients.supply_to_a",
    "valve.flow_coefficients.supply_to_b",
    "valve.flow_coefficients.a_to_tank",
    "valve.flow_coefficients.b_to_tank",
    "valve.leakage_coefficients.supply_to_a",
    "valve.leakage_coefficients.supply_to_b",
    "valve.leakage_coefficients.a_to_tank",
    "valve.leakage_coefficients.b_to_tank",
    "valve.leakage_shape",
    "valve.leakage_shapes.supply_to_a",
    "valve.leakage_shapes.supply_to_b",
    "valve.leakage_shapes.a_to_tank",
    "valve.leakage_shapes.b_to_tank",
    "valve.lap.positive",
    "valve.lap.negative",
    "valve.saturation",
    "valve.nominal_flow",
    "valve.nominal_pressure_drop",
    "valve.nominal_voltage",
    "valve.null_leakage",
    "valve.null_leakage_pressure",
    "valve.tare_flow",
    "valve.transition_pressure",
    "supply.pressure",
    "supply.tank_pressure",
    "operating_point.load_pressure",
    "operating_point.load_force",
    "operating_point.velocity",
    "operating_point.command",
    "motor.case_leakage",
];

/// Paths on which the hydraulic stiffness depends.
const STIFFNESS_PATHS: &[&str] = &[
    "fluid.bulk_modulus",
    "fluid.entrained_air",
    "fluid.polytropic_exponent",
    "supply.pressure",
    "cylinder.piston_diameter",
    "cylinder.piston_area",
    "cylinder.rod_diameter",
    "cylinder.stroke",
    "cylinder.stage_transition",
    "cylinder.dead_volume",
    "motor.displacement",
    "motor.stroke",
    "motor.dead_volume",
    "line.length",
    "line.bore",
    "line.volume",
    "line.effective_bulk_modulus",
    "line.volumetric_expansion",
    "line.volumetric_expansion_pressure",
    "line.volumetric_expansion_slope",
    "line.dynamic_stiffening",
    "line.pipe.bore",
    "line.pipe.wall_thickness",
    "line.pipe.youngs_modulus",
    "line.pipe.poisson_ratio",
    "line.accumulator.gas_volume",
    "line.accumulator.precharge_pressure",
    "line.accumulator.polytropic_exponent",
    "line.accumulator.precharge_temperature",
    "line.accumulator.working_temperature",
    "line.accumulator.adjustment.gas_volume",
    "line.accumulator.adjustment.precharge_pressure",
    "line.accumulator.adjustment.setting",
    "operating_point.position",
];

const AREA_PATHS: &[&str] =
    &["cylinder.piston_diameter", "cylinder.piston_area", "cylinder.rod_diameter", "motor.displacement"];

/// Parameters of the linear model, in the order of `[linear]`.
pub static LINEAR_PARAMETERS: [LinearParameter; 9] = [
    LinearParameter {
        key: key("viscous_friction", &DAMPING, "f_v.").of_motion().not_negative(),
        depends_on: &["cylinder.friction.viscous", "motor.friction.viscous"],
    },
    LinearParameter { key: key("flow_gain", &FLOW_GAIN, "K_qU.").positive(), depends_on: VALVE },
    LinearParameter {
        key: key("flow_pressure_coefficient", &FLOW_PRESSURE_COEFFICIENT, "K_c.").not_negative(),
        depends_on: VALVE,
    },
    LinearParameter {
        key: key("hydraulic_stiffness", &STIFFNESS, "K_H.").of_motion().positive(),
        depends_on: STIFFNESS_PATHS,
    },
    LinearParameter {
        key: key("valve_natural_frequency", &ANGULAR_FREQUENCY, "Of the spool's dynamics.").positive(),
        depends_on: &["valve.natural_frequency"],
    },
    LinearParameter {
        key: key("valve_damping_ratio", &RATIO, "Of the spool's dynamics.").positive(),
        depends_on: &["valve.damping_ratio"],
    },
    LinearParameter {
        key: key("moving_mass", &MASS, "M.").of_motion().positive(),
        depends_on: &["cylinder.moving_mass", "motor.inertia"],
    },
    LinearParameter { key: key("piston_area", &AREA, "A_u.").of_motion().positive(), depends_on: AREA_PATHS },
    LinearParameter {
        key: key("sensor_stiffness", &STIFFNESS, "K_S.").of_motion().positive(),
        depends_on: &["force_sensor.stiffness"],
    },
];

impl Linear {
    /// Declared value of a parameter by its name.
    pub fn get(&self, name: &str) -> Option<f64> {
        let mut copy = self.clone();
        copy.fields()
            .into_iter()
            .zip(&LINEAR_PARAMETERS)
            .find(|(_, p)| p.key.name == name)
            .and_then(|(f, _)| *f)
    }

    fn fields(&mut self) -> [&mut Option<f64>; 9] {
        [
            &mut self.viscous_friction,
            &mut self.flow_gain,
            &mut self.flow_pressure_coefficient,
            &mut self.hydraulic_stiffness,
            &mut self.valve_natural_frequency,
            &mut self.valve_damping_ratio,
            &mut self.moving_mass,
            &mut self.piston_area,
            &mut self.sensor_stiffness,
        ]
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        for (field, parameter) in self.fields().into_iter().zip(&LINEAR_PARAMETERS) {
            v.optional(parameter.key, field);
        }
    }
}
