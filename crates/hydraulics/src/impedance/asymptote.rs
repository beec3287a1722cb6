use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;

use crate::linear::LinearParameters;
use crate::series::OilColumn;

/// Physical meaning of an asymptote of the driving-point impedance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AsymptoteKind {
    /// Valve leakage, or the feedback loop, yields.
    LowFrequency,
    /// Spring of the fluid in series with that of the sensor: K_eq/s.
    CompliancePlateau,
    /// Piston mass at rest between load and fluid: K_S/s.
    SensorLimit,
    /// Oil of a transmission at rest: the last of its springs, k_N+1/s.
    OilLimit,
}

/// Straight line of the impedance in a logarithmic plot, Z = coefficient s^power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asymptote {
    /// Physical meaning.
    pub kind: AsymptoteKind,
    /// Power of s: 1 for a mass (coefficient in kg), 0 for a damper (N s/m), -1 for a spring (N/m).
    pub power: i32,
    /// Mass, damping or stiffness; other units for other powers.
    pub coefficient: f64,
    /// Lower end of the range in which it is the nearest asymptote, rad/s.
    pub from: f64,
    /// Upper end of this range, rad/s.
    pub to: f64,
}

impl Asymptote {
    /// Z on the asymptote at a frequency in rad/s, N s/m.
    pub fn at_frequency(&self, frequency: f64) -> Complex64 {
        let s = Complex64::new(0.0, frequency);
        let factor = if self.power < 0 { 1.0 / s } else { s };
        (0..self.power.unsigned_abs()).fold(Complex64::new(self.coefficient, 0.0), |z, _| z * factor)
    }
}

/// Frequency sqrt(K_H/M) above which the piston's mass hides the added compliance from the load,
/// rad/s.
///
/// The load then moves the sensor's spring against a mass that no longer follows; a softer fluid
/// changes nothing.
///
/// # Example
/// Result for the thesis' hose:
/// ```
/// assert!((phea_hydraulics::impedance::compliance_hidden_above(2.233e6, 13.1) - 413.0).abs() < 0.5);
/// ```
pub fn compliance_hidden_above(hydraulic_stiffness: f64, moving_mass: f64) -> f64 {
    (hydraulic_stiffness / moving_mass).sqrt()
}

/// Asymptotes of the driving-point impedance, lowest frequency first; without a controller, those
/// of the open loop.
///
/// ```text
/// low frequency   open loop             (A^2 + f_v K_c)/K_c                          a damper
///                 G -> K_p              (A^2 + f_v K_c)/(K_c + A K_qU K_p)           a damper, about A/(K_qU K_p)
///                 G -> K_i/s            (A^2 + f_v K_c)/(A K_qU K_i) s               a mass, about A/(K_qU K_i)
///                 G -> K/s^n            (A^2 + f_v K_c)/(A K_qU K) s^n
/// plateau         K_eq/s                up to sqrt(K_H/M): the piston follows the load
/// limit           K_S/s                 above sqrt((K_H + K_S)/M): the piston is at rest
/// ```
///
/// The thesis (6.2.2) treats the plateau as the limit. An asymptote that is nowhere the nearest is
/// omitted: the first without leakage or feedback, the plateau if the piston's mass dominates
/// before the spring.
pub fn impedance_asymptotes(
    parameters: &LinearParameters,
    controller: Option<&TransferFunction>,
) -> Vec<Asymptote> {
    let LinearParameters { useful_area: area, moving_mass: mass, .. } = *parameters;
    let leak = parameters.flow_pressure_coefficient;
    let spring = parameters.equivalent_stiffness();
    let numerator = area * area + parameters.viscous_friction * leak;
    let (coefficient, power) = match controller.map(low_frequency_behaviour) {
        None => (numerator / leak, 0),
        Some((gain, 0)) => (numerator / (leak + area * parameters.flow_gain * gain), 0),
        Some((gain, integrators)) if integrators > 0 => {
            (numerator / (area * parameters.flow_gain * gain), integrators)
        }
        Some(_) => (numerator / leak, 0),
    };
    // |coefficient| w^power = K_eq/w
    let crossing = portable::pow(spring / coefficient.abs(), 1.0 / f64::from(power + 1));
    let hidden = compliance_hidden_above(parameters.hydraulic_stiffness, mass);
    let springs = parameters.hydraulic_stiffness + parameters.sensor_stiffness;
    let asymptote = |kind, power, coefficient, from, to| Asymptote { kind, power, coefficient, from, to };
    let limit = compliance_hidden_above(springs, mass);
    let mut asymptotes = vec![
        asymptote(AsymptoteKind::LowFrequency, power, coefficient, 0.0, crossing.min(limit)),
        asymptote(AsymptoteKind::CompliancePlateau, -1, spring, crossing, hidden),
        asymptote(AsymptoteKind::SensorLimit, -1, parameters.sensor_stiffness, limit, f64::INFINITY),
    ];
    asymptotes.retain(|line| line.coefficient.is_finite() && line.from < line.to);
    asymptotes
}

/// Asymptotes with a transmission between sensor and load: its oil comes to rest before the
/// piston's mass does, and at low frequency friction and mass of the oil act independently of the
/// loop.
///
/// ```text
/// low frequency   N b + Z               and for a mass Z = M s:  N b up to N b/(M + N m), then (M + N m) s
/// limit           k_N+1/s               above sqrt((k_N + k_N+1)/m) of its last plug
/// ```
pub fn through_oil(asymptotes: Vec<Asymptote>, column: &OilColumn) -> Vec<Asymptote> {
    let springs = column.stiffness_behind(column.segments - 1) + column.end_stiffness;
    let limit = compliance_hidden_above(springs, column.mass);
    let kept = asymptotes.into_iter().filter(|line| line.kind != AsymptoteKind::SensorLimit);
    let kept = kept.map(|line| Asymptote { to: line.to.min(limit), ..line });
    let count = column.segments as f64;
    let (friction, oil) = (count * column.damping, count * column.mass);
    let kept = kept.flat_map(|line| match (line.kind, line.power) {
        (AsymptoteKind::LowFrequency, 0) => {
            vec![Asymptote { coefficient: line.coefficient + friction, ..line }]
        }
        (AsymptoteKind::LowFrequency, 1) => {
            let coefficient = line.coefficient + oil;
            let corner = friction / coefficient;
            let damper = Asymptote { power: 0, coefficient: friction, to: corner, ..line };
            vec![damper, Asymptote { coefficient, from: corner, ..line }]
        }
        _ => vec![line],
    });
    let own = Asymptote {
        kind: AsymptoteKind::OilLimit,
        power: -1,
        coefficient: column.end_stiffness,
        from: limit,
        to: f64::INFINITY,
    };
    kept.filter(|line| line.from < line.to).chain([own]).collect()
}

/// Low-frequency behaviour G(s) -> gain/s^integrators as s -> 0, for a continuous controller;
/// differentiators count negatively.
fn low_frequency_behaviour(controller: &TransferFunction) -> (f64, i32) {
    let origin = Complex64::new(0.0, 0.0);
    let split = |roots: &[Complex64]| {
        let at_origin = roots.iter().filter(|&&root| root == origin).count();
        let rest = roots.iter().filter(|&&root| root != origin);
        let product = rest.fold(Complex64::new(1.0, 0.0), |product, root| product * -root);
        (i32::try_from(at_origin).unwrap_or(i32::MAX), product)
    };
    let ((zeros, above), (poles, below)) = (split(controller.zeros()), split(controller.poles()));
    ((controller.gain() * above / below).re, poles.saturating_sub(zeros))
}
