//! A linkage over the stroke: lever arm, and the inertia of the load reflected to the rod.

use phea_hydraulics::plant::LinearLoad;

use crate::rig::{Rig, rod_end};

/// Number of positions at which the lever arm is evaluated to find its least and greatest value.
const POSITIONS: usize = 201;

/// Position of a linkage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkagePosition {
    /// The rod is at the start of the stroke.
    Retracted,
    /// The rod is at the end of the stroke.
    Extended,
    /// The rod is at the operating point.
    OperatingPoint,
    /// The lever arm is shortest.
    LeastArm,
    /// The lever arm is longest.
    GreatestArm,
}

impl LinkagePosition {
    /// Words for tables and JSON output.
    pub fn words(self) -> &'static str {
        match self {
            LinkagePosition::Retracted => "retracted",
            LinkagePosition::Extended => "extended",
            LinkagePosition::OperatingPoint => "operating point",
            LinkagePosition::LeastArm => "least lever arm",
            LinkagePosition::GreatestArm => "greatest lever arm",
        }
    }
}

/// A linkage at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkagePlace {
    /// Kind of the position.
    pub at: LinkagePosition,
    /// Position of the rod's end on the load's side, m.
    pub position_m: f64,
    /// Angle of the joint, rad.
    pub angle_rad: f64,
    /// Lever arm, m: torque over force, and velocity over angular velocity.
    pub lever_arm_m: f64,
    /// Reflected mass J/r^2, kg; `None` if the motion of the load is prescribed.
    pub reflected_mass_kg: Option<f64>,
}

/// Linkage of a rig at both ends of the stroke, at the operating point, and at its least and
/// greatest lever arm; empty without one.
pub fn linkage_places(rig: &Rig) -> Vec<LinkagePlace> {
    let components = rig.actuator.components();
    let (Some(linkage), Some(stroke)) = (&components.linkage, components.cylinder.stroke.length()) else {
        return vec![];
    };
    let here = rod_end(components, &rig.point);
    let inertia = match rig.plant.load {
        LinearLoad::Linked { inertia, .. } => Some(inertia),
        LinearLoad::Prescribed | LinearLoad::Yielding { .. } | LinearLoad::Free { .. } => None,
    };
    let place = |at: LinkagePosition, position_m: f64| {
        let angle_rad = linkage.angle(position_m);
        let lever_arm_m = linkage.end(angle_rad).lever_arm;
        let reflected_mass_kg = inertia.map(|inertia| inertia / (lever_arm_m * lever_arm_m));
        LinkagePlace { at, position_m, angle_rad, lever_arm_m, reflected_mass_kg }
    };
    let fraction = |number: usize| number as f64 / (POSITIONS - 1) as f64;
    let all: Vec<LinkagePlace> =
        (0..POSITIONS).map(|number| place(LinkagePosition::LeastArm, stroke * fraction(number))).collect();
    let by_arm = |one: &&LinkagePlace, other: &&LinkagePlace| one.lever_arm_m.total_cmp(&other.lever_arm_m);
    let least = all.iter().min_by(by_arm).copied();
    let greatest = all.iter().max_by(by_arm);
    let greatest = greatest.map(|place| LinkagePlace { at: LinkagePosition::GreatestArm, ..*place });
    let ends = [(LinkagePosition::Retracted, 0.0), (LinkagePosition::Extended, stroke)];
    let ends = ends.map(|(at, position)| place(at, position));
    let point = here.map(|(end, _)| place(LinkagePosition::OperatingPoint, end.position));
    ends.into_iter().chain(point).chain(least).chain(greatest).collect()
}
