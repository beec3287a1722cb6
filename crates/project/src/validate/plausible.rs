//! Implausible numbers: in nearly all cases a unit was intended and not written.

use super::Check;
use crate::Project;
use crate::listing::Listing;
use phea_quantity::display;
use phea_table::UsualRange;

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
        // the usual numbers of a motion are those of a cylinder
        let usual = key.usual.filter(|_| !(key.of_motion && project.motion().is_rotary()));
        let Some(UsualRange { minimum, maximum, of }) =
            usual.filter(|_| *value != 0.0 && !value.is_nan() && check.declared(path))
        else {
            continue;
        };
        if *value >= minimum / BEYOND && *value <= maximum * BEYOND {
            continue;
        }
        let words = |value: f64| display(value, key.dimension, 3);
        let slips: &[f64] = match key.dimension.si {
            "Pa" => &SLIPS_OF_PRESSURE,
            "1" => &SLIPS_OF_RATIO,
            _ => &SLIPS,
        };
        let meant = slips.iter().map(|slip| slip * value).find(|value| (minimum..=maximum).contains(value));
        let meant = meant.map_or(String::new(), |value| format!("; was {} meant?", words(value)));
        let message = format!(
            "`{}` is {}: {of} have {} to {}{meant}",
            key.name,
            words(*value),
            words(minimum),
            words(maximum)
        );
        check.warning(path, message);
    }
}
