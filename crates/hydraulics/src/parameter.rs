//! Refusal of parameters outside physics, naming the quantity, its value and the requirement.

/// A parameter that cannot describe a real component.
///
/// # Example
/// ```
/// use phea_hydraulics::fluid::Fluid;
/// let vacuum = Fluid { bulk_modulus: 0.0, density: 870.0, kinematic_viscosity: 46e-6, entrained_air: None };
/// assert_eq!(vacuum.problems()[0].to_string(), "bulk_modulus is 0, but must be positive");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} is {value}, but must be {requirement}")]
pub struct ParameterError {
    /// Which quantity, as a dotted path below the component it belongs to: `cylinder.stroke`.
    pub quantity: String,
    /// The value given, in SI units.
    pub value: f64,
    /// The requirement, to follow "must be".
    pub requirement: &'static str,
}

impl ParameterError {
    /// The same refusal seen from the owner of the component: `stroke` becomes `cylinder.stroke`.
    pub fn within(self, owner: &str) -> ParameterError {
        ParameterError { quantity: format!("{owner}.{}", self.quantity), ..self }
    }
}

/// Collects refusals, so that all of a component are reported at once.
#[derive(Debug, Default)]
pub(crate) struct Problems(Vec<ParameterError>);

impl Problems {
    /// Refuses `value` unless `holds`; a value that is not finite is always refused.
    pub(crate) fn require(&mut self, quantity: &str, value: f64, holds: bool, requirement: &'static str) {
        if !value.is_finite() {
            let requirement = "a finite number";
            self.0.push(ParameterError { quantity: quantity.to_string(), value, requirement });
        } else if !holds {
            self.0.push(ParameterError { quantity: quantity.to_string(), value, requirement });
        }
    }

    pub(crate) fn positive(&mut self, quantity: &str, value: f64) {
        self.require(quantity, value, value > 0.0, "positive");
    }

    pub(crate) fn not_negative(&mut self, quantity: &str, value: f64) {
        self.require(quantity, value, value >= 0.0, "zero or positive");
    }

    pub(crate) fn component(&mut self, owner: &str, problems: Vec<ParameterError>) {
        self.0.extend(problems.into_iter().map(|problem| problem.within(owner)));
    }

    pub(crate) fn all(&mut self, problems: Vec<ParameterError>) {
        self.0.extend(problems);
    }

    pub(crate) fn into_vec(self) -> Vec<ParameterError> {
        self.0
    }
}
