//! The units in which a project is written, for numbers that follow from it.

use std::collections::BTreeMap;

use super::Loaded;
use phea_quantity::{DIMENSIONS, Dimension, UnitScale, parse};

/// The units that a project file and its settings use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenUnits {
    /// By SI unit and family, each with how often it is used, in order of appearance.
    used: BTreeMap<(&'static str, UnitFamily), Vec<(String, usize)>>,
}

/// Which numbers of one dimension people write in one unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum UnitFamily {
    /// Elastic moduli, which have the dimension of a pressure.
    Modulus,
    Other,
}

impl UnitFamily {
    fn of(name: &str) -> UnitFamily {
        if name.contains("modulus") { UnitFamily::Modulus } else { UnitFamily::Other }
    }
}

/// SI units that are never replaced: pure numbers, temperatures, and rad/s, whose Hz is another
/// number for the same symbol.
const KEPT: [&str; 5] = ["1", "%", "degC", "1/degC", "rad/s"];

/// Magnitudes beyond which a number stays in SI units.
const HANDY: std::ops::Range<f64> = 1e-3..1e6;

impl WrittenUnits {
    /// Those of a project.
    ///
    /// # Example
    /// ```
    /// use phea_project::{STARTER, WrittenUnits, read};
    /// use phea_project::source::Memory;
    /// let loaded = read(&Memory::default().with("p.toml", STARTER), "p.toml", &[], &[])?;
    /// let units = WrittenUnits::of(&loaded);
    /// assert_eq!(units.shown("supply.pressure", 70e5, "Pa"), (70.0, "bar".to_string()));
    /// assert_eq!(units.shown("line.wave_number", 3.0, "1/m"), (3.0, "1/m".to_string()));
    /// # Ok::<(), phea_project::Refusal>(())
    /// ```
    pub fn of(loaded: &Loaded) -> WrittenUnits {
        let mut units = WrittenUnits::default();
        units.take_in(&String::from_utf8_lossy(&loaded.bytes));
        for setting in &loaded.settings {
            let (key, value) = setting.split_once('=').unwrap_or_default();
            units.count(key, value.trim_matches(['"', '\'']));
        }
        units
    }

    /// A number in the unit in which the project writes such numbers, most often; the SI unit where
    /// it writes none, or where the number would be far from one.
    pub fn shown(&self, name: &str, value: f64, si: &'static str) -> (f64, String) {
        let used = self.used.get(&(si, UnitFamily::of(name)));
        // of several that are used as often, the first
        let most = used.and_then(|used| used.iter().rev().max_by_key(|(_, count)| *count));
        let dimension = DIMENSIONS.iter().find(|dimension| dimension.si == si);
        let in_si = most.zip(dimension).and_then(|((unit, _), dimension)| {
            Some((UnitScale::new(unit, dimension).ok()?.read("1")?, unit))
        });
        let shown = in_si.map(|(one, unit)| (value / one, unit.clone()));
        let is_handy = |(number, _): &(f64, String)| *number == 0.0 || HANDY.contains(&number.abs());
        shown.filter(is_handy).unwrap_or_else(|| (value, si.to_string()))
    }

    /// Counts the texts in quotes, each with the key before it.
    fn take_in(&mut self, text: &str) {
        for line in text.lines() {
            let mut key = "";
            let mut quoted = false;
            for part in line.split('"') {
                if quoted {
                    self.count(key, part);
                } else {
                    let (code, comment) =
                        part.split_once('#').map_or((part, false), |(code, _)| (code, true));
                    if let Some((before, _)) = code.rsplit_once('=') {
                        key = before.rsplit(['{', ',']).next().unwrap_or(before).trim();
                    }
                    if comment {
                        break;
                    }
                }
                quoted = !quoted;
            }
        }
    }

    /// Counts the unit of a value, if it is a number with one.
    fn count(&mut self, key: &str, text: &str) {
        let Some((_, unit)) = text.trim().split_once(' ') else { return };
        // the expansion of a hose, a volume per length, has the dimension of an area
        let is_expansion = key.contains("expansion");
        let is_of = |dimension: &&&Dimension| {
            let is_other = dimension.si == if is_expansion { "m2" } else { "m3/m" };
            !KEPT.contains(&dimension.si) && !is_other && parse(text, dimension).is_ok()
        };
        let Some(dimension) = DIMENSIONS.iter().find(is_of) else { return };
        let used = self.used.entry((dimension.si, UnitFamily::of(key))).or_default();
        match used.iter_mut().find(|(known, _)| known == unit.trim()) {
            Some((_, count)) => *count += 1,
            None => used.push((unit.trim().to_string(), 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::WrittenUnits;

    /// The expansion of a hose and an area have one dimension, and each its own unit.
    #[test]
    fn an_expansion_is_no_area() {
        let mut units = WrittenUnits::default();
        units.take_in("volumetric_expansion = \"6 mL/m\"");
        assert_eq!(units.shown("line.volumetric_expansion", 9.6e-6, "m3/m").1, "mL/m");
        assert_eq!(units.shown("cylinder.area_a", 3e-3, "m2"), (3e-3, "m2".to_string()));
        units.take_in("area_a = \"31 cm2\"");
        assert_eq!(units.shown("cylinder.area_a", 3e-3, "m2").1, "cm2");
    }
}
