use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;

use super::list::List;

/// Consequences of a virtual impedance: the frequency at which its terms are equal, and the
/// frequency at which its filter begins.
pub(super) fn impedance(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let Some(impedance) = rig.virtual_impedance else { return };
    list.group("Virtual impedance");
    let (mass, damping, stiffness) = (impedance.mass, impedance.damping, impedance.stiffness);
    if stiffness > 0.0 && damping > 0.0 {
        let equation = "ω = K_v/B_v";
        list.add("impedance.spring_below", "ω", stiffness / damping, "rad/s", equation);
    }
    if stiffness > 0.0 && mass > 0.0 {
        let natural = (stiffness / mass).sqrt();
        list.add("impedance.natural_frequency", "ω_v", natural, "rad/s", "ω_v = sqrt(K_v/M_v)");
        let ratio = damping / (2.0 * (stiffness * mass).sqrt());
        list.add("impedance.damping_ratio", "ζ_v", ratio, "1", "ζ_v = B_v/(2 sqrt(K_v M_v))");
    }
    if let Some(corner) = impedance.corner_rad_per_s() {
        list.add("impedance.filter_frequency", "1/τ", corner, "rad/s", "ω = 1/τ");
    }
    if stiffness > 0.0 {
        let ratio = stiffness / rig.leaking().equivalent_stiffness();
        list.add(
            "impedance.over_passive",
            "K_v/K_{eq}",
            ratio,
            "1",
            "K_v over K_{eq} of oil, sensor and series element, the load held still",
        );
    }
}
