//! The impedance of a loop at its port, and the virtual impedance that is required of it.

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, VirtualImpedance};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_hydraulics::impedance::{
    Asymptote, AsymptoteKind, compliance_hidden_above, impedance_asymptotes, through_oil,
};
use phea_hydraulics::plant::{LinearElement, LinearLoad, LinearPlant};
use phea_qft::closed_loop::Compensation;

use crate::rig::Rig;

/// Frequencies at which both impedances are reported, rad/s.
pub const REPORTED_AT_RAD_PER_S: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];
/// Largest difference of the impedance of the loop from the required one, percent, at which it
/// still follows it.
pub const WITHIN_PERCENT: f64 = 10.0;
/// Range of frequencies of the search for the band, rad/s, and their number.
const EVALUATED_RAD_PER_S: [f64; 2] = [1e-2, 1e4];
const COUNT: usize = 1201;

/// Impedance that is required at a port, and impedance of the loop, with the load at the port moved
/// from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct RequiredImpedance {
    /// Required impedance: Z_v/s at the port.
    pub impedance: VirtualImpedance,
    /// Both impedances at the frequencies [`REPORTED_AT_RAD_PER_S`].
    pub points: Vec<ComparedImpedance>,
    /// Widest band in which they differ by at most [`WITHIN_PERCENT`], rad/s; `None` if there is
    /// none.
    pub follows_rad_per_s: Option<[f64; 2]>,
}

/// Both impedances at one frequency, N s/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedImpedance {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Required impedance, M_v s + B_v + K_v/s, without the filter.
    pub required: Complex64,
    /// Impedance of the loop, -F_e/(s X_L); at its sampling instants if it samples.
    pub achieved: Complex64,
}

impl RequiredImpedance {
    /// Required impedance without the filter of the measured position: M_v s^2 + B_v s + K_v.
    pub(crate) fn unfiltered(&self) -> VirtualImpedance {
        VirtualImpedance { filter_time_s: 0.0, ..self.impedance }
    }
}

impl ComparedImpedance {
    /// Relative difference between the impedance of the loop and the required one.
    pub fn difference(&self) -> f64 {
        portable::magnitude(self.achieved / self.required - 1.0)
    }
}

/// Both impedances of a rig with this controller, to which the sensor H feeds back the force;
/// `None` without a virtual impedance.
///
/// ```text
/// F_e/X_L = y/X_L - Z_v,     y/X_L = (F_e/X_L + Z_v)/(1 + L)                  with L of a load that does not yield
/// ```
///
/// # Errors
/// [`LinearError`] for a loop that cannot be closed.
pub(super) fn required_impedance(
    rig: &Rig,
    controller: &Controller,
    sensor: &TransferFunction,
) -> Result<Option<RequiredImpedance>, LinearError> {
    let Some(impedance) = rig.virtual_impedance else { return Ok(None) };
    let compensation = Compensation::new(controller, sensor.clone())?;
    let held = Rig {
        plant: LinearPlant { load: LinearLoad::Prescribed, ..rig.plant },
        in_motion: rig.in_motion.map(|moving| moving.of_load(LinearLoad::Prescribed)),
        ..rig.clone()
    }
    .in_loop();
    let member = match held.in_motion {
        Some(moving) => compensation.responding(Arc::new(moving)),
        None => compensation.member(held.plant.coefficients())?,
    };
    let at = |frequency: f64| {
        let response = member.response(frequency)?;
        let around = response.plant * response.sensor * compensation.feedback().at_frequency(frequency);
        let s = Complex64::new(0.0, frequency);
        let force = response.load_motion / (1.0 + around) - impedance.response(s);
        let unfiltered = VirtualImpedance { filter_time_s: 0.0, ..impedance };
        let required = unfiltered.response(s) / s;
        Some(ComparedImpedance { frequency_rad_per_s: frequency, required, achieved: -force / s })
    };
    let highest = compensation.highest_frequency_rad_per_s();
    let [from, to] = EVALUATED_RAD_PER_S;
    let all: Vec<ComparedImpedance> =
        logarithmic_grid(from, to.min(highest), COUNT)?.into_iter().filter_map(at).collect();
    let points =
        REPORTED_AT_RAD_PER_S.into_iter().filter(|frequency| *frequency < highest).filter_map(at).collect();
    Ok(Some(RequiredImpedance { impedance, points, follows_rad_per_s: widest(&all) }))
}

