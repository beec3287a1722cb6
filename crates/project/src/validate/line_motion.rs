//! Models of lines in motion: which keys go with which model, and which model with which line.

use super::Check;
use crate::text::Found;
use crate::{Line, LineModel, LineMotion};

pub(super) fn motion(line: &Line, path: &str, check: &mut Check<'_, '_>) {
    let model = line.motion.model;
    for name in LineMotion::KEYS {
        let at = format!("{path}.{name}");
        if check.declared(&at) && !model.uses(name) {
            let message = format!("`{name}` has no meaning with model \"{}\"", model.word());
            check.error_with_help(&at, message, format!("it belongs to {}", either(&LineModel::using(name))));
        }
    }
    if model == LineModel::Creeping && line.motion.relaxation_time.is_none() {
        let message = format!(
            "missing `relaxation_time` in [{path}]: model \"creeping\" needs it, and none is assumed"
        );
        check.missing(path, "relaxation_time", message);
    }
    let (segments, most) =
        (line.motion.segments.unwrap_or(LineMotion::SEGMENTS), line.motion.most_segments());
    if model == LineModel::Segments && segments > most {
        let message = format!(
            "{segments} segments have too many states for a simulation: with this friction and wall there may be {most}"
        );
        check.error_with_help(
            &format!("{path}.segments"),
            message,
            "\"steady\" `friction` leaves room for more, but damps the waves too little",
        );
    }
    fits(line, path, check);
    creeps(line, path, check);
}

/// A volume has nothing to move, and the wall of a pipe neither creeps nor moves along its axis.
fn fits(line: &Line, path: &str, check: &mut Check<'_, '_>) {
    let model = line.motion.model;
    let at = format!("{path}.model");
    let outright = line.volume.is_some() || line.effective_bulk_modulus.is_some();
    if outright && model != LineModel::Lumped {
        let message = format!(
            "model \"{}\" needs a hose or a pipe: a volume has neither length nor bore",
            model.word()
        );
        return check.error_with_help(
            &at,
            message,
            "give `hose` or `pipe` with its `length`, or model \"lumped\"",
        );
    }
    let of_hoses = [LineModel::Creeping, LineModel::TwoWave].contains(&model);
    if line.pipe.is_some() && of_hoses {
        let message =
            format!("model \"{}\" is for hoses: the wall of a pipe neither creeps nor moves", model.word());
        let help = "a pipe takes model \"lumped\", \"segments\" or \"transmission_line\"";
        return check.error_with_help(&at, message, help);
    }
    if line.pipe.is_some() && model == LineModel::Segments && line.motion.relaxation_time.is_some() {
        let message = "`relaxation_time` is for hoses: the wall of a pipe does not creep";
        check.error_with_help(&format!("{path}.relaxation_time"), message, "remove it, or choose a hose");
    }
}

/// A wall that is as stiff at rest as in motion has nothing to creep.
fn creeps(line: &Line, path: &str, check: &mut Check<'_, '_>) {
    let stiffening = line.dynamic_stiffening.map_or(1.0, |stiffening| stiffening.nominal);
    let relaxes = line.motion.relaxation_time.is_some() && line.motion.model.uses("relaxation_time");
    if relaxes && line.pipe.is_none() && stiffening == 1.0 {
        let message = "`relaxation_time` has no effect: with a `dynamic_stiffening` of 1 nothing creeps";
        check.warning(&format!("{path}.relaxation_time"), message);
    }
}

/// What [line] says of a model is inherited by nobody where both sides choose theirs.
pub(super) fn nobody_inherits(check: &mut Check<'_, '_>) {
    let Some(line) = check.reader.root_entry("line") else { return };
    let chooses = |side: &str| line.node.get(side).is_some_and(|side| side.node.get("model").is_some());
    if !(chooses("a") && chooses("b")) {
        return;
    }
    for name in LineMotion::KEYS {
        if let Some(entry) = line.node.get(name) {
            let message = format!("`{name}` has no effect: [line.a] and [line.b] choose a model each");
            let found = Found::error(entry.key_place, message);
            check.reader.findings.push(found.help("write it beside the `model` it belongs to"));
        }
    }
}

/// Words as in `model "creeping" or "segments"`.
fn either(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    format!("model {}", quoted.join(" or "))
}
