//! Implausible numbers: in nearly all cases a unit was intended and not written.

use super::Check;
use crate::Project;
use crate::listing::Listing;
use phea_quantity::display;

/// Usual ranges in SI: path, least, greatest, and the part.
const USUAL: [(&str, f64, f64, &str); 30] = [
    ("fluid.bulk_modulus", 1e9, 2.5e9, "fluids of hydraulics"),
    ("fluid.density", 700.0, 1300.0, "fluids of hydraulics"),
    ("fluid.kinematic_viscosity", 5e-6, 5e-4, "fluids of hydraulics"),
    ("fluid.entrained_air", 0.0, 0.02, "fluids of hydraulics"),
    ("supply.pressure", 1e6, 5e7, "supplies"),
    ("supply.flow", 5e-6, 2e-2, "pumps"),
    ("valve.natural_frequency", 60.0, 3000.0, "servovalves"),
    ("valve.nominal_flow", 5e-6, 2e-2, "servovalves"),
    ("valve.nominal_pressure_drop", 5e5, 3.5e7, "servovalves"),
    ("cylinder.piston_diameter", 0.01, 0.5, "pistons"),
    ("cylinder.rod_diameter", 0.005, 0.4, "rods"),
    ("cylinder.piston_area", 5e-5, 0.2, "pistons"),
    ("cylinder.stroke", 0.01, 6.0, "cylinders"),
    ("cylinder.moving_mass", 0.1, 1e4, "pistons with what is fixed to them"),
    ("motor.displacement", 1e-7, 1e-3, "motors"),
    ("motor.inertia", 1e-4, 10.0, "shafts with what is fixed to them"),
    ("motor.stroke", 0.5, 6.3, "vane actuators"),
    ("line.length", 0.05, 30.0, "lines"),
    ("line.bore", 0.003, 0.08, "hoses"),
    ("line.volume", 1e-6, 0.05, "lines"),
    ("force_sensor.stiffness", 1e6, 1e10, "load cells"),
    ("series.stiffness", 1e4, 1e8, "series springs"),
    ("series.travel", 1e-3, 0.1, "series springs"),
    ("series.coil.allowed_shear_stress", 2e8, 1.2e9, "spring steels"),
    ("series.coil.shear_modulus", 4e10, 9e10, "spring materials"),
    ("series.coil.density", 4000.0, 9000.0, "spring materials"),
    ("series.piston_area", 5e-5, 0.02, "pistons of transmissions"),
    ("series.filling_pressure", 1e5, 3.5e7, "transmissions"),
    ("series.line.length", 0.05, 30.0, "lines"),
    ("series.line.bore", 0.003, 0.08, "hoses"),
];
/// Factor below or above the range at which a number counts as implausible.
const BEYOND: f64 = 10.0;
/// Typical factors of a pressure whose unit is missing or wrong: bar, mega, kilo, giga.
const SLIPS_OF_PRESSURE: [f64; 5] = [1e5, 1e6, 1e3, 1e9, 1e-3];
/// Typical factor of a ratio: percent.
const SLIPS_OF_RATIO: [f64; 1] = [1e-2];
/// Typical factors of other quantities: milli, centi, L/min, kilo, mega, micro.
const SLIPS: [f64; 6] = [1e-3, 1e-2, 1e-3 / 60.0, 1e3, 1e6, 1e-6];

/// Warns about every implausible number that is declared.
pub(super) fn numbers(project: &Project, check: &mut Check<'_, '_>) {
    let mut listing = Listing::default();
    project.clone().visit_system(&mut listing);
    for (path, (key, value)) in &listing.numbers {
        let of_both = ["line.a.", "line.b."].iter().find_map(|side| path.strip_prefix(side));
        let plain = of_both.map_or_else(|| path.clone(), |rest| format!("line.{rest}"));
        if path == "force_sensor.stiffness" && project.motion().is_rotary() {
            continue;
        }
        let usual = USUAL.iter().find(|(name, ..)| *name == plain);
        let Some((_, least, most, of)) =
            usual.filter(|_| *value != 0.0 && !value.is_nan() && check.declared(path))
        else {
            continue;
        };
        if *value >= least / BEYOND && *value <= most * BEYOND {
            continue;
        }
        let words = |value: f64| display(value, key.dimension, 3);
        let slips: &[f64] = match key.dimension.si {
            "Pa" => &SLIPS_OF_PRESSURE,
            "1" => &SLIPS_OF_RATIO,
            _ => &SLIPS,
        };
        let meant = slips.iter().map(|slip| slip * value).find(|value| (*least..=*most).contains(value));
        let meant = meant.map_or(String::new(), |value| format!("; was {} meant?", words(value)));
        let message = format!(
            "`{}` is {}: {of} have {} to {}{meant}",
            key.name,
            words(*value),
            words(*least),
            words(*most)
        );
        check.warning(path, message);
    }
}
