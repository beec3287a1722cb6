//! The results of all tasks of a plan, in the order of the output.

use phea_engineering::alternatives::AlternativesPlan;

use super::{PrintedAlternative, PrintedFront, PrintedTask};
use crate::quantity::MotionKind;

/// The project as declared and its alternatives, as they are printed.
#[derive(Clone, Debug)]
pub(crate) struct PrintedAlternatives {
    /// The motion of all alternatives: none replaces its cylinder by a motor.
    pub(crate) motion: MotionKind,
    /// The declared project first, then its alternatives in file order.
    pub(crate) judged: Vec<PrintedAlternative>,
    /// Names of the alternatives that were not finished when the command was stopped.
    pub(crate) not_reached: Vec<String>,
    /// Results under each load case.
    pub(crate) cases: Vec<PrintedCase>,
    /// Front over a swept key, if requested.
    pub(crate) front: Option<PrintedFront>,
}

/// The project and its alternatives under a load case.
#[derive(Clone, Debug)]
pub(crate) struct PrintedCase {
    /// Name of the load case.
    pub(crate) name: String,
    /// Settings of the load case.
    pub(crate) settings: Vec<String>,
    /// The declared project first, then its alternatives in file order.
    pub(crate) judged: Vec<PrintedAlternative>,
    /// Names of the alternatives that were not finished when the command was stopped.
    pub(crate) not_reached: Vec<String>,
}

impl PrintedAlternatives {
    /// True if every alternative has a design, and every scenario ran to its end.
    pub(crate) fn is_complete(&self) -> bool {
        let front = self.front.as_ref().is_none_or(|front| front.not_reached == 0);
        let all = |judged: &[PrintedAlternative], not_reached: &[String]| {
            not_reached.is_empty() && judged.iter().all(|one| one.is_judged)
        };
        let cases = self.cases.iter().all(|case| all(&case.judged, &case.not_reached));
        front && cases && all(&self.judged, &self.not_reached)
    }
}

/// Joins the results of the tasks of a plan, in the order of its tasks; `None` for a task that was
/// not finished.
pub(crate) fn joined(
    plan: &AlternativesPlan,
    motion: MotionKind,
    results: impl IntoIterator<Item = Option<PrintedTask>>,
) -> PrintedAlternatives {
    let mut results = results.into_iter();
    let mut under_a_load = || {
        let (mut judged, mut not_reached) = (Vec::new(), Vec::new());
        for (name, result) in plan.names.iter().zip(results.by_ref()) {
            match result {
                Some(PrintedTask::Alternative(one)) => judged.push(*one),
                _ => not_reached.push(name.clone()),
            }
        }
        (judged, not_reached)
    };
    let (judged, not_reached) = under_a_load();
    let cases = plan.cases.iter().map(|case| {
        let (judged, not_reached) = under_a_load();
        PrintedCase { name: case.name.clone(), settings: case.settings.clone(), judged, not_reached }
    });
    let cases = cases.collect();
    let front = plan.front.as_ref().map(|front| {
        let all: Vec<Option<PrintedTask>> = results.collect();
        let count = all.len();
        let points = all.into_iter().filter_map(|result| match result {
            Some(PrintedTask::Point(point)) => Some(point),
            _ => None,
        });
        let points: Vec<_> = points.collect();
        let not_reached = count - points.len();
        PrintedFront::of(front, points, not_reached)
    });
    PrintedAlternatives { motion, judged, not_reached, cases, front }
}
