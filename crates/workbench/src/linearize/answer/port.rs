//! Impedance at the load, its passivity, and what a virtual impedance requires of it, for programs.

use num_complex::Complex64;
use phea_dynamics::frequency::PassivityReport;
use phea_dynamics::portable::{argument, magnitude};
use phea_engineering::linearize::{
    ComparedImpedance, Linearization, PortView, RequiredImpedance, WITHIN_PERCENT,
};
use phea_hydraulics::impedance::{Asymptote, AsymptoteKind};

use super::super::no_closed_impedance_words;
use super::{FactorsAnswer, factors};
use crate::answer::{Answer, OrReason, words};
use crate::quantity::{DAMPING, MASS, QuantityName, STIFFNESS};

/// Driving-point impedances at the load, -F_e/(s X_L).
#[derive(Answer)]
pub(super) struct ImpedancesAnswer {
    /// Impedance with constant command.
    open_loop: ImpedanceAnswer,
    /// Impedance with the given controller.
    closed_loop: OrReason<ImpedanceAnswer>,
}

/// Driving-point impedance as a transfer function, with its asymptotes.
#[derive(Answer)]
struct ImpedanceAnswer {
    #[answer(flatten)]
    factors: FactorsAnswer,
    /// Asymptotes in the order of frequency.
    asymptotes: Vec<AsymptoteAnswer>,
}

/// Asymptote Z = coefficient s^power of an impedance.
#[derive(Answer)]
struct AsymptoteAnswer {
    /// Origin of the asymptote.
    kind: AsymptoteKind,
    /// Mass, damping or stiffness, by the power.
    coefficient: f64,
    /// Power of s: 1 for a mass, 0 for a damper, -1 for a spring.
    power: i32,
    /// Lower end of the range in which it is the nearest asymptote.
    from_rad_per_s: f64,
    /// Upper end of this range.
    to_rad_per_s: f64,
}

words! {
    /// Origin of an asymptote of an impedance: the loop or the leakage of the valve at low
    /// frequency, the compliance of fluid and sensor in series, the sensor alone in front of a
    /// piston at rest, or the last spring of a transmission whose oil is at rest.
    AsymptoteKind {
        LowFrequency => "low_frequency",
        CompliancePlateau => "compliance_plateau",
        SensorLimit => "sensor_limit",
        OilLimit => "oil_limit",
    }
}

/// Passivity of the driving-point impedances at the load.
#[derive(Answer)]
pub(super) struct PassivitiesAnswer {
    /// Passivity with constant command.
    open_loop: PassivityAnswer,
    /// Passivity with the given controller.
    closed_loop: OrReason<PassivityAnswer>,
}

/// Passivity of a driving-point impedance Z.
#[derive(Answer)]
pub(crate) struct PassivityAnswer {
    /// True if Z is passive.
    passive: bool,
    /// Poles of Z in the right half plane.
    right_half_plane_poles: Vec<Complex64>,
    /// Frequencies of the poles of Z on the imaginary axis, in rad/s.
    imaginary_poles: Vec<f64>,
    /// Bands from the lower to the upper frequency in rad/s in which Re Z is negative.
    #[answer(interval)]
    bands: Vec<[f64; 2]>,
}

/// Virtual impedance that is required of the port, compared with the impedance of the loop.
#[derive(Answer)]
pub(super) struct VirtualImpedanceAnswer {
    /// Virtual stiffness K_v.
    #[answer(key = QuantityName::moving("stiffness", &STIFFNESS))]
    stiffness: f64,
    /// Virtual damping B_v.
    #[answer(key = QuantityName::moving("damping", &DAMPING))]
    damping: f64,
    /// Virtual mass or inertia M_v.
    #[answer(key = QuantityName::OfMotion(["mass", "inertia"], &MASS))]
    mass: f64,
    /// Time constant of the filter of the measured position.
    filter_time_s: f64,
    /// Difference, of the required impedance, up to which the impedance of the loop follows it.
    within_percent: f64,
    /// Widest band, from the lower to the upper frequency, in which the impedance of the loop
    /// follows the required one.
    #[answer(interval)]
    follows_rad_per_s: OrReason<[f64; 2]>,
    /// Both impedances at selected frequencies.
    points: Vec<VirtualImpedancePointAnswer>,
}

