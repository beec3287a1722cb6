use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::ExpansionPressures;
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::servovalve::Supply;

use super::in_loop::velocity_gain;
use crate::project::{DeclaredActuator, DeclaredFriction, DeclaredSeries};

/// The declared rig as the components of `phea_hydraulics`.
///
/// # Errors
/// Every parameter that is impossible as physics.
pub fn actuator(declared: &DeclaredActuator) -> Result<Actuator, ActuatorError> {
    Actuator::new(components(declared, declared))
}

/// Components of the declared rig over any scalar, not yet checked. `plain` is the rig in its own
/// numbers: its linkage, whose geometry is never open, is reduced to polynomials over the stroke.
pub fn components<S: Scalar>(plain: &DeclaredActuator, declared: &DeclaredActuator<S>) -> Components<S> {
    let pressure = declared.supply.pressure;
    let tank_pressure = declared.supply.tank_pressure;
    let pressures = ExpansionPressures::of(pressure, tank_pressure);
    let fluid = declared.fluid.component();
    let valve = declared.valve.component(pressure - tank_pressure);
    Components {
        gas: [&declared.line.a, &declared.line.b]
            .map(|line| Some(line.accumulator.as_ref()?.chamber_gas(&fluid))),
        fluid,
        supply: Supply::of(&declared.supply),
        power_unit: declared.supply.component(declared.fluid.bulk_modulus),
        valve,
        line_a: declared.line.a.component(pressures),
        line_b: declared.line.b.component(pressures),
        line_models: [&plain.line.a, &plain.line.b].map(|line| line.motion.component()),
        cross_port: declared.cross_port.as_ref().map(|port| port.component(fluid.density)),
        outward: OutwardFlow {
            external_leakage: declared.motor.as_ref().and_then(|motor| motor.case_leakage),
            port_valves: declared.port_valves.as_ref().map_or([None; 2], |valves| valves.components(&valve)),
        },
        cylinder: match &declared.motor {
            None => declared.cylinder.component(),
            Some(motor) => motor.component(),
        },
        friction: declared.friction().map_or_else(Friction::default, DeclaredFriction::component),
        force_sensor: ForceSensor { stiffness: declared.force_sensor.stiffness },
        series: declared.series.as_ref().map(DeclaredSeries::component),
        linkage: plain.linkage.as_ref().map(|geometry| {
            let weight = declared.linkage.as_ref().and_then(|linkage| linkage.weight);
            geometry.component(plain.cylinder.stroke, weight)
        }),
        load: declared.load,
        velocity_gain: velocity_gain(declared),
        stiffness_model: declared.line.compliance,
    }
}
