//! Rig of Ledezma (2019) as a reference problem: one set of numbers for examples, tests and
//! benches.
//!
//! Table A.1 for the components, Table 5.1 for the valve's edges, section 6.4.1 for the hose.
//! Values missing in the thesis (fluid modulus, density, viscosity, friction beyond f_v, the
//! transition pressure) are chosen here: 1.45 GPa reproduces its tables.

use crate::actuator::Components;
use crate::contact::Contact;
use crate::cylinder::Cylinder;
use crate::fluid::Fluid;
use crate::force_sensor::ForceSensor;
use crate::friction::{Friction, LuGre, Stribeck};
use crate::line::{Hose, Line, LineModel, Pipe, PipeWall, Stiffening};
use crate::linear::LinearParameters;
use crate::load::Load;
use crate::outward_flow::OutwardFlow;
use crate::power_unit::PowerUnit;
use crate::servovalve::{
    Edges, LeakageModel, LeakageShape, OpeningLaw, Servovalve, SpoolImperfection, Supply,
};
use crate::stiffness::StiffnessModel;
use crate::stroke::ActuatorStroke;

/// Useful piston area of a 50 mm piston with 22 mm rods, m2.
pub const USEFUL_AREA: f64 = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);

/// Hose Eaton Synflex 3130-08: 12.7 mm, E = 1.56e-5 m3/m at 70 bar, less by the slope times 35 bar
/// at 35 bar.
pub fn hose() -> Hose {
    Hose {
        bore: 12.7e-3,
        volumetric_expansion: 1.56e-5,
        operating_expansion: 1.56e-5 - 2.236e-12 * 35e5,
        expansion_slope: 2.236e-12,
        dynamic_stiffening: Stiffening { nominal: 5.0, minimum: 4.0, maximum: 5.0 },
    }
}

/// Line of 1.5 m of [`hose`] on each side.
pub fn hose_line() -> Line {
    Line::Hose { hose: hose(), length: 1.5 }
}

/// Pipe with which the hose is compared: 0.35 m of 10.5 mm bore, assumed rigid.
pub fn pipe_line() -> Line {
    Line::Pipe { pipe: Pipe { bore: 10.5e-3, wall: PipeWall::Rigid }, length: 0.35 }
}

/// Components with a leakage across the piston in m3/(s Pa).
pub fn leaking(components: Components, internal_leakage: f64) -> Components {
    let cylinder = Cylinder { internal_leakage: Some(internal_leakage), ..components.cylinder };
    Components { cylinder, ..components }
}

/// Components with end stops.
pub fn stopped(components: Components, contact: Contact) -> Components {
    let cylinder = Cylinder { end_stops: Some(contact), ..components.cylinder };
    Components { cylinder, ..components }
}

/// Symmetric cylinder: 50/22 mm, 0.5 m, 13.1 kg.
pub fn cylinder() -> Cylinder {
    Cylinder {
        area_a: USEFUL_AREA,
        area_b: USEFUL_AREA,
        stroke: ActuatorStroke::Limited(0.5),
        moving_mass: 13.1,
        dead_volume_a: 0.0,
        dead_volume_b: 0.0,
        internal_leakage: None,
        end_stops: None,
    }
}

/// Valve Moog 760 C263-A with the unequal edges of Table 5.1.
pub fn valve() -> Servovalve {
    Servovalve {
        flow_coefficients: Edges::from_array([3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7]),
        opening: OpeningLaw::Proportional,
        leakage_coefficients: Edges::from_array([2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9]),
        leakage_shape: LeakageShape::Common(100.0),
        leakage_model: LeakageModel::EachEdge,
        tare_flow: 7.55e-6,
        tare_reference_drop: 70e5,
        nominal_voltage: 10.0,
        natural_frequency: 1099.0,
        damping_ratio: 0.9,
        transition_pressure: 1e3,
        spool: SpoolImperfection::default(),
    }
}

