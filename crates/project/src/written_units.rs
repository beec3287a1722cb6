//! Units in which a project is written, for numbers that follow from it.

use std::collections::BTreeMap;

use super::Loaded;
use phea_quantity::{
    DIMENSIONS, Dimension, DisplayUnit, FLOW, FORCE, LENGTH, MotionKind, PRESSURE, UnitScale, Units, parse,
};

/// Units that a project file and its settings use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenUnits {
    /// Units by SI unit and family, each with its number of uses, in order of appearance.
    used: BTreeMap<(&'static str, UnitFamily), Vec<(String, usize)>>,
}

/// Numbers of one dimension that are customarily written in one unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum UnitFamily {
    /// Elastic moduli, which have the dimension of a pressure.
    Modulus,
    /// Friction of seals, which is a small fraction of the forces of a rig.
    Friction,
    /// Positions and strokes, in addition to the lengths and bores of lines.
    Position,
    Other,
}

impl UnitFamily {
    fn of(name: &str) -> UnitFamily {
        let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
        match () {
            () if has(&["modulus"]) => UnitFamily::Modulus,
            () if has(&["coulomb", "static"]) => UnitFamily::Friction,
            () if has(&["position", "stroke", "distance"]) => UnitFamily::Position,
            () => UnitFamily::Other,
        }
    }

    /// Family whose units it uses if it has none of its own.
    fn otherwise(self) -> UnitFamily {
        if self == UnitFamily::Modulus { self } else { UnitFamily::Other }
    }
}

/// SI units that are never replaced: pure numbers, temperatures, and rad/s, since Hz would be
/// another number.
const KEPT: [&str; 5] = ["1", "%", "degC", "1/degC", "rad/s"];

/// Magnitudes outside which a number stays in SI units.
const HANDY: std::ops::Range<f64> = 1e-3..1e6;

impl WrittenUnits {
    /// Units of a project.
    ///
    /// # Example
    /// ```
    /// use phea_project::{STARTER, WrittenUnits, read};
    /// use phea_project::source::Memory;
    /// let loaded = read(&Memory::default().with("p.toml", STARTER), "p.toml", &[], &[])?;
    /// let units = WrittenUnits::of(&loaded);
    /// assert_eq!(units.displayed("supply.pressure", 70e5, "Pa"), (70.0, "bar".to_string()));
    /// assert_eq!(units.displayed("line.wave_number", 3.0, "1/m"), (3.0, "1/m".to_string()));
    /// # Ok::<(), phea_project::Refusal>(())
    /// ```
    pub fn of(loaded: &Loaded) -> WrittenUnits {
        WrittenUnits::written(&loaded.bytes, &loaded.settings)
    }

    /// Units of the bytes of a file and of settings.
    pub(super) fn written(bytes: &[u8], settings: &[String]) -> WrittenUnits {
        let mut units = WrittenUnits::default();
        units.take_in(&String::from_utf8_lossy(bytes));
        for setting in settings {
            let (key, value) = setting.split_once('=').unwrap_or_default();
            units.count(key, value.trim_matches(['"', '\'']));
        }
        units
    }

