//! Fragment of a project file with the identified valve.

use phea_engineering::identify::{COEFFICIENT_NAMES, Identification};

use super::answer::EITHER_SIGN;
use super::misfit::declared_misfit;
use crate::answer::{OutputFile, Word, in_toml};

/// The coefficient that a project leaves out where it may be zero.
const HYSTERESIS: &str = "hysteresis";

/// The table `[valve]` of a project with what was identified: what the data do not determine is a
/// comment.
pub fn files(found: &Identification) -> Vec<OutputFile> {
    let numbers = found.coefficients.to_array();
    let line = |index: usize| {
        let (name, unit) = COEFFICIENT_NAMES.get(index).copied().unwrap_or_default();
        let value = numbers.get(index).copied().unwrap_or(f64::NAN);
        let key = match name {
            "leakage_shape" if found.tested.terms.leakage_by_edge => "supply_to_a",
            name => name.rsplit('.').next().unwrap_or(name),
        };
        let text = match unit {
            "1" | "m3/(s.Pa^0.5)" => in_toml(value, 5),
            unit => format!("\"{} {unit}\"", in_toml(value, 5)),
        };
        match found.estimates.get(index).copied().flatten().map(|estimate| estimate.interval) {
            Some([low, high]) if low == 0.0 && name == HYSTERESIS => {
                format!("# {key}: at most {} V\n", in_toml(high, 4))
            }
            Some([low, high]) if low == 0.0 && !EITHER_SIGN.contains(&name) => {
                format!("{key} = {text}    # 95 %: at most {}\n", in_toml(high, 4))
            }
            Some([low, high]) => {
                let ends = [low, high].map(|end| in_toml(end, 4));
                format!("{key} = {text}    # 95 %: {} to {}\n", ends[0], ends[1])
            }
            None => format!("# {key}: the data do not determine it\n"),
        }
    };
    let lines = |range: std::ops::Range<usize>| range.map(line).collect::<String>();
    let has = found.tested.terms;
    let whole = [
        if has.leakage_by_edge { lines(9..12) } else { lines(8..12) },
        if has.saturation { line(14) } else { String::new() },
    ];
    let mut more = String::new();
    if has.lap {
        more.push_str(&format!("\n[valve.lap]    # over full travel\n{}", lines(12..14)));
    }
    if has.leakage_by_edge {
        let shapes = line(8) + &lines(15..18);
        more.push_str(&format!("\n[valve.leakage_shapes]\n{shapes}"));
    }
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let misfit = declared_misfit(found).map(|one| format!("misfit = {}\n", one.in_toml()));
    let misfit = misfit.unwrap_or_default();
    let text = format!(
        "# Identified by phea from {}.\n[valve]\nnominal_voltage = \"{} V\"\ntransition_pressure = \"{} Pa\"\ntare_pressure = \"{} Pa\"\nleakage_model = \"{}\"\n{}{misfit}\n[valve.flow_coefficients]    # m3/(s.Pa^0.5)\n{}\n[valve.leakage_coefficients]\n{}{more}",
        files.join(", "),
        in_toml(found.tested.nominal_voltage, 6),
        in_toml(found.tested.transition_pressure, 6),
        in_toml(found.tested.tare_reference_drop, 6),
        found.tested.leakage_model.word(),
        whole.concat(),
        lines(0..4),
        lines(4..8),
    );
    vec![OutputFile { name: "valve.toml".to_string(), bytes: text.into_bytes() }]
}
