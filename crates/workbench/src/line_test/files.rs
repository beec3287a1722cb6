use phea_hydraulics::fluid::EntrainedAir;
use phea_hydraulics::line::Line;

use super::{KnownLine, LineIdentification};
use crate::answer::{OutputFile, significant};
use crate::project::{DeclaredMisfit, LineSide};

/// Digits of the numbers of a fragment.
const DIGITS: usize = 6;

/// The fragment of a project with the line as identified; none if nothing was identified.
pub fn files(found: &LineIdentification) -> Vec<OutputFile> {
    let Some(keys) = keys(found) else { return Vec::new() };
    let misfit = misfit(found).unwrap_or_default();
    let head = "# The line, identified by phea from recordings with its far end blocked. Put these keys into the\n# project's own tables in place of those that are there.\n";
    vec![OutputFile::new("line.toml", format!("{head}{keys}{misfit}"))]
}

/// Tables with their keys.
fn keys(found: &LineIdentification) -> Option<String> {
    let number = |value: f64, unit: &str| format!("\"{} {unit}\"", significant(value, DIGITS));
    let volume = found.known.volume();
    let table = format!("[{}]", path(&found.known));
    let rest = found.effective_bulk_modulus.as_ref().ok().map(|number| volume / number.value);
    let fast = found.dynamic_bulk_modulus.as_ref().ok().map(|number| volume / number.value);
    match found.known.line {
        Line::Volume { .. } => {
            let modulus = volume / rest.or(fast)?;
            let (volume, modulus) = (number(volume, "m3"), number(modulus, "Pa"));
            Some(format!("{table}\nvolume = {volume}\neffective_bulk_modulus = {modulus}\n"))
        }
        Line::Pipe { pipe, .. } => {
            let oil = 1.0 / (rest.or(fast)? / volume - pipe.wall_compliance());
            let modulus = number(found.known.liquid_modulus(oil, found.pressure)?, "Pa");
            Some(format!("[fluid]\nbulk_modulus = {modulus}\n"))
        }
        Line::Hose { hose, length } => {
            let oil = found.known.fluid_compliance(found.pressure)?;
            let slope = (rest.or(fast)? - oil) / length;
            let stiffening = found.dynamic_stiffening.as_ref().ok();
            let ratio = stiffening.map_or(1.0, |number| number.value);
            if slope <= 0.0 {
                return None;
            }
            let expansion = number(hose.operating_expansion, "m2");
            let pressure = number(found.known.pressure, "Pa");
            let mut keys = format!(
                "{table}\nvolumetric_expansion = {expansion}   # as before, at the pressure below\nvolumetric_expansion_pressure = {pressure}\nvolumetric_expansion_slope = {}\n",
                number(slope, "m2/Pa")
            );
            keys.push_str(&match stiffening {
                Some(found) => {
                    let [low, high] = found.interval.map(|end| significant(end.max(1.0), DIGITS));
                    // an estimate below 1 is noise: the schema has no wall that softens under
                    // pressure
                    let nominal = significant(ratio.max(1.0), DIGITS);
                    format!(
                        "dynamic_stiffening = {{ nominal = {nominal}, minimum = {low}, maximum = {high} }}\n"
                    )
                }
                None => "dynamic_stiffening = 1                 # not determined\n".to_string(),
            });
            if let Ok(time) = &found.relaxation_time {
                let time = format!("relaxation_time = {}\n", number(time.value, "s"));
                keys = if found.known.differs_from_other {
                    format!("[line]\n{time}\n{keys}")
                } else {
                    keys + &time
                };
            }
            Some(keys + &air(found))
        }
    }
}

/// The greatest misfit, as a table of the line.
fn misfit(found: &LineIdentification) -> Option<String> {
    let misfits = found.misfits();
    let greatest = misfits.iter().max_by(|one, other| one.fraction.total_cmp(&other.fraction))?;
    let at = Some(format!("{} of {}", greatest.signal, greatest.file));
    let entries = DeclaredMisfit { fraction: greatest.fraction, at }.entries().join("\n");
    Some(format!("\n[{}.misfit]\n{entries}\n", path(&found.known)))
}

/// The free air in the oil, if the pressure rise shows it.
fn air(found: &LineIdentification) -> String {
    let of = |air: EntrainedAir| {
        let [fraction, exponent] =
            [air.volume_fraction, air.polytropic_exponent].map(|value| significant(value, DIGITS));
        format!(
            "\n[fluid]\nentrained_air = {fraction}\npolytropic_exponent = {exponent}    # of the slow rise; in fast motion up to 1.4\n"
        )
    };
    let shown = found.entrained_air.as_ref().ok().and(found.known.fluid.entrained_air);
    shown.map_or_else(String::new, of)
}

/// Path of the table with the keys: that of both lines if the project declares them together.
fn path(known: &KnownLine) -> &'static str {
    match known.side {
        _ if !known.differs_from_other => "line",
        LineSide::A => "line.a",
        LineSide::B => "line.b",
    }
}