    /// Unit of each quantity of the project.
    pub(super) fn units(&self, motion: MotionKind) -> Units {
        let customary = Units::customary(motion);
        let unit = |family, of: &'static Dimension, customary| {
            let dimension = motion.dimension(of);
            let known = self.most(dimension.si, family).and_then(|symbol| Units::known(symbol, dimension));
            known.unwrap_or(customary)
        };
        Units {
            motion,
            force: unit(UnitFamily::Other, &FORCE, customary.force),
            position: unit(UnitFamily::Position, &LENGTH, customary.position),
            pressure: unit(UnitFamily::Other, &PRESSURE, customary.pressure),
            flow: unit(UnitFamily::Other, &FLOW, customary.flow),
        }
    }

    /// Most frequently written unit; among equally frequent ones, the first.
    fn most(&self, si: &'static str, family: UnitFamily) -> Option<&str> {
        let used = self.used.get(&(si, family)).or_else(|| self.used.get(&(si, family.otherwise())))?;
        used.iter().rev().max_by_key(|(_, count)| *count).map(|(unit, _)| unit.as_str())
    }

    /// Number in the unit that the project uses most often for such numbers; otherwise in the
    /// customary unit, or in the SI unit if there is none, or if the number would be far from one.
    pub fn displayed(&self, name: &str, value: f64, si: &'static str) -> (f64, String) {
        let dimension = DIMENSIONS.iter().find(|dimension| dimension.si == si);
        let family = UnitFamily::of(name);
        let unit = self.most(si, family).or_else(|| customary(si, family));
        let in_si = unit
            .zip(dimension)
            .and_then(|(unit, dimension)| Some((UnitScale::new(unit, dimension).ok()?.read("1")?, unit)));
        let displayed = in_si.map(|(one, unit)| (value / one, unit.to_string()));
        let is_handy = |(number, _): &(f64, String)| *number == 0.0 || HANDY.contains(&number.abs());
        displayed.filter(is_handy).unwrap_or_else(|| (value, si.to_string()))
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

/// Unit of [`Units::customary`] for numbers of an SI unit.
fn customary(si: &'static str, family: UnitFamily) -> Option<&'static str> {
    let linear = Units::customary(MotionKind::Linear);
    let known = [
        (FORCE.si, UnitFamily::Other, linear.force),
        (LENGTH.si, UnitFamily::Position, linear.position),
        (PRESSURE.si, UnitFamily::Other, linear.pressure),
        (FLOW.si, UnitFamily::Other, linear.flow),
    ];
    let is_of = |(of, whose, _): &&(&str, UnitFamily, DisplayUnit)| *of == si && *whose == family;
    known.iter().find(is_of).map(|(_, _, unit)| unit.symbol)
}

#[cfg(test)]
mod tests {
    use super::{MotionKind, WrittenUnits};

    /// The expansion of a hose and an area have one dimension, but separate units.
    #[test]
    fn an_expansion_is_no_area() {
        let mut units = WrittenUnits::default();
        units.take_in("volumetric_expansion = \"6 mL/m\"");
        assert_eq!(units.displayed("line.volumetric_expansion", 9.6e-6, "m3/m").1, "mL/m");
        assert_eq!(units.displayed("cylinder.area_a", 3e-3, "m2"), (3e-3, "m2".to_string()));
        units.take_in("area_a = \"31 cm2\"");
        assert_eq!(units.displayed("cylinder.area_a", 3e-3, "m2").1, "cm2");
    }

    /// Friction and the lengths of lines do not affect the units of forces and positions; a project
    /// without units is shown in the customary ones.
    #[test]
    fn a_quantity_has_the_unit_of_its_own_numbers() {
        let units = |text: &str, motion| {
            let units = WrittenUnits::written(text.as_bytes(), &[]).units(motion);
            [units.force, units.position, units.pressure, units.flow].map(|unit| unit.symbol)
        };
        let text =
            "coulomb = \"80 N\"\nstatic = \"120 N\"\nforce = \"4 kN\"\nlength = \"2 m\"\nstroke = \"80 mm\"";
        assert_eq!(units(text, MotionKind::Linear), ["kN", "mm", "bar", "L/min"]);
        let text = "load_force = \"300 N\"\npressure = \"7 MPa\"\nflow = \"2 gpm\"";
        assert_eq!(units(text, MotionKind::Linear), ["N", "mm", "MPa", "gpm"]);
        assert_eq!(units("", MotionKind::Linear), ["kN", "mm", "bar", "L/min"]);
        assert_eq!(units("force = \"2 kN.m\"", MotionKind::Rotary), ["kN.m", "deg", "bar", "L/min"]);
    }
}
