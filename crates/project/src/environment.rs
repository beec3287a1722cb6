//! Tables `[force_sensor]`, `[velocity_sensor]` and `[load]`.

use super::key::{key, plain};
use super::visitor::{Variants, Visitor};
pub use phea_hydraulics::load::Load;
use phea_quantity::{
    ANGULAR_FREQUENCY, DAMPING, FORCE, INVERSE_VELOCITY, LENGTH, MASS, RATIO, STIFFNESS, TIME, VELOCITY,
};

/// Load cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredForceSensor {
    /// Stiffness K_S, N/m: of the cell in series with its environment if the load is a prescribed
    /// motion.
    pub stiffness: f64,
    /// Root mean square of the white noise at a sampled controller, N.
    pub noise: f64,
    /// Largest permitted force in both directions, N.
    pub capacity: Option<f64>,
}

impl DeclaredForceSensor {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("stiffness", &STIFFNESS, "K_S: with a prescribed load motion, of cell and environment.")
            .of_motion();
        v.quantity(k.positive(), &mut self.stiffness);
        let k =
            key("noise", &FORCE, "Root mean square of the white noise in what a sampled controller sees.")
                .of_motion();
        v.quantity(k.not_negative().or(0.0), &mut self.noise);
        let k =
            key("capacity", &FORCE, "The force that it survives, in both directions.").of_motion().positive();
        v.optional(k, &mut self.capacity);
    }
}

/// Sensor of the load velocity, which a controller may feed forward.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredVelocitySensor {
    /// Ratio of measured to true velocity, less one.
    pub gain_error: f64,
    /// Delay of the measured velocity, s.
    pub delay: f64,
    /// Corner frequency of its filter, rad/s; no filter if absent.
    pub filter_frequency: Option<f64>,
    /// Damping ratio of a second-order filter; first order if absent.
    pub filter_damping_ratio: Option<f64>,
    /// Root mean square of the white noise at a sampled controller, m/s.
    pub noise: f64,
    /// Resolution at a sampled controller, m/s; zero without rounding.
    pub resolution: f64,
}

impl DeclaredVelocitySensor {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("gain_error", &RATIO, "Shown velocity over the true one, less one.").above(-1.0);
        v.quantity(k.or(0.0), &mut self.gain_error);
        let k = key("delay", &TIME, "From the velocity until it is shown.").not_negative();
        v.quantity(k.or(0.0), &mut self.delay);
        let doc = "Corner frequency of its low-pass filter; absent: it has none.";
        v.optional(key("filter_frequency", &ANGULAR_FREQUENCY, doc).positive(), &mut self.filter_frequency);
        let doc = "Damping ratio of a filter of second order; absent: it is of first order.";
        v.optional(key("filter_damping_ratio", &RATIO, doc).positive(), &mut self.filter_damping_ratio);
        let doc = "Root mean square of the white noise in what a sampled controller sees.";
        v.quantity(key("noise", &VELOCITY, doc).of_motion().not_negative().or(0.0), &mut self.noise);
        let doc = "Step to which a sampled controller sees it rounded; 0: not at all.";
        v.quantity(
            key("resolution", &VELOCITY, doc).of_motion().not_negative().or(0.0),
            &mut self.resolution,
        );
    }
}

/// Load while its table is visited: its type belongs to the physics.
#[derive(Clone)]
struct LoadTable(Load);

/// Visits the table of a load.
pub(crate) fn visit_load<V: Visitor>(load: &mut Load, v: &mut V) {
    let mut table = LoadTable(*load);
    v.variant(plain("model", "Which load."), &mut table, false);
    *load = table.0;
}

impl Variants for LoadTable {
    fn all(&self) -> Vec<LoadTable> {
        let (damping, stiffness) = (0.0, 0.0);
        let all = [
            Load::Prescribed,
            Load::SpringMassDamper { mass: 0.0, stiffness, damping },
            Load::Wall { mass: None, damping, stiffness, gap: 0.0, relative_damping: 0.0 },
        ];
        all.map(LoadTable).to_vec()
    }

    fn word(&self) -> &'static str {
        match self.0 {
            Load::Prescribed => "prescribed",
            Load::SpringMassDamper { .. } => "spring_mass_damper",
            Load::Wall { .. } => "wall",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let kilograms = key("mass", &MASS, "Mass of the load.").of_load().positive();
        let spring = key("stiffness", &STIFFNESS, "Stiffness of the load or of the wall.").of_load();
        let damper =
            key("damping", &DAMPING, "Damping of the load or of its guide.").of_load().not_negative().or(0.0);
        match &mut self.0 {
            Load::Prescribed => {}
            Load::SpringMassDamper { mass, stiffness, damping } => {
                v.quantity(kilograms, mass);
                // zero for a free mass
                v.quantity(spring.not_negative(), stiffness);
                v.quantity(damper, damping);
            }
            Load::Wall { mass, damping, stiffness, gap, relative_damping } => {
                v.optional(kilograms, mass);
                v.quantity(spring.positive(), stiffness);
                v.quantity(damper, damping);
                let k = key("gap", &LENGTH, "Free play before the wall is touched.").of_load().not_negative();
                v.quantity(k.or(0.0), gap);
                let k = key(
                    "relative_damping",
                    &INVERSE_VELOCITY,
                    "Damping of the wall relative to its elastic force.",
                )
                .of_load();
                v.quantity(k.not_negative().or(0.0), relative_damping);
            }
        }
    }
}
