//! Rejection of impossible parameters, with the quantity, its value and the requirement.

use phea_table::{AcceptedRange, Key};

/// Error for a parameter that cannot describe a real component.
///
/// # Example
/// ```
/// use phea_hydraulics::fluid::Fluid;
/// let vacuum = Fluid {
///     bulk_modulus: 0.0, density: 870.0, kinematic_viscosity: 46e-6, entrained_air: None,
///     vapour_pressure_absolute: 0.0,
/// };
/// assert_eq!(vacuum.problems()[0].to_string(), "bulk_modulus is 0, but must be positive");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} is {value}, but must be {requirement}")]
pub struct ParameterError {
    /// Name of the quantity, as a dotted path below the component it belongs to: `cylinder.stroke`.
    pub quantity: String,
    /// Value, in SI units.
    pub value: f64,
    /// Requirement that it violates.
    pub requirement: ParameterRequirement,
}

/// Requirement on a parameter, to follow "must be".
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ParameterRequirement {
    /// Any finite number.
    #[error("a finite number")]
    FiniteNumber,
    /// Numbers of a range, that of a key of a table where there is one.
    #[error("{0}")]
    Within(AcceptedRange),
    /// Volume of a chamber and its line at the end of the stroke.
    #[error("positive together with the line's volume: an empty chamber has no pressure")]
    ChamberNotEmpty,
    /// Expansion of a hose.
    #[error("such that the hose holds oil at the operating pressure")]
    HoseHoldsOil,
    /// Least dynamic stiffening of a hose.
    #[error("at least 1: a hose is softest when it is slow")]
    AtLeastOneOfHose,
    /// Nominal dynamic stiffening.
    #[error("at least the minimum")]
    AtLeastMinimum,
    /// Greatest dynamic stiffening.
    #[error("at least the nominal")]
    AtLeastNominal,
    /// Modulus of a wall in fast motion.
    #[error("at least the static modulus: a wall is softest when it is slow")]
    AtLeastStaticModulus,
    /// Modulus of a hose with fixed ends.
    #[error("positive, or the wall would give energy")]
    PassiveWall,
    /// Static friction.
    #[error("at least the Coulomb friction")]
    AtLeastCoulomb,
    /// Dimensions of a linkage.
    #[error("one that closes over the stroke")]
    ClosedLinkage,
    /// Position at which a stage begins.
    #[error("after the transition before it, with its own within the stroke")]
    AfterTransition,
    /// Damping of a stop.
    #[error("zero where the element has neither `damping` nor `mass`: nothing moves against it")]
    NothingMovesAgainstStop,
    /// Line of a transmission.
    #[error("that of a hose or pipe: a plain volume has neither length nor bore")]
    HoseOrPipe,
    /// Filling pressure.
    #[error("above vacuum")]
    AboveVacuum,
    /// Supply pressure.
    #[error("above the tank pressure")]
    AboveTankPressure,
    /// Transition of a relief valve.
    #[error("at most the cracking pressure: a relief valve is shut at the pressure of the tank")]
    AtMostCrackingPressure,
    /// Lap of a spool.
    #[error("less than the full travel of the spool")]
    WithinTravel,
    /// Width of a hysteresis.
    #[error("above the threshold it includes")]
    AboveThreshold,
}

impl ParameterError {
    /// Error as reported by the owner of the component: `stroke` becomes `cylinder.stroke`.
    pub fn within(self, owner: &str) -> ParameterError {
        ParameterError { quantity: format!("{owner}.{}", self.quantity), ..self }
    }
}

/// Collects errors, so that all of a component are reported at once.
#[derive(Debug, Default)]
pub(crate) struct Problems(Vec<ParameterError>);

impl Problems {
    /// Records an error for `value` unless `holds`; a value that is not finite is always an error.
    pub(crate) fn require(
        &mut self,
        quantity: &str,
        value: f64,
        holds: bool,
        requirement: ParameterRequirement,
    ) {
        if !value.is_finite() {
            let requirement = ParameterRequirement::FiniteNumber;
            self.0.push(ParameterError { quantity: quantity.to_string(), value, requirement });
        } else if !holds {
            self.0.push(ParameterError { quantity: quantity.to_string(), value, requirement });
        }
    }

    /// Records an error for a value outside the range of its key.
    pub(crate) fn key(&mut self, key: Key, value: f64) {
        self.key_as(key.name, key, value);
    }

    /// Records an error for a value outside the range of its key, under another name.
    pub(crate) fn key_as(&mut self, quantity: &str, key: Key, value: f64) {
        self.within(quantity, value, key.range);
    }

    /// Records an error for a value that is not positive and has no key of its own.
    pub(crate) fn positive(&mut self, quantity: &str, value: f64) {
        self.within(quantity, value, AcceptedRange::POSITIVE);
    }

    /// Records an error for a negative value that has no key of its own.
    pub(crate) fn not_negative(&mut self, quantity: &str, value: f64) {
        self.within(quantity, value, AcceptedRange::NOT_NEGATIVE);
    }

    fn within(&mut self, quantity: &str, value: f64, range: AcceptedRange) {
        self.require(quantity, value, range.contains(value), ParameterRequirement::Within(range));
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
