use phea_engineering::linearize::{stiffness_models, stroke_stiffness};
use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::line::{Line, StiffeningMember};

use super::list::List;
use crate::quantity::{LENGTH, STIFFNESS};

/// The stiffness of the oil over the stroke.
pub(super) fn stiffness(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let declared = stroke_stiffness(rig, StiffeningMember::Nominal);
    list.group("Stiffness");
    let motion = list.motion;
    let (symbol, unit) = (motion.symbols().stiffness, list.si(&STIFFNESS));
    let [least, greatest] = motion.either(
        ["K_H = min over x of A_A^2/C_A + A_B^2/C_B", "K_H = max over x of A_A^2/C_A + A_B^2/C_B"],
        ["K_θ = min over θ of D^2 (1/C_A + 1/C_B)", "K_θ = max over θ of D^2 (1/C_A + 1/C_B)"],
    );
    list.add("stiffness.minimum", symbol, declared.minimum, unit, least);
    if components.cylinder.stroke.length().is_some() {
        let (name, flat) = motion.either(
            ("stiffness.minimum_position", "dK_H/dx = 0"),
            ("stiffness.minimum_angle", "dK_θ/dθ = 0"),
        );
        let place = motion.symbols().position;
        list.add(name, place, declared.minimum_position, list.si(&LENGTH), flat);
    }
    list.add("stiffness.maximum", symbol, declared.maximum, unit, greatest);
    let models = stiffness_models(rig);
    let uniform = motion.either("C_A = (V_{ho} + V_{A0} + A_A x)/β_e", "C_A = (V_{ho} + V_{A0} + D θ)/β_e");
    list.add("stiffness.uniform.minimum", symbol, models.uniform.minimum, unit, uniform);
    list.add("stiffness.uniform.maximum", symbol, models.uniform.maximum, unit, uniform);
    let by_volume = motion.either("C_A = C_{ho} + (V_{A0} + A_A x)/β_0", "C_A = C_{ho} + (V_{A0} + D θ)/β_0");
    list.add("stiffness.by_volume.minimum", symbol, models.by_volume.minimum, unit, by_volume);
    list.add("stiffness.by_volume.maximum", symbol, models.by_volume.maximum, unit, by_volume);
    if let Line::Hose { .. } = components.line_a {
        let soft = stroke_stiffness(rig, StiffeningMember::Minimum).minimum;
        let equation =
            motion.either("least K_H at the least stiffening r_β", "least K_θ at the least stiffening r_β");
        list.add("stiffness.minimum_softest_wall", symbol, soft, unit, equation);
        let stiff = stroke_stiffness(rig, StiffeningMember::Maximum).maximum;
        let equation = motion.either(
            "greatest K_H at the greatest stiffening r_β",
            "greatest K_θ at the greatest stiffening r_β",
        );
        list.add("stiffness.maximum_stiffest_wall", symbol, stiff, unit, equation);
    }
}
