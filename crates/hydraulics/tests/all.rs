//! Components and machines through the public interface: closed forms, limits, conservation and
//! published numbers.
#![cfg(test)]

mod accumulator;
mod adjustment;
mod commanded;
mod components;
mod cross_port;
mod friction_on_test;
mod gas_heat;
mod impedance;
mod line_models;
mod linear_models;
mod linkage;
mod machine_components;
mod machine_conservation;
mod machine_equations;
mod machine_slopes;
mod measured_velocity;
mod motor;
mod neck;
mod opening;
mod operating_point;
mod passive_parts;
mod plant;
mod plant_in_motion;
mod port_valves;
mod pressure_feedback;
mod rich_machines;
mod series;
mod servovalve;
mod settling;
mod stiffness;
mod telescope;
mod together;
mod transmission;
mod two_pressure;
mod valve_on_test;
mod virtual_impedance;
