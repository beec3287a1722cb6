use phea_engineering::rig::{Rig, series_coil, stall_force, waves_right_to};
use phea_engineering::setup::Setup;
use phea_engineering::sizing::CoilUnknown;
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use phea_hydraulics::line::{Conduit, StiffeningMember};
use phea_hydraulics::series::{CoilPair, LEAST_ACTIVE_COILS, SeriesElement, SeriesSpring, Transmission};

use super::list::List;
use crate::project::Project;
use crate::sizing::coil_unknown_words;

/// The part between force sensor and load.
pub(super) fn series(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let project = setup.project;
    let components = rig.actuator.components();
    match &components.series {
        None => {}
        Some(SeriesElement::Spring(element)) => spring(element, project, rig, list),
        Some(SeriesElement::Transmission(element)) => transmission(element, rig, list),
    }
}

/// The oil between two pistons, as seen by rod and load.
fn transmission(transmission: &Transmission, rig: &Rig, list: &mut List) {
    let fluid = &rig.actuator.components().fluid;
    let column = transmission.column(fluid, StiffeningMember::Nominal);
    let count = column.segments as f64;
    list.group("Transmission");
    list.add("series.stiffness_of_oil", "k", column.stiffness(), "N/m", "k = A^2/(C + 2 C_e)");
    list.add("series.reflected_mass", "m", count * column.mass, "kg", "m = A^2 ρ L/a");
    list.add("series.reflected_damping", "b", count * column.damping, "N.s/m", "b = 32 ν m/d^2");
    let conduit =
        Conduit::of_line(&transmission.line, fluid, transmission.filling_pressure, StiffeningMember::Nominal);
    if let (Ok(conduit), Some(right_to)) = (conduit, waves_right_to(rig)) {
        list.add("series.wave_travel_time", "T", conduit.delay(), "s", "T = L sqrt(ρ/β_e)");
        list.add("series.waves_right_to", "ω", right_to, "rad/s", "ω = 0.85 N/T, where waves are 3 % slow");
    }
    list.add("series.oil_volume", "V", transmission.oil_volume(), "m3", "V = a L + 2 V_e");
    let components = rig.actuator.components();
    let [_, extending] = components.cylinder.stall_forces(&components.supply);
    list.add("series.pressure_at_stall", "p", column.pressure(extending), "Pa", "p = p_0 + F_{max}/A");
    let tears = transmission.piston_area * (transmission.filling_pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE);
    list.add("series.pull_limit", "F", tears, "N", "F = A (p_0 + p_{atm})");
}

/// The spring and its winding.
fn spring(spring: &SeriesSpring, project: &Project, rig: &Rig, list: &mut List) {
    list.group("Series spring");
    let force = rig.point.hydraulic_force;
    list.add(
        "series.stiffness_at_point",
        "k_t",
        spring.stiffness_under(force),
        "N/m",
        "k_t = dF_f/dd at F_H",
    );
    let deflection = "F_f(d) = F_H";
    list.add("series.deflection_at_point", "d", spring.deflection_under(force), "m", deflection);
    let deflection = spring.deflection_under(stall_force(rig));
    list.add("series.deflection_at_stall", "d", deflection, "m", "F_f(d) = max(F_{max}, -F_{min})");
    if let Some(pair) = project.actuator.as_ref().and_then(|declared| series_coil(declared, rig)) {
        wound(&pair, list);
    }
}

/// The pair of coil springs that holds the stall force.
fn wound(pair: &CoilPair, list: &mut List) {
    let wahl = "K_w = (4 C - 1)/(4 C - 4) + 0.615/C";
    list.add("series.coil.wahl_factor", "K_w", pair.wahl_factor, "1", wahl);
    list.add("series.coil.wire_diameter", "d", pair.wire_diameter, "m", "d = sqrt(8 K_w F_{max} C/(π τ))");
    list.add("series.coil.coil_diameter", "D", pair.coil_diameter, "m", "D = C d");
    let coils = "n = G d/(4 C^3 k), either of two opposed springs";
    if pair.active_coils < LEAST_ACTIVE_COILS {
        let reason = coil_unknown_words(CoilUnknown::TooFewCoils);
        return list.absent("series.coil.active_coils", "n", "1", coils, reason);
    }
    list.add("series.coil.active_coils", "n", pair.active_coils, "1", coils);
    list.add("series.coil.solid_length", "L_s", pair.solid_length, "m", "L_s = (n + 2) d");
    let length = "L = 2 (L_s + 1.3 F_{max}/k), both at rest in their housing";
    list.add("series.coil.installed_length", "L", pair.installed_length, "m", length);
    list.add("series.coil.mass", "m", pair.mass, "kg", "m = 2 ρ (π d^2/4) π D (n + 2)");
}
