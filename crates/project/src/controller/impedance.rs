//! Table `[controller.impedance]`.

use phea_quantity::{DAMPING, MASS, STIFFNESS, TIME};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Virtual impedance of the loop at the load: mass, damper and spring between the load and its
/// initial position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredImpedance {
    /// Stiffness K_v, N/m.
    pub stiffness: f64,
    /// Damping B_v, N s/m.
    pub damping: f64,
    /// Mass M_v, kg.
    pub mass: f64,
    /// Filter time constant, s; needed for a damper or a mass.
    pub filter_time: Option<f64>,
    /// Meaning of the transfer function of `[controller]`.
    pub form: ImpedanceForm,
}

/// Meaning of the transfer function of a controller with an impedance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImpedanceForm {
    /// Force controller G.
    #[default]
    Impedance,
    /// Position controller C_x in an inner loop: G = C_x/(M_v s^2 + B_v s + K_v).
    Admittance,
}

impl DeclaredImpedance {
    /// True if it has no effect on the load.
    pub fn is_zero(&self) -> bool {
        self.stiffness == 0.0 && self.damping == 0.0 && self.mass == 0.0
    }

    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let number = |name, dimension, doc| key(name, dimension, doc).of_motion().not_negative().or(0.0);
        let doc = "Force per distance of the load from its rest position.";
        v.quantity(number("stiffness", &STIFFNESS, doc), &mut self.stiffness);
        v.quantity(number("damping", &DAMPING, "Force per velocity of the load."), &mut self.damping);
        v.quantity(number("mass", &MASS, "Force per acceleration of the load."), &mut self.mass);
        let doc = "Time constant of the filter of the measured position; for a damper or a mass.";
        v.optional(key("filter_time", &TIME, doc).positive(), &mut self.filter_time);
        let words = &[("impedance", ImpedanceForm::Impedance), ("admittance", ImpedanceForm::Admittance)];
        let k = plain("form", "Whether the transfer function is of the force or of an inner position loop.");
        v.choice(k, words, &mut self.form, false);
    }
}
