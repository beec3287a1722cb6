use super::{FRICTION_NAMES, FrictionIdentification, because, declared_misfit, misfit_in_words};
use crate::answer::{OutputFile, in_toml};

/// The table `[cylinder.friction]` of a project with what was identified: what the data do not
/// determine is a comment.
pub fn files(found: &FrictionIdentification) -> Vec<OutputFile> {
    let line = |((name, unit), one): (&(&str, &str), &super::FrictionEstimate)| {
        let [low, high] = one.interval.map(|end| in_toml(end, 4));
        let value = in_toml(one.value, 5);
        match because(one) {
            Some(reason) => format!("# {name}: not determined, {reason}\n"),
            None if *unit == "1" => format!("{name} = {value}    # 95 %: {low} to {high}\n"),
            None => format!("{name} = \"{value} {unit}\"    # 95 %: {low} to {high}\n"),
        }
    };
    let lines: String = FRICTION_NAMES.iter().zip(&found.estimates).map(line).collect();
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let misfit = |one| format!("# {}: the intervals below do not cover it.\n", misfit_in_words(found, one));
    let misfits: String = found.misfits.iter().map(misfit).collect();
    let misfit = declared_misfit(found).map(|misfit| format!("misfit = {}\n", misfit.in_toml()));
    let misfit = misfit.unwrap_or_default();
    let text = format!(
        "# Identified by phea from {}.\n{misfits}[cylinder.friction]\nmodel = \"lugre\"\n{lines}{misfit}",
        files.join(", ")
    );
    vec![OutputFile::new("friction.toml", text)]
}
