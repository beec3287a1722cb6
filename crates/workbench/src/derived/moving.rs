use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::cylinder::{Cylinder, chamber_volumes};

use super::list::List;
use crate::quantity::MotionKind;

/// The moving part: cylinder or motor.
pub(super) fn moving(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let cylinder = &rig.actuator.components().cylinder;
    match list.motion {
        MotionKind::Linear => self::cylinder(rig, cylinder, list),
        MotionKind::Rotary => motor(rig, cylinder, list),
    }
}

fn motor(rig: &Rig, motor: &Cylinder, list: &mut List) {
    list.group("Motor");
    list.add("motor.displacement", "D", motor.area_a, "m3/rad", "declared");
    if let Some(stroke) = motor.stroke.length() {
        list.add("motor.swept_volume", "V", motor.area_a * stroke, "m3", "V = D Δθ, of each chamber");
    }
    let supply = &rig.actuator.components().supply;
    let stall = motor.area_a * (supply.pressure - supply.tank_pressure);
    list.add("motor.stall_torque", "T_max", stall, "N.m", "T_{max} = D (p_S - p_T)");
}

fn cylinder(rig: &Rig, cylinder: &Cylinder, list: &mut List) {
    list.group("Cylinder");
    list.add("cylinder.area_a", "A_A", cylinder.area_a, "m2", "A_A = π/4 (D_p^2 - D_{rA}^2)");
    list.add("cylinder.area_b", "A_B", cylinder.area_b, "m2", "A_B = π/4 (D_p^2 - D_{rB}^2)");
    for (index, [area_a, area_b]) in cylinder.areas_of_stages().enumerate().skip(1) {
        let name = |side: &str| format!("cylinder.stage_{}.area_{side}", index + 1);
        list.add(name("a"), "A_A", area_a, "m2", "declared, of this stage");
        list.add(name("b"), "A_B", area_b, "m2", "declared, of this stage");
    }
    if let Some(stroke) = cylinder.stroke.length() {
        let swept =
            chamber_volumes(&Cylinder { dead_volume_a: 0.0, dead_volume_b: 0.0, ..*cylinder }, stroke)[0];
        let emptied =
            chamber_volumes(&Cylinder { dead_volume_a: 0.0, dead_volume_b: 0.0, ..*cylinder }, 0.0)[1];
        let equations = match cylinder.stroke.telescope() {
            Some(_) => ["V_A = integral of A_A over the stroke", "V_B = integral of A_B over the stroke"],
            None => ["V_A = A_A L", "V_B = A_B L"],
        };
        list.add("cylinder.swept_volume_a", "V_A", swept, "m3", equations[0]);
        list.add("cylinder.swept_volume_b", "V_B", emptied, "m3", equations[1]);
    }
    let [pull, stall] = cylinder.stall_forces(&rig.actuator.components().supply);
    list.add("cylinder.stall_force", "F_max", stall, "N", "F_{max} = A_A p_S - A_B p_T");
    list.add("cylinder.stall_force_retracting", "F_min", pull, "N", "F_{min} = A_A p_T - A_B p_S");
}
