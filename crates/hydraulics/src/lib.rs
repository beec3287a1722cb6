//! The actuator as physics.
