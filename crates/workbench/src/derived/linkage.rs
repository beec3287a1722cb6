use phea_engineering::linearize::{LinkagePosition, linkage_places};
use phea_engineering::rig::{Rig, rod_end};
use phea_engineering::setup::Setup;

use super::list::List;

/// The linkage at the operating point, and over the stroke.
pub(super) fn linkage(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let project = setup.project;
    let components = rig.actuator.components();
    let Some((end, weight)) = rod_end(components, &rig.point) else { return };
    list.group("Linkage");
    let declared = project.actuator.as_ref().and_then(|declared| declared.linkage.as_ref());
    let stroke = components.cylinder.stroke.length();
    if let Some(Ok(reduced)) = declared.zip(stroke).map(|(declared, stroke)| declared.reduced(stroke)) {
        let equation = "max |g(θ) - x| over the linkage or its table";
        list.add("linkage.polynomial_error", "δ", reduced.residual, "m", equation);
    }
    for place in linkage_places(rig) {
        let (angle, arm, mass) = match place.at {
            LinkagePosition::Retracted => {
                ("angle_retracted", "lever_arm_retracted", "reflected_mass_retracted")
            }
            LinkagePosition::Extended => ("angle_extended", "lever_arm_extended", "reflected_mass_extended"),
            LinkagePosition::OperatingPoint => {
                ("angle_at_point", "lever_arm_at_point", "reflected_mass_at_point")
            }
            LinkagePosition::LeastArm => ("angle_of_least_arm", "lever_arm_least", "reflected_mass_greatest"),
            LinkagePosition::GreatestArm => {
                ("angle_of_greatest_arm", "lever_arm_greatest", "reflected_mass_least")
            }
        };
        list.add(format!("linkage.{angle}"), "θ", place.angle_rad, "rad", "x = g(θ)");
        list.add(format!("linkage.{arm}"), "r", place.lever_arm_m, "m", "r = g'(θ) = τ/F = v/ω");
        if let Some(reflected) = place.reflected_mass_kg {
            list.add(format!("linkage.{mass}"), "m", reflected, "kg", "m = J/r^2");
        }
    }
    let force = rig.point.hydraulic_force;
    list.add("linkage.torque_at_point", "τ", force * end.lever_arm, "N.m", "τ = F_H r");
    if rig.load_moves() {
        let stiffness = -(force * end.lever_slope) / (end.lever_arm * end.lever_arm);
        list.add("linkage.geometric_stiffness", "k_g", stiffness, "N/m", "k_g = -F_H g''(θ)/r^2");
    }
    if let Some(weight) = weight {
        let arm = end.lever_arm;
        list.add("linkage.weight_torque", "τ_g", weight.torque, "N.m", "τ_g = -m g d cos(θ - θ_l)");
        list.add(
            "linkage.weight_held",
            "F_w",
            -weight.torque / arm,
            "N",
            "F_w = -τ_g/r, which holds the weight at the operating point",
        );
        let equation = "k_w = -m g d sin(θ - θ_l)/r^2";
        list.add("linkage.weight_stiffness", "k_w", weight.stiffness / (arm * arm), "N/m", equation);
    }
}
