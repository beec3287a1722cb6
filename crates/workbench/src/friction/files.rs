use phea_engineering::estimate::Estimate;
use phea_engineering::friction::{FrictionIdentification, OpenCoefficient, RETRACTING_NAMES};

use super::{because, declared_misfit, misfit_in_words};
use crate::answer::{OutputFile, in_toml};

/// The table `[cylinder.friction]` of a project with the identified values; coefficients that the
/// data do not determine are comments.
pub fn files(found: &FrictionIdentification) -> Vec<OutputFile> {
    let both = super::FRICTION_NAMES.iter().zip(&found.estimates).map(line);
    let lines: String = both.collect();
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let misfit = |one| format!("# {}: the intervals below do not cover it.\n", misfit_in_words(found, one));
    let misfits: String = found.misfits.iter().map(misfit).collect();
    let misfit = declared_misfit(found).map(|misfit| format!("misfit = {}\n", misfit.in_toml()));
    let misfit = misfit.unwrap_or_default();
    let back = found.retracting.as_ref().map(|back| retracting(found, back)).unwrap_or_default();
    let text = format!(
        "# Identified by phea from {}.\n{misfits}[cylinder.friction]\nmodel = \"lugre\"\n{lines}{misfit}{back}",
        files.join(", ")
    );
    vec![OutputFile::new("friction.toml", text)]
}

/// A key with its value and interval.
fn line(((name, unit), one): (&(&str, &str), &Result<Estimate, OpenCoefficient>)) -> String {
    let Estimate { value, interval } = match one {
        Err(open) => return format!("# {name}: not determined, {}\n", because(open)),
        Ok(estimate) => estimate,
    };
    let [low, high] = interval.map(|end| in_toml(end, 4));
    let value = in_toml(*value, 5);
    match *unit {
        "1" => format!("{name} = {value}    # 95 %: {low} to {high}\n"),
        unit => format!("{name} = \"{value} {unit}\"    # 95 %: {low} to {high}\n"),
    }
}

/// The table of the coefficients that differ while the rod retracts, and the range of the plant's
/// viscous friction over both directions.
fn retracting(found: &FrictionIdentification, back: &[Result<Estimate, OpenCoefficient>]) -> String {
    let lines: String = RETRACTING_NAMES.iter().zip(back).map(line).collect();
    let levels = found.lugre.curve.both_levels().map(|levels| levels.viscous);
    let [low, high] = [levels[0].min(levels[1]), levels[0].max(levels[1])].map(|end| in_toml(end, 5));
    format!(
        "\n[cylinder.friction.retracting]\n{lines}\n# A family that contains both directions has in [uncertainty]:\n# viscous_friction = {{ nominal = \"{low} N.s/m\", minimum = \"{low} N.s/m\", maximum = \"{high} N.s/m\" }}\n"
    )
}
