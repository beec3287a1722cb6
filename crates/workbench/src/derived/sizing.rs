use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;

use super::linear::{FLOW_GAIN, SLOPES};
use super::list::List;

/// The values of the valve that `[sizing]` states, next to the derived ones.
pub(super) fn sizing(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let Some(sizing) = &setup.project.sizing else { return };
    list.group("Sizing");
    if let Some(flow_gain) = sizing.flow_gain {
        list.add("sizing.flow_gain", "K_qU", rig.derived.flow_gain, "m3/(s.V)", FLOW_GAIN);
        list.stated(flow_gain, "[sizing]", None);
    }
    if let Some(coefficient) = sizing.flow_pressure_coefficient {
        let derived = rig.derived.flow_pressure_coefficient;
        list.add("sizing.flow_pressure_coefficient", "K_c", derived, "m3/(s.Pa)", SLOPES);
        list.stated(coefficient, "[sizing]", None);
    }
}
