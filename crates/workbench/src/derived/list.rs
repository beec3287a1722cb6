use super::{Derived, Stated};
use crate::quantity::{Dimension, MotionKind};

/// A growing list of derived quantities; each chapter names its group once.
pub(super) struct List {
    entries: Vec<Derived>,
    group: &'static str,
    /// Motion of the rig.
    pub(super) motion: MotionKind,
}

impl List {
    pub(super) fn new(motion: MotionKind) -> List {
        List { entries: Vec::new(), group: "", motion }
    }

    /// SI unit of a quantity of the motion, given the dimension for linear motion.
    pub(super) fn si(&self, of: &'static Dimension) -> &'static str {
        self.motion.dimension(of).si
    }

    pub(super) fn group(&mut self, group: &'static str) {
        self.group = group;
    }

    pub(super) fn add(
        &mut self,
        name: impl Into<String>,
        symbol: &'static str,
        value: f64,
        unit: &'static str,
        equation: &'static str,
    ) {
        self.push(name.into(), symbol, Ok(value), unit, equation);
    }

    fn push(
        &mut self,
        name: String,
        symbol: &'static str,
        value: Result<f64, &'static str>,
        unit: &'static str,
        equation: &'static str,
    ) {
        let words = words(&name, self.motion);
        self.entries.push(Derived {
            group: self.group,
            name,
            words,
            symbol,
            value,
            unit,
            equation,
            stated: None,
        });
    }

    /// Adds to the last quantity the value that the project states for it.
    pub(super) fn stated(&mut self, value: f64, place: &'static str, bounds: Option<[f64; 2]>) {
        if let Some(last) = self.entries.last_mut() {
            last.stated = Some(Stated { value, place, bounds });
        }
    }

    /// A quantity that does not exist here, with the reason.
    pub(super) fn absent(
        &mut self,
        name: impl Into<String>,
        symbol: &'static str,
        unit: &'static str,
        equation: &'static str,
        reason: &'static str,
    ) {
        self.push(name.into(), symbol, Err(reason), unit, equation);
    }

    pub(super) fn into_entries(self) -> Vec<Derived> {
        self.entries
    }
}

/// Names of quantities of a motor that differ from those for linear motion, in words.
const WORDS_OF_A_MOTOR: [(&str, &str); 13] = [
    ("stiffness.at_least_force", "at least torque"),
    ("stiffness.at_greatest_force", "at greatest torque"),
    ("line.a.accumulator.least_force", "accumulator.least torque, line A"),
    ("line.b.accumulator.greatest_force", "accumulator.greatest torque, line B"),
    ("valve.flow_gain_extending", "flow gain forward"),
    ("valve.flow_gain_retracting", "flow gain reverse"),
    ("valve.flow_pressure_coefficient_extending", "flow pressure coefficient forward"),
    ("valve.flow_pressure_coefficient_retracting", "flow pressure coefficient reverse"),
    ("valve.flow_pressure_coefficient_extending_maximum", "flow pressure coefficient forward maximum"),
    ("valve.flow_pressure_coefficient_retracting_maximum", "flow pressure coefficient reverse maximum"),
    ("operating_point.position", "angle"),
    ("linear.moving_mass", "inertia"),
    ("linear.piston_area", "displacement"),
];

/// `line.a.wave_speed` as "wave speed, line A": the word of the group is not repeated.
fn words(name: &str, motion: MotionKind) -> String {
    let of_a_motor = WORDS_OF_A_MOTOR.iter().filter(|_| motion.is_rotary());
    if let Some((_, words)) = of_a_motor.into_iter().find(|(known, _)| *known == name) {
        return (*words).to_string();
    }
    let (group, quantity) = name.split_once('.').unwrap_or(("", name));
    match (group, quantity.split_once('.')) {
        ("line", Some((side, quantity))) => {
            format!("{}, line {}", quantity.replace('_', " "), side.to_uppercase())
        }
        _ => quantity.replace(['_', '.'], " "),
    }
}
