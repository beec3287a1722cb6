//! Sensor of the load velocity, which a controller may feed forward.

mod keys;

pub use keys::DeclaredVelocitySensor;
