//! Standard controllers by their textbook names.

/// Standard controller structure, in order of length: by number of poles, then by number of free
/// parameters.
///
/// ```text
/// PI          K_p (1 + 1/(T_i s))
/// PID         K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1))
/// low pass    1/(T_f s + 1)
/// notch       (s^2/w^2 + 2 d zeta s/w + 1)/(s^2/w^2 + 2 zeta s/w + 1)
/// lead        (s/z + 1)/(s/p + 1)
/// ```
///
/// # Example
/// ```
/// use phea_dynamics::controller::NamedStructure;
/// let poles = NamedStructure::ALL.map(NamedStructure::order);
/// assert!(poles.is_sorted());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedStructure {
    /// A gain.
    Proportional,
    /// An integrator.
    Integral,
    /// Proportional and integral.
    ProportionalIntegral,
    /// PI and a low pass of first order.
    PiLowPass,
    /// PID with a filtered derivative.
    Pid,
    /// PI and a notch.
    PiNotch,
    /// PI, a notch and a low pass of first order.
    PiNotchLowPass,
    /// PI, a notch and a lead.
    PiNotchLead,
    /// PI and two notches.
    PiTwoNotches,
}

impl NamedStructure {
    /// All structures, the shortest first.
    pub const ALL: [NamedStructure; 9] = [
        NamedStructure::Proportional,
        NamedStructure::Integral,
        NamedStructure::ProportionalIntegral,
        NamedStructure::PiLowPass,
        NamedStructure::Pid,
        NamedStructure::PiNotch,
        NamedStructure::PiNotchLowPass,
        NamedStructure::PiNotchLead,
        NamedStructure::PiTwoNotches,
    ];

    /// Number of poles.
    pub fn order(self) -> usize {
        match self {
            NamedStructure::Proportional => 0,
            NamedStructure::Integral | NamedStructure::ProportionalIntegral => 1,
            NamedStructure::PiLowPass | NamedStructure::Pid => 2,
            NamedStructure::PiNotch => 3,
            NamedStructure::PiNotchLowPass | NamedStructure::PiNotchLead => 4,
            NamedStructure::PiTwoNotches => 5,
        }
    }
}
