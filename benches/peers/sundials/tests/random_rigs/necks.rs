//! Rigs with gas accumulators behind necks that empty: a low supply, precharges above the pressure
//! that the load leaves in a chamber, short and long necks.

use phea_dynamics::controller::AntiWindup;
use phea_dynamics::simulation::Profile;
use phea_hydraulics::accumulator::{
    Accumulator, ChamberGas, GasContent, GasPassage, HEAT_CAPACITY_RATIO, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::fluid::Fluid;
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::{Friction, LuGre, Stribeck};
use phea_hydraulics::line::{Line, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Machine, MachineOptions, PowerUnit, StartValues};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::servovalve::{
    LeakageModel, LeakageShape, OpeningLaw, Servovalve, SpoolImperfection, Supply,
};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::ActuatorStroke;

use crate::rig::{Chance, Control, Refusal, Rig};

const DURATION_S: f64 = 0.4;

/// The rig of this number.
pub(crate) fn rig(number: u64) -> Result<Rig, Refusal> {
    let mut chance = Chance::of(number, 0x2545_f491_4f6c_dd1d);
    let mut components = components(&mut chance);
    let mass = components.cylinder.moving_mass * chance.decades(0.1, 3.0);
    let stiffness = components.force_sensor.stiffness * chance.decades(1e-2, 0.3);
    let damping = 0.2 * (stiffness * mass).sqrt();
    let sprung = chance.happens(0.4);
    if sprung {
        components.load = Load::SpringMassDamper { mass, stiffness, damping };
    }
    let control = control(&mut chance, &components);
    let actuator = Actuator::new(components).map_err(Refusal::Actuator)?;
    let machine = Machine::new(&actuator, &MachineOptions::default()).map_err(Refusal::Machine)?;
    let pressure = 0.5 * components.supply.pressure;
    let position = components.cylinder.stroke.middle();
    let start =
        StartValues { position, pressure_a: pressure, pressure_b: pressure, ..StartValues::default() };
    let beginning = machine.start(&start).map_err(Refusal::Machine)?;
    // first one chamber is emptied, then the other
    let most = components.supply.pressure * components.cylinder.area_b;
    let sign = if chance.happens(0.5) { 1.0 } else { -1.0 };
    let (first, second) = (sign * most * chance.between(0.3, 0.8), -sign * most * chance.between(0.3, 0.8));
    let reference = Profile::steps(0.0, &[(0.03, first), (0.2, second)]).expect("times ascend");
    let distance = -sign * 2.0 * position * chance.decades(1e-3, 2e-2);
    let motion = Profile::smooth_step(0.1, chance.decades(1e-2, 0.1), distance);
    let shut = "gas behind necks";
    let heat = components.gas[0].and_then(|gas| gas.relaxing().map(|_| "gas with heat"));
    Ok(Rig {
        machine,
        start: beginning.state,
        waves: beginning.waves,
        control,
        reference,
        ground: motion.expect("a positive duration").shifted(beginning.inputs[0]),
        duration_s: DURATION_S,
        twin: None,
        features: std::iter::once(shut).chain(heat).chain(sprung.then_some("spring load")).collect(),
    })
}

pub(crate) fn components(chance: &mut Chance) -> Components {
    let pressure = chance.decades(40e5, 210e5);
    let area_a = chance.decades(2e-4, 3e-3);
    let area_b = area_a * chance.between(0.6, 1.0);
    let stroke = chance.between(0.1, 0.5);
    let most_force = pressure * area_a;
    let stiffness = most_force / chance.decades(1e-4, 2e-3);
    let moving_mass = stiffness / chance.decades(300.0, 2000.0).powi(2);
    let flow_coefficient = chance.decades(0.1, 1.0) * area_a / (0.5 * pressure).sqrt();
    let leakage = flow_coefficient * chance.decades(2e-3, 2e-2);
    let friction = friction(chance, most_force, moving_mass);
    let volume = area_a * stroke * chance.decades(3e-2, 0.3);
    let line = Line::Volume { volume, effective_bulk_modulus: chance.decades(3e8, 1.4e9) };
    let time_constant = chance.happens(0.4).then(|| chance.decades(0.05, 3.0));
    let gas = [0; 2].map(|_| Some(gas(chance, area_a * stroke, 0.5 * pressure, time_constant)));
    Components {
        fluid: Fluid {
            bulk_modulus: 1.45e9,
            density: 870.0,
            kinematic_viscosity: 46e-6,
            entrained_air: None,
            vapour_pressure_absolute: 0.0,
        },
        supply: Supply { pressure, tank_pressure: 0.0 },
        outward: OutwardFlow { external_leakage: None, port_valves: [None; 2] },
        power_unit: PowerUnit::Constant,
        valve: Servovalve {
            flow_coefficients: chance.edges(flow_coefficient),
            opening: OpeningLaw::Proportional,
            leakage_coefficients: chance.edges(leakage),
            leakage_shape: LeakageShape::Common(100.0),
            leakage_model: LeakageModel::EachEdge,
            tare_flow: 0.0,
            tare_reference_drop: pressure,
            nominal_voltage: 10.0,
            natural_frequency: chance.decades(300.0, 1500.0),
            damping_ratio: chance.between(0.6, 1.1),
            transition_pressure: chance.decades(1e3, 3e4),
            spool: SpoolImperfection::default(),
        },
        line_a: line,
        line_b: line,
        line_models: [LineModel::Lumped; 2],
        gas,
        cross_port: None,
        series: None,
        linkage: None,
        load: Load::Prescribed,
        velocity_gain: None,
        cylinder: Cylinder {
            area_a,
            area_b,
            stroke: ActuatorStroke::Limited(stroke),
            moving_mass,
            dead_volume_a: area_a * stroke * 0.02,
            dead_volume_b: area_b * stroke * 0.02,
            internal_leakage: None,
            end_stops: None,
        },
        friction,
        force_sensor: ForceSensor { stiffness },
        stiffness_model: StiffnessModel::ByVolume,
    }
}

/// Friction with bristles.
fn friction(chance: &mut Chance, most_force: f64, moving_mass: f64) -> Friction {
    let coulomb = most_force * chance.decades(2e-3, 3e-2);
    let curve = Stribeck {
        coulomb,
        static_friction: coulomb * chance.between(1.0, 1.6),
        stribeck_velocity: chance.decades(3e-3, 3e-2),
        stribeck_exponent: 2.0,
        viscous: most_force * chance.decades(0.01, 0.2),
        retracting: None,
    };
    let bristle_stiffness = coulomb / chance.decades(3e-6, 5e-5);
    let bristle_damping = chance.decades(0.1, 1.0) * (bristle_stiffness * moving_mass).sqrt();
    Friction::LuGre(LuGre { curve, bristle_stiffness, bristle_damping })
}

/// Gas that a force between a third and the most of the actuator shuts off, and its neck.
fn gas(chance: &mut Chance, swept: f64, pressure: f64, time_constant: Option<f64>) -> ChamberGas {
    let gas_volume = swept * chance.decades(1e-2, 0.3);
    let precharge_pressure = pressure * chance.between(0.3, 1.1);
    let content = match time_constant {
        Some(time_constant) => {
            GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
        }
        None => {
            let polytropic_exponent = chance.between(1.0, HEAT_CAPACITY_RATIO);
            GasContent::Polytropic(Accumulator { gas_volume, precharge_pressure, polytropic_exponent })
        }
    };
    let size = [chance.decades(2e-3, 1e-2), chance.decades(5e-3, 0.2)];
    let neck = Neck::round(size, [870.0, 46e-6, 1.45e9], chance.between(0.5, 2.0));
    ChamberGas::Sealed(SealedGas { content, passage: GasPassage::Neck(neck), maximum_pressure_ratio: None })
}

/// Gains for a crossover at which the loop itself does not ring.
pub(crate) fn control(chance: &mut Chance, components: &Components) -> Control {
    let Components { valve, cylinder, supply, force_sensor, .. } = components;
    let flow_gain =
        valve.flow_coefficients.supply_to_a / valve.nominal_voltage * (0.5 * supply.pressure).sqrt();
    let soft = 0.1 * force_sensor.stiffness;
    let proportional = chance.decades(3.0, 60.0) * cylinder.area_a / (soft * flow_gain);
    Control {
        proportional,
        integral: proportional * chance.decades(1.0, 15.0),
        prefilter_frequency: chance.decades(30.0, 200.0),
        prefilter_damping: 1.0,
        limit: valve.nominal_voltage,
        anti_windup: AntiWindup::Clamping,
        sample_time_s: None,
        delay_s: 0.0,
    }
}
