//! Physics of the actuator: servovalve, lines, cylinder, friction and force sensor, their
//! equilibrium, and the linear models of the force on a load.
//!
//! ```text
//! Components -> Actuator -> OperatingPoint -> LinearParameters -> LinearPlant -> LinearModel
//!                  |                                               + lines -> PlantInMotion
//!                  +-> Machine                                     the nonlinear equations
//! ```
//!
//! Every equation is written once over [`phea_dynamics::scalar::Scalar`] and cites its number in
//! Ledezma (2019), the thesis. Parameters are plain structs in SI units;
//! [`actuator::Actuator::new`] is the only constructor, and rejects impossible ones. Signs: the
//! piston position grows from the A end to the B end, chamber flows are positive into their
//! chamber, the force on the load is positive when the rod pushes, pressures are gauge unless a
//! name says `absolute`.

pub mod accumulator;
pub mod actuator;
pub mod contact;
pub mod cross_port;
pub mod cylinder;
pub mod fluid;
pub mod force_sensor;
pub mod friction;
pub mod impedance;
pub mod line;
pub mod linear;
pub mod linkage;
pub mod load;
pub mod machine;
pub mod operating_point;
pub mod orifice;
pub mod outward_flow;
pub mod parameter;
pub mod plant;
pub mod port_valves;
pub mod power_unit;
pub mod reference_rig;
pub mod series;
pub mod servovalve;
pub mod signal;
pub mod stiffness;
pub mod stroke;
pub mod two_pressure;
pub mod velocity_sensor;