/// Widest band, in the logarithm of frequency, in which the loop follows the required impedance.
fn widest(all: &[ComparedImpedance]) -> Option<[f64; 2]> {
    let follows = |point: &ComparedImpedance| point.difference() <= WITHIN_PERCENT / 100.0;
    let bands = all.chunk_by(|one, other| follows(one) == follows(other));
    let bands = bands.filter(|band| band.iter().all(follows));
    bands
        .max_by_key(|band| band.len())
        .and_then(|band| Some([band.first()?.frequency_rad_per_s, band.last()?.frequency_rad_per_s]))
}

/// Straight-line asymptotes of the impedance of a closed loop. The virtual impedance replaces the
/// compliance of the loop, in the range of its term of lowest order and while the loop acts.
pub(super) fn asymptotes(rig: &Rig, controller: &TransferFunction) -> Vec<Asymptote> {
    let mut lines = own_asymptotes(rig, Some(controller));
    let Some(VirtualImpedance { mass, damping, stiffness, .. }) = rig.virtual_impedance else {
        return lines;
    };
    let acts = lines.iter().find(|line| line.kind == AsymptoteKind::LowFrequency).map(|line| line.to);
    let gain = followed_at_rest(rig, controller);
    let (power, coefficient, to) = match (stiffness > 0.0, damping > 0.0) {
        (true, damped) => {
            let by_mass = if mass > 0.0 { (stiffness / mass).sqrt() } else { f64::INFINITY };
            let by_damper = if damped { stiffness / damping } else { f64::INFINITY };
            (-1, stiffness, by_mass.min(by_damper))
        }
        (false, true) => (0, damping, if mass > 0.0 { damping / mass } else { f64::INFINITY }),
        (false, false) => (1, mass, f64::INFINITY),
    };
    lines.retain(|line| line.kind != AsymptoteKind::LowFrequency);
    if let (Some(acts), Some(gain)) = (acts, gain) {
        let (kind, coefficient, to) = (AsymptoteKind::LowFrequency, gain * coefficient, to.min(acts));
        lines.insert(0, Asymptote { kind, power, coefficient, from: 0.0, to });
    }
    lines
}

/// Mass that hides the compliance of the chambers from the load at high frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HidingMass {
    /// Mass of the piston, above sqrt(K_H/M).
    Piston,
    /// Mass of the oil in a transmission, referred to its pistons: above sqrt(K_eq/m).
    Oil,
}

/// Mass that hides the compliance, and the frequency above which it does, rad/s: the lower one of
/// the two.
///
/// ```text
/// sqrt(K_H/M) of the piston,    sqrt(K_eq/m) of the oil, m = N m_j
/// ```
pub fn hidden_above(rig: &Rig) -> (HidingMass, f64) {
    let piston = compliance_hidden_above(rig.linear.hydraulic_stiffness, rig.linear.moving_mass);
    let oil = rig.plant.series.and_then(|series| match series.element {
        LinearElement::Oil(column) => Some(column.segments as f64 * column.mass),
        LinearElement::Spring(_) => None,
    });
    let oil = oil.map(|mass| compliance_hidden_above(rig.leaking().equivalent_stiffness(), mass));
    match oil.filter(|oil| *oil < piston) {
        Some(oil) => (HidingMass::Oil, oil),
        None => (HidingMass::Piston, piston),
    }
}

/// Asymptotes of the rig without a virtual impedance; without a controller, those of the open loop.
pub(super) fn own_asymptotes(rig: &Rig, controller: Option<&TransferFunction>) -> Vec<Asymptote> {
    let lines = impedance_asymptotes(&rig.leaking(), controller);
    match rig.plant.series.map(|series| series.element) {
        Some(LinearElement::Oil(column)) => through_oil(lines, &column),
        Some(LinearElement::Spring(_)) | None => lines,
    }
}

/// L/(1 + L) at zero frequency: 1 if the controller integrates.
fn followed_at_rest(rig: &Rig, controller: &TransferFunction) -> Option<f64> {
    if controller.poles().contains(&Complex64::ZERO) {
        return Some(1.0);
    }
    let around = rig.plant.coefficients().command.at_frequency(0.0) * controller.dc_gain();
    let followed = (around / (1.0 + around)).re;
    followed.is_finite().then_some(followed)
}