/// Required impedance and that of the loop at one frequency.
#[derive(Answer)]
struct VirtualImpedancePointAnswer {
    /// Frequency of the comparison.
    frequency_rad_per_s: f64,
    /// Magnitude of the required impedance M_v s + B_v + K_v/s.
    #[answer(key = QuantityName::moving("required", &DAMPING))]
    required_magnitude: f64,
    /// Magnitude of the impedance of the loop.
    #[answer(key = QuantityName::moving("achieved", &DAMPING))]
    achieved_magnitude: f64,
    /// Required impedance, real and imaginary part.
    #[answer(key = QuantityName::moving("required_complex", &DAMPING))]
    required: Complex64,
    /// Impedance -F_e/(s X_L) of the loop, real and imaginary part.
    #[answer(key = QuantityName::moving("achieved_complex", &DAMPING))]
    achieved: Complex64,
    /// Phase of the impedance of the loop less that of the required one, within half a turn.
    phase_difference_deg: f64,
}

/// Force or torque that remains after a step of the position by 0.001.
#[derive(Answer)]
pub(super) struct FinalForcesAnswer {
    /// Value with constant command.
    open_loop: OrReason<f64>,
    /// Value with the given controller.
    closed_loop: OrReason<f64>,
}

/// A property of the port of the closed loop, or the reason why there is none.
fn closed_loop<Of>(linearization: &Linearization, of: impl FnOnce(&PortView) -> Of) -> OrReason<Of> {
    let reason = linearization.closed_loop_absent.map_or("", no_closed_impedance_words);
    OrReason::new(linearization.closed_loop.as_ref().map(of), reason)
}

pub(super) fn impedances(linearization: &Linearization) -> ImpedancesAnswer {
    ImpedancesAnswer {
        open_loop: impedance(&linearization.open_loop),
        closed_loop: closed_loop(linearization, impedance),
    }
}

fn impedance(view: &PortView) -> ImpedanceAnswer {
    ImpedanceAnswer {
        factors: factors(&view.impedance),
        asymptotes: view.asymptotes.iter().map(asymptote).collect(),
    }
}

fn asymptote(asymptote: &Asymptote) -> AsymptoteAnswer {
    AsymptoteAnswer {
        kind: asymptote.kind,
        coefficient: asymptote.coefficient,
        power: asymptote.power,
        from_rad_per_s: asymptote.from,
        to_rad_per_s: asymptote.to,
    }
}

pub(super) fn passivities(linearization: &Linearization) -> PassivitiesAnswer {
    PassivitiesAnswer {
        open_loop: passivity(&linearization.open_loop.passivity),
        closed_loop: closed_loop(linearization, |view| passivity(&view.passivity)),
    }
}

pub(crate) fn passivity(report: &PassivityReport) -> PassivityAnswer {
    PassivityAnswer {
        passive: report.passive,
        right_half_plane_poles: report.right_half_plane_poles.clone(),
        imaginary_poles: report.imaginary_poles.iter().map(|pole| pole.frequency_rad_per_s).collect(),
        bands: report.bands.iter().map(|band| [band.from_rad_per_s, band.to_rad_per_s]).collect(),
    }
}

pub(super) fn virtual_impedance(required: &RequiredImpedance) -> VirtualImpedanceAnswer {
    VirtualImpedanceAnswer {
        stiffness: required.impedance.stiffness,
        damping: required.impedance.damping,
        mass: required.impedance.mass,
        filter_time_s: required.impedance.filter_time_s,
        within_percent: WITHIN_PERCENT,
        follows_rad_per_s: OrReason::new(required.follows_rad_per_s, "nowhere within that"),
        points: required.points.iter().map(virtual_impedance_point).collect(),
    }
}

fn virtual_impedance_point(point: &ComparedImpedance) -> VirtualImpedancePointAnswer {
    VirtualImpedancePointAnswer {
        frequency_rad_per_s: point.frequency_rad_per_s,
        required_magnitude: magnitude(point.required),
        achieved_magnitude: magnitude(point.achieved),
        required: point.required,
        achieved: point.achieved,
        phase_difference_deg: phase_difference_deg(point),
    }
}

pub(super) fn final_forces(linearization: &Linearization) -> FinalForcesAnswer {
    let unstable = linearization
        .motion
        .either("unstable: the force has no final value", "unstable: the torque has no final value");
    let closed_loop = linearization.closed_loop.as_ref().and_then(|view| view.final_force_n);
    let reason = linearization.closed_loop_absent.map_or(unstable, no_closed_impedance_words);
    FinalForcesAnswer {
        open_loop: OrReason::new(linearization.open_loop.final_force_n, unstable),
        closed_loop: OrReason::new(closed_loop, reason),
    }
}

/// Phase of the impedance of the loop less that of the required one, within half a turn.
pub(crate) fn phase_difference_deg(point: &ComparedImpedance) -> f64 {
    argument(point.achieved / point.required).to_degrees()
}
