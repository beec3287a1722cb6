use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::{Friction, LuGre, Stribeck};
use phea_hydraulics::line::{Anchoring, Hose, Line, Pipe, PipeWall, Stiffening};
use phea_hydraulics::servovalve::{
    Edges, Servovalve, Supply, flow_coefficient_from_rating, leakage_coefficient_from_rating,
};
use phea_hydraulics::stiffness::StiffnessModel;

use crate::project::{self, Compliance, Component, FrictionModel, Interval};

/// Kinematic viscosity of ISO VG 46 oil at 40 degrees Celsius, m2/s: taken where a project states none.
pub(super) const KINEMATIC_VISCOSITY: f64 = 46e-6;

/// The declared rig as the components of `phea_hydraulics`.
///
/// # Errors
/// Every parameter that is impossible as physics.
pub(crate) fn actuator(declared: &project::Actuator) -> Result<Actuator, ActuatorError> {
    let [pressure, tank_pressure] = [declared.supply.pressure, declared.supply.tank_pressure];
    let pressures = ExpansionPressures::of(&declared.supply);
    Actuator::new(Components {
        fluid: fluid(&declared.fluid),
        supply: Supply { pressure, tank_pressure },
        valve: valve(&declared.valve, &declared.supply),
        line_a: line(&declared.line.a, pressures),
        line_b: line(&declared.line.b, pressures),
        cylinder: cylinder(&declared.cylinder),
        friction: friction(declared.cylinder.friction.as_ref()),
        force_sensor: ForceSensor { stiffness: declared.force_sensor.stiffness },
        stiffness_model: stiffness_model(declared.line.compliance),
    })
}

pub(crate) fn stiffness_model(compliance: Compliance) -> StiffnessModel {
    match compliance {
        Compliance::Uniform => StiffnessModel::Uniform,
        Compliance::ByVolume => StiffnessModel::ByVolume,
    }
}

fn fluid(declared: &project::Fluid) -> Fluid {
    let air = declared.entrained_air.filter(|fraction| *fraction > 0.0);
    Fluid {
        bulk_modulus: declared.bulk_modulus,
        density: declared.density,
        kinematic_viscosity: declared.kinematic_viscosity.unwrap_or(KINEMATIC_VISCOSITY),
        entrained_air: air.map(|volume_fraction| EntrainedAir {
            volume_fraction,
            polytropic_index: declared.polytropic_exponent,
        }),
    }
}

/// Coefficients as declared; without them, those of the data sheet, equal for all edges.
fn valve(declared: &project::Valve, supply: &project::Supply) -> Servovalve {
    let edges = |coefficients: project::EdgeCoefficients| Edges::from_array(coefficients.in_order());
    let rated_flow = declared.nominal_flow.unwrap_or(f64::NAN);
    let rated_drop = declared.nominal_pressure_drop.unwrap_or(f64::NAN);
    let leakage = declared.null_leakage.unwrap_or(f64::NAN);
    let leakage_pressure = declared.null_leakage_pressure.unwrap_or(f64::NAN);
    let from_rating = Edges::equal(flow_coefficient_from_rating(rated_flow, rated_drop));
    let from_leakage = Edges::equal(leakage_coefficient_from_rating(
        leakage,
        declared.tare_flow,
        declared.tare_drop(supply),
        leakage_pressure,
    ));
    Servovalve {
        flow_coefficients: declared.flow_coefficients.map_or(from_rating, edges),
        leakage_coefficients: declared.leakage_coefficients.map_or(from_leakage, edges),
        leakage_shape: declared.leakage_shape,
        tare_flow: declared.tare_flow,
        nominal_voltage: declared.nominal_voltage,
        natural_frequency: declared.natural_frequency,
        damping_ratio: declared.damping_ratio,
        transition_pressure: declared.transition_pressure,
    }
}

