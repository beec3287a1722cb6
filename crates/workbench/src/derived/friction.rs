use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::friction::Friction;

use super::list::List;
use crate::quantity::DAMPING;

/// The viscous friction with which a LuGre model is passive.
pub(super) fn friction(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let Friction::LuGre(lugre) = &rig.actuator.components().friction else { return };
    list.group("Friction");
    let levels = lugre.curve.both_levels();
    let least =
        levels.map(|levels| levels.passive_viscous(lugre.bristle_damping)).into_iter().fold(0.0, f64::max);
    let equation = list
        .motion
        .either("σ_2 >= σ_1 (F_S - F_C)/F_C for passivity", "σ_2 >= σ_1 (T_S - T_C)/T_C for passivity");
    list.add("friction.passive_viscous_minimum", "σ_2", least, list.si(&DAMPING), equation);
}
