//! Models of lines in motion: valid combinations of model and line.

use super::Check;
use crate::text::RawFinding;
use crate::{Component, DeclaredLine, LineMotion};

pub(super) fn motion(line: &DeclaredLine, path: &str, check: &mut Check<'_, '_>) {
    if let LineMotion::Segments(segments) = line.motion
        && segments.count() > segments.most()
    {
        let message = format!(
            "{} segments have too many states for a simulation: with this friction and wall there may be {}",
            segments.count(),
            segments.most()
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

/// Rejects models that do not fit: a volume has no dynamics, and the wall of a pipe neither creeps
/// nor moves along its axis.
fn fits(line: &DeclaredLine, path: &str, check: &mut Check<'_, '_>) {
    let motion = &line.motion;
    let (at, model) = (format!("{path}.model"), motion.model());
    match (&line.component, motion) {
        (_, LineMotion::Automatic | LineMotion::Lumped) => {}
        (Component::Volume(_), _) => {
            let message =
                format!("model \"{model}\" needs a hose or a pipe: a volume has neither length nor bore");
            let help = "give `hose` or `pipe` with its `length`, or model \"lumped\"";
            check.error_with_help(&at, message, help);
        }
        (Component::Pipe { .. }, LineMotion::Creeping { .. } | LineMotion::TwoWave { .. }) => {
            let message =
                format!("model \"{model}\" is for hoses: the wall of a pipe neither creeps nor moves");
            let help = "a pipe takes model \"lumped\", \"segments\" or \"transmission_line\"";
            check.error_with_help(&at, message, help);
        }
        (Component::Pipe { .. }, _) if motion.relaxation_time().is_some() => {
            let message = "`relaxation_time` is for hoses: the wall of a pipe does not creep";
            check.error_with_help(&format!("{path}.relaxation_time"), message, "remove it, or choose a hose");
        }
        _ => {}
    }
}

/// Warns about creep of a wall that is as stiff at rest as in motion.
fn creeps(line: &DeclaredLine, path: &str, check: &mut Check<'_, '_>) {
    let stiffening = line.dynamic_stiffening.map_or(1.0, |stiffening| stiffening.nominal);
    if line.motion.relaxation_time().is_some() && line.hose().is_some() && stiffening == 1.0 {
        let message = "`relaxation_time` has no effect: with a `dynamic_stiffening` of 1 nothing creeps";
        check.warning(&format!("{path}.relaxation_time"), message);
    }
}

/// Warns about keys of [line] for a model, which have no effect if both sides choose their own.
pub(super) fn nobody_inherits(check: &mut Check<'_, '_>) {
    let Some(line) = check.reader.root_entry("line") else { return };
    let chooses = |side: &str| line.node.get(side).is_some_and(|side| side.node.get("model").is_some());
    if !(chooses("a") && chooses("b")) {
        return;
    }
    for name in LineMotion::KEYS {
        if let Some(entry) = line.node.get(name) {
            let message = format!("`{name}` has no effect: [line.a] and [line.b] choose a model each");
            let found = RawFinding::error(entry.key_place, message);
            check.reader.findings.push(found.help("write it next to the `model` that it belongs to"));
        }
    }
}