/// The line as physics.
fn line(declared: &project::Line, pressures: ExpansionPressures) -> Line {
    match declared.component() {
        Some(Component::Volume { volume, effective_bulk_modulus }) => {
            Line::Volume { volume, effective_bulk_modulus }
        }
        Some(Component::Pipe { pipe, length }) => Line::Pipe { pipe: self::pipe(pipe), length },
        Some(Component::Hose { bore, expansion, expansion_pressure, expansion_slope, length, .. }) => {
            let expansion = Expansion { measured: expansion, at: expansion_pressure, slope: expansion_slope };
            Line::Hose { hose: hose(bore, expansion, pressures, declared.dynamic_stiffening), length }
        }
        // A project that was read without error has a component; refused as physics otherwise.
        None => Line::Volume { volume: f64::NAN, effective_bulk_modulus: f64::NAN },
    }
}

/// Pressures in Pa at which a hose's expansion is wanted.
#[derive(Clone, Copy)]
pub(super) struct ExpansionPressures {
    /// The supply's: the thesis refers the wall's modulus to it.
    working: f64,
    /// Midway between supply and tank, where the chambers of an idle actuator stand.
    operating: f64,
}

impl ExpansionPressures {
    pub(super) fn of(supply: &project::Supply) -> ExpansionPressures {
        let operating = 0.5 * (supply.pressure + supply.tank_pressure);
        ExpansionPressures { working: supply.pressure, operating }
    }
}

/// What a catalogue says of a hose's volumetric expansion, m3/m, Pa and m3/(m Pa).
#[derive(Clone, Copy)]
pub(super) struct Expansion {
    pub(super) measured: Option<f64>,
    pub(super) at: Option<f64>,
    pub(super) slope: f64,
}

impl Expansion {
    /// The declared point and the slope from there, or the slope from zero, m3/m; a point without a pressure is taken as that of
    /// the working pressure.
    fn at(self, pressure: f64, working_pressure: f64) -> f64 {
        match self.measured {
            Some(measured) => measured + self.slope * (pressure - self.at.unwrap_or(working_pressure)),
            None => self.slope * pressure,
        }
    }
}

pub(super) fn hose(
    bore: f64,
    expansion: Expansion,
    pressures: ExpansionPressures,
    stiffening: Option<Interval>,
) -> Hose {
    let Interval { nominal, minimum, maximum } = stiffening.unwrap_or(Interval::exactly(1.0));
    let dynamic_stiffening = Stiffening { nominal, minimum, maximum };
    let ExpansionPressures { working, operating } = pressures;
    Hose {
        bore,
        volumetric_expansion: expansion.at(working, working),
        operating_expansion: expansion.at(operating, working),
        expansion_slope: expansion.slope,
        dynamic_stiffening,
    }
}

fn pipe(declared: &project::Pipe) -> Pipe {
    let wall = match (declared.wall_thickness, declared.youngs_modulus) {
        (Some(thickness), Some(youngs_modulus)) => PipeWall::Elastic {
            thickness,
            youngs_modulus,
            poisson_ratio: declared.poisson_ratio,
            anchoring: Anchoring::Throughout,
            thick: true,
        },
        _ => PipeWall::Rigid,
    };
    Pipe { bore: declared.bore, wall }
}

fn cylinder(declared: &project::Cylinder) -> Cylinder {
    let [area_a, area_b] = declared.effective_areas_m2();
    let [dead_volume_a, dead_volume_b] = declared.dead_volumes_m3();
    Cylinder {
        area_a,
        area_b,
        stroke: declared.stroke,
        moving_mass: declared.moving_mass,
        dead_volume_a,
        dead_volume_b,
    }
}

fn friction(declared: Option<&project::Friction>) -> Friction {
    let Some(declared) = declared else { return Friction::Viscous { viscous: 0.0 } };
    let curve = Stribeck {
        coulomb: declared.coulomb.unwrap_or(f64::NAN),
        breakaway: declared.static_friction.unwrap_or(f64::NAN),
        stribeck_velocity: declared.stribeck_velocity.unwrap_or(f64::NAN),
        stribeck_exponent: declared.stribeck_exponent,
        viscous: declared.viscous,
    };
    match declared.model {
        FrictionModel::Viscous => Friction::Viscous { viscous: declared.viscous },
        FrictionModel::Stribeck => Friction::Stribeck(curve),
        FrictionModel::LuGre => Friction::LuGre(LuGre {
            curve,
            bristle_stiffness: declared.bristle_stiffness.unwrap_or(f64::NAN),
            bristle_damping: declared.bristle_damping.unwrap_or(f64::NAN),
        }),
    }
}