/// Measured null of section 5.2.1: 0.078 V rising and -0.05 V falling. The threshold included is
/// not printed.
pub fn measured_spool() -> SpoolImperfection {
    SpoolImperfection { null_bias: 0.014, hysteresis_width: Some(0.128), ..SpoolImperfection::default() }
}

/// Valve with equal edges: K_vp = 3.0e-7 and K_vinp = 2.40e-9, which give K_qU 5.61e-5 and K_c
/// 6.42e-13 at null.
pub fn valve_with_equal_edges() -> Servovalve {
    Servovalve {
        flow_coefficients: Edges::equal(3.0e-7),
        opening: OpeningLaw::Proportional,
        leakage_coefficients: Edges::equal(2.40e-9),
        ..valve()
    }
}

/// Components of the whole actuator with this line on both sides, viscous friction and the sensor
/// in series with its environment.
pub fn components(line: Line, stiffness_model: StiffnessModel) -> Components {
    Components {
        fluid: Fluid {
            bulk_modulus: 1.45e9,
            density: 870.0,
            kinematic_viscosity: 46e-6,
            entrained_air: None,
            vapour_pressure_absolute: 0.0,
        },
        supply: Supply { pressure: 70e5, tank_pressure: 0.0 },
        power_unit: PowerUnit::Constant,
        valve: valve(),
        line_a: line,
        line_b: line,
        line_models: [LineModel::Lumped; 2],
        gas: [None; 2],
        cross_port: None,
        outward: OutwardFlow::default(),
        cylinder: cylinder(),
        friction: Friction::Viscous { viscous: 100.0 },
        force_sensor: ForceSensor { stiffness: 2e7 },
        series: None,
        linkage: None,
        load: Load::Prescribed,
        velocity_gain: None,
        stiffness_model,
    }
}

/// Rig for comparisons of differential equation solvers: the valve and hose of the thesis in round
/// numbers, LuGre friction, one modulus for line and chamber.
///
/// ```text
/// A_u = 1.583e-3 m2, V_line = 1.9e-4 m3, beta_e = 2.6e8 Pa, sigma_0 = 1e7 N/m, sigma_1 = 2000 N s/m, sigma_2 = 100 N s/m
/// ```
pub fn benchmark_components() -> Components {
    let line = Line::Volume { volume: 1.9e-4, effective_bulk_modulus: 2.6e8 };
    let curve = Stribeck {
        coulomb: 80.0,
        static_friction: 120.0,
        stribeck_velocity: 0.01,
        stribeck_exponent: 2.0,
        viscous: 100.0,
        retracting: None,
    };
    Components {
        cylinder: Cylinder { area_a: 1.583e-3, area_b: 1.583e-3, ..cylinder() },
        friction: Friction::LuGre(LuGre { curve, bristle_stiffness: 1e7, bristle_damping: 2e3 }),
        ..components(line, StiffnessModel::Uniform)
    }
}

/// Nominal plant of Table 6.3, with K_S = 2e7 N/m.
///
/// # Example
/// The valve with equal edges at null has the K_c of the table, to a unit of its last digit:
/// ```
/// use phea_hydraulics::reference_rig::{components, hose_line, nominal_plant, valve_with_equal_edges};
/// use phea_hydraulics::servovalve::{SpoolDirection, control_coefficients};
/// use phea_hydraulics::stiffness::StiffnessModel;
/// let supply = components(hose_line(), StiffnessModel::Uniform).supply;
/// let null = control_coefficients(&valve_with_equal_edges(), &supply, 0.0, 0.0, SpoolDirection::Mean);
/// assert!((null.flow_pressure_coefficient - nominal_plant().flow_pressure_coefficient).abs() < 1e-15);
/// ```
pub fn nominal_plant() -> LinearParameters {
    LinearParameters {
        useful_area: USEFUL_AREA,
        moving_mass: 13.1,
        viscous_friction: 100.0,
        flow_gain: 5.4e-5,
        flow_pressure_coefficient: 6.42e-13,
        hydraulic_stiffness: 2.24e6,
        sensor_stiffness: 2e7,
        valve_natural_frequency: 1099.0,
        valve_damping_ratio: 0.9,
    }
}
