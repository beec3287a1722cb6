//! The descents of a search, independent of each other, except that one ends where it joins the end
//! of an earlier one.

use phea_dynamics::watch::{Stopped, Watch, report_progress, within};

use super::{STAGE, STEPS_ROUGH, SearchOptions, StartSearch, is_distinct, rank};
use crate::loop_shaping::descent::{Descent, DescentOptions, DescentWork};
use crate::loop_shaping::search::{Judgement, SearchProblem};

/// Position of a descent after one of its steps.
struct PassedPoint {
    x: Vec<f64>,
    judgement: Option<Judgement>,
    work: DescentWork,
}

/// The rule by which two descents count as one.
struct MergedEnds<'a> {
    bounds: &'a [[f64; 2]],
    options: &'a DescentOptions,
}

impl<P: SearchProblem + Clone + Sync> StartSearch<'_, P> {
    /// Makes a few steps of each descent.
    pub(super) fn descend_roughly(
        &mut self,
        descents: &mut [Descent],
        watch: Watch<'_>,
    ) -> Result<(), Stopped> {
        let few = |problem: &mut dyn SearchProblem, descent: &mut Descent, watch: Watch<'_>| {
            for step in 0..STEPS_ROUGH {
                report_progress(watch, STAGE, step, STEPS_ROUGH)?;
                if descent.advance(problem).is_some() {
                    break;
                }
            }
            Ok(())
        };
        self.each(descents.iter_mut().collect(), watch, few)?;
        Ok(())
    }

    /// Continues each descent to its end, or to the end of an earlier one that it approaches; runs
    /// one per worker at a time, and truncates them afterwards where they would have joined
    /// another.
    pub(super) fn descend_to_the_end(
        &mut self,
        descents: &mut [Descent],
        watch: Watch<'_>,
    ) -> Result<(), Stopped> {
        let bounds = self.problem.bounds().to_vec();
        let SearchOptions { descent: options, workers, .. } = self.options;
        let merged = MergedEnds { bounds: &bounds, options };
        let (all, at_once) = (descents.len(), workers.at_once.max(1));
        for first in (0..all).step_by(at_once) {
            let fraction = [first, (first + at_once).min(all)].map(|done| done as f64 / all as f64);
            let (ended, others) = descents.split_at_mut(first);
            let ended = &*ended;
            let to_the_end = |problem: &mut dyn SearchProblem, descent: &mut Descent, watch: Watch<'_>| {
                let mut trail: Vec<PassedPoint> = Vec::new();
                while descent.advance(problem).is_none() {
                    report_progress(watch, STAGE, trail.len(), options.steps_maximum)?;
                    let passed = PassedPoint::of(descent);
                    let joins = ended.iter().any(|end| merged.leads_to(&passed, end));
                    trail.push(passed);
                    if joins {
                        break;
                    }
                }
                Ok(trail)
            };
            let now: Vec<&mut Descent> = others.iter_mut().take(at_once).collect();
            let trails = self.each(now, &mut within(&mut *watch, fraction), to_the_end)?;
            for (index, trail) in trails.iter().enumerate() {
                let (ended, others) = descents.split_at_mut(first + index);
                let Some(descent) = others.first_mut() else { break };
                merged.cut(descent, trail, ended);
            }
        }
        self.sort(descents);
        Ok(())
    }
}

impl PassedPoint {
    fn of(descent: &Descent) -> PassedPoint {
        PassedPoint { x: descent.x().to_vec(), judgement: descent.judgement(), work: descent.work() }
    }
}

impl MergedEnds<'_> {
    /// True if a descent has come near an end that is no worse than its present point.
    fn leads_to(&self, passed: &PassedPoint, end: &Descent) -> bool {
        let [own, others] =
            [passed.judgement, end.judgement()].map(|judgement| rank(self.options, judgement));
        !is_distinct(&passed.x, end.x(), self.bounds)
            && others.0.cmp(&own.0).then(others.1.total_cmp(&own.1)).is_le()
    }

    /// Truncates a descent where it first came near one of these ends, if it did.
    fn cut(&self, descent: &mut Descent, trail: &[PassedPoint], ended: &[Descent]) {
        let joined = trail.iter().find_map(|passed| {
            let end = ended.iter().find(|end| self.leads_to(passed, end))?;
            Some((end, passed.work))
        });
        if let Some((end, work)) = joined {
            descent.end_at(end, work);
        }
    }
}
