//! Unit of a printed quantity, from its name.

use super::dimension::{CURRENT, DIMENSIONS};

/// Endings of names whose unit is no SI unit of a dimension, with their units.
const OTHER_ENDINGS: [(&str, &str); 11] = [
    ("db", "dB"),
    ("hz", "Hz"),
    ("deg", "deg"),
    ("degc", "degC"),
    ("bar", "bar"),
    ("l_per_min", "L/min"),
    ("j", "J"),
    ("k", "K"),
    ("per_s", "1/s"),
    ("pa_per_v", "Pa/V"),
    ("rad_per_s2", "rad/s2"),
];

/// Unit of a quantity by the ending of its name, as a key of JSON or a column of a table has it;
/// `None` for a name that does not end in a unit. A time at the end of a name is not its unit:
/// `force_n_at_2.5_s` is a force.
///
/// # Example
/// ```
/// use phea_quantity::unit_of_name;
/// assert_eq!(unit_of_name("hydraulic_stiffness_n_m_per_rad"), Some("N.m/rad"));
/// assert_eq!(unit_of_name("force_n_at_2.5_s"), Some("N"));
/// assert_eq!(unit_of_name("cavitation_a"), None);
/// ```
pub fn unit_of_name(name: &str) -> Option<&'static str> {
    let quantity = without_time(name);
    // a single `a` is a chamber, and no printed quantity is a current
    let in_si = DIMENSIONS.iter().filter(|dimension| **dimension != &CURRENT && dimension.si != "1");
    let in_si = in_si.map(|dimension| (dimension.suffix(), dimension.si));
    let others = OTHER_ENDINGS.iter().map(|(ending, unit)| (ending.to_string(), *unit));
    let ends = |ending: &str| quantity.strip_suffix(ending).is_some_and(|rest| rest.ends_with('_'));
    let fitting = in_si.chain(others).filter(|(ending, _)| ends(ending));
    fitting.max_by_key(|(ending, _)| ending.len()).map(|(_, unit)| unit)
}

/// A name without the time at its end.
fn without_time(name: &str) -> &str {
    let Some((quantity, time)) = name.rsplit_once("_at_") else { return name };
    let is_time = time.strip_suffix("_s").is_some_and(|number| number.parse::<f64>().is_ok());
    if is_time { quantity } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ending of the name of every dimension has the unit of that dimension.
    #[test]
    fn every_ending_is_read_back() {
        for dimension in DIMENSIONS.iter().filter(|dimension| **dimension != &CURRENT) {
            let name = format!("value_{}", dimension.suffix());
            let expected = Some(dimension.si).filter(|unit| *unit != "1");
            assert_eq!(unit_of_name(&name), expected, "{name}");
        }
        for (ending, unit) in OTHER_ENDINGS {
            assert_eq!(unit_of_name(&format!("value_{ending}")), Some(unit));
        }
    }

    #[test]
    fn a_unit_follows_an_underscore() {
        assert_eq!([unit_of_name("s"), unit_of_name("gains"), unit_of_name("")], [None; 3]);
        assert_eq!(unit_of_name("time_at_s"), Some("s"));
    }
}
