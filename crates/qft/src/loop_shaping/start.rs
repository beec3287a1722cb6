//! The global search: points spread over the bounds, evolution if none of them is stable, and
//! descents from the best.

mod descents;
mod evolution;
mod spread;

use std::cmp::Ordering;

use phea_dynamics::order::sort_by_number;
use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::watch::{Stopped, Watch, part, report_progress};

use super::best_seen::{BestSeen, SeenProblem};
use super::descent::{Binding, Descent, DescentOptions, DescentStatus, DescentWork, is_usable};
use super::search::{Aim, Judgement, SearchProblem};
use evolution::Evolution;
use spread::AdditiveRecurrence;

/// Fraction of the bounds below which points that differ by less in every coordinate count as one.
const DISTINCT: f64 = 0.05;
/// Number of steps of each descent before the better ones are chosen.
const STEPS_ROUGH: usize = 12;
/// Worst margin from which a start counts as feasible, dB.
const NEAR_DB: f64 = -3.0;
/// Worst margin above which half of the starts are chosen by least objective, dB: the largest worst
/// margins occur at high gain, from which a descent may not reach the least objective.
const MODEST_DB: f64 = -15.0;

/// Width of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchOptions {
    /// Equal seeds give equal results, byte by byte.
    pub seed: u64,
    /// Number of points spread over the bounds.
    pub samples: usize,
    /// Number of values of the first x over its bounds that are evaluated at each of these points,
    /// of which the best is retained (few gains may suit a given shape); 0 or 1 leaves the points
    /// unchanged.
    pub scanned: usize,
    /// Number of points from which descents begin.
    pub starts: usize,
    /// Number of completed descents.
    pub finished: usize,
    /// Largest number of generations of evolution, used if fewer samples than `starts` are stable.
    pub generations: usize,
    /// Options of each descent.
    pub descent: DescentOptions,
    /// The worker threads; the result does not depend on them.
    pub workers: Workers,
}

impl SearchOptions {
    /// Defaults: 300 samples, 8 starts of which 4 are completed, 60 generations, one thread.
    pub fn new(aim: Aim, seed: u64) -> SearchOptions {
        let descent = DescentOptions::new(aim);
        let workers = Workers::CALLER;
        SearchOptions {
            seed,
            samples: 300,
            scanned: 0,
            starts: 8,
            finished: 4,
            generations: 60,
            descent,
            workers,
        }
    }
}

/// Final status of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SearchStatus {
    /// The status of the best descent.
    Ended(DescentStatus),
    /// The search found no stable point.
    NotStabilised {
        /// The least [`Judgement::instability`].
        instability: f64,
    },
}

/// End of one descent.
#[derive(Clone, Debug, PartialEq)]
pub struct DescentEnd {
    /// Free numbers x.
    pub x: Vec<f64>,
    /// Evaluation of the end.
    pub judgement: Judgement,
    /// Final status of the descent.
    pub status: DescentStatus,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// Final status of the search.
    pub status: SearchStatus,
    /// The best point, or the least unstable one if none is stable.
    pub x: Vec<f64>,
    /// Evaluation of this point.
    pub judgement: Judgement,
    /// The margins that limit further steps there, the strongest first.
    pub binding: Vec<Binding>,
    /// The end of every completed descent, the best first. A descent that came near the end of
    /// another, and was no better, counts as having ended there.
    pub ends: Vec<DescentEnd>,
    /// Number of points evaluated before the descents: given ones, samples and the last generation
    /// of an evolution, if any.
    pub points: usize,
    /// Number of these points that are stable.
    pub stable_points: usize,
    /// All work, including that of abandoned descents.
    pub work: DescentWork,
}

/// A point and its evaluation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct JudgedPoint {
    pub(super) x: Vec<f64>,
    pub(super) judgement: Judgement,
}

impl JudgedPoint {
    /// True if this point is better: stable before unstable. Among stable points the larger worst
    /// margin is better or, if both nearly satisfy the limits and the objective is the aim, the
    /// lesser objective; among unstable ones the lesser instability.
    pub(super) fn is_better_than(&self, other: &JudgedPoint, aim: Aim) -> bool {
        match (is_usable(&self.judgement), is_usable(&other.judgement)) {
            (true, true) => {
                let [own, others] = [&self.judgement, &other.judgement];
                let is_near = |judgement: &Judgement| judgement.worst_margin_db > NEAR_DB;
                if aim == Aim::Objective && is_near(own) && is_near(others) {
                    return own.objective_db < others.objective_db;
                }
                own.worst_margin_db > others.worst_margin_db
            }
            (false, false) => self.judgement.instability < other.judgement.instability,
            (usable, _) => usable,
        }
    }

    /// The point, or the best of it and of this number of values of its first x over its bounds.
    fn along_first(problem: &mut dyn SearchProblem, x: &[f64], scanned: usize, aim: Aim) -> JudgedPoint {
        let range = problem.bounds().first().copied().unwrap_or_default();
        let values = (0..scanned).map(|step| {
            let fraction = (step as f64 + 0.5) / scanned as f64;
            range[0] + fraction * (range[1] - range[0])
        });
        let mut judged = |x: Vec<f64>| JudgedPoint { judgement: problem.judge(&x), x };
        let mut best = judged(x.to_vec());
        for value in values {
            let mut x = best.x.clone();
            if let Some(first) = x.first_mut() {
                *first = value;
            }
            let candidate = judged(x);
            if candidate.is_better_than(&best, aim) {
                best = candidate;
            }
        }
        best
    }

    /// Sorts the best first; equal ones keep their order.
    fn sort(candidates: &mut [JudgedPoint], aim: Aim) {
        candidates.sort_by(|a, b| match a.is_better_than(b, aim) {
            true => Ordering::Less,
            false if b.is_better_than(a, aim) => Ordering::Greater,
            false => Ordering::Equal,
        });
    }
}

/// Searches from many starts, with identical results on every machine. The `given` points, such as
/// the end of a simpler problem, are also evaluated. `None` if no point is evaluated.
///
/// ```text
/// samples -> (evolution, if too few are stable) -> a few descent steps from the best distinct ones -> the best of these to their end
/// ```
///
/// The result is the best local optimum found; the distance of the other ends shows its
/// reliability.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// ```
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::loop_shaping::{Aim, Judgement, MarginRow, SearchOptions, SearchProblem, Slopes, search};
///
/// /// Least x with margin (x^2 - 1)^2 - 1/4: there are walls around -1 and 1 that no descent passes.
/// #[derive(Clone)]
/// struct Walls([[f64; 2]; 1]);
///
/// impl SearchProblem for Walls {
///     fn bounds(&self) -> &[[f64; 2]] {
///         &self.0
///     }
///     fn judge(&mut self, x: &[f64]) -> Judgement {
///         let wall = x[0] * x[0] - 1.0;
///         Judgement { objective_db: x[0], worst_margin_db: wall * wall - 0.25, stable: true, instability: 0.0 }
///     }
///     fn slopes(&mut self, x: &[f64]) -> Slopes {
///         let slope = 4.0 * x[0] * (x[0] * x[0] - 1.0);
///         let margin_db = self.judge(x).worst_margin_db;
///         let row = MarginRow { sample: 0, margin_db, rate: 1.0, slopes: vec![slope] };
///         Slopes { objective_db: x[0], objective_slopes: vec![1.0], margins: vec![row] }
///     }
/// }
///
/// let mut walls = Walls([[-2.0, 2.0]]);
/// let options = SearchOptions::new(Aim::Objective, 1);
/// let found = search(&mut walls, vec![], &options, &mut unwatched)?.unwrap();
/// assert_eq!(found.x, [-2.0]);
/// assert_eq!(found.ends[1].x, [-2.0]); // the next start agrees
/// # Ok::<(), phea_dynamics::watch::Stopped>(())
/// ```
pub fn search<P: SearchProblem + Clone + Sync>(
    problem: &mut P,
    given: Vec<Vec<f64>>,
    options: &SearchOptions,
    watch: Watch<'_>,
) -> Result<Option<SearchResult>, Stopped> {
    search_seeing(problem, given, (options, &mut BestSeen::new(options.descent.aim)), watch)
}

/// Searches as [`search`] does, and retains the best point seen, also if the search is stopped.
pub(crate) fn search_seeing<P: SearchProblem + Clone + Sync>(
    problem: &mut P,
    given: Vec<Vec<f64>>,
    (options, seen): (&SearchOptions, &mut BestSeen),
    watch: Watch<'_>,
) -> Result<Option<SearchResult>, Stopped> {
    let random = options.seed;
    let mut search = StartSearch { problem, seen, options, work: DescentWork::default(), random };
    let samples = search.sampled(given, &mut part(watch, STAGE, [0.0, 0.2]))?;
    let points = search.evolved(samples, &mut part(watch, STAGE, [0.2, 0.4]))?;
    let mut descents = search.descents_from(&points);
    search.descend_roughly(&mut descents, &mut part(watch, STAGE, [0.4, 0.7]))?;
    search.leave_all_but_the_best(&mut descents);
    search.descend_to_the_end(&mut descents, &mut part(watch, STAGE, [0.7, 1.0]))?;
    Ok(search.result(&points, &descents))
}

/// Name of the stage in progress reports.
const STAGE: &str = "search";

/// Number of pieces into which the samples are divided for parallel work.
const PIECES: usize = 8;

/// A search in progress.
struct StartSearch<'a, P> {
    problem: &'a mut P,
    seen: &'a mut BestSeen,
    options: &'a SearchOptions,
    /// Work of samples, evolution and abandoned descents.
    work: DescentWork,
    random: u64,
}

impl<P: SearchProblem + Clone + Sync> StartSearch<'_, P> {
    /// The given points and those spread over the bounds, the best first.
    fn sampled(&mut self, given: Vec<Vec<f64>>, watch: Watch<'_>) -> Result<Vec<JudgedPoint>, Stopped> {
        let mut points: Vec<(Vec<f64>, usize)> = given.into_iter().rev().map(|x| (x, 0)).collect();
        let bounds = self.problem.bounds().to_vec();
        if points.len() < self.options.samples {
            let spread = AdditiveRecurrence::new(bounds.len(), &mut self.random);
            let indices = points.len()..self.options.samples;
            points.extend(indices.map(|index| (spread.point(index, &bounds), self.options.scanned)));
        }
        self.work.judgements += points.iter().map(|(_, scanned)| scanned + 1).sum::<usize>();
        let size = points.len().div_ceil(PIECES).max(1);
        let aim = self.options.descent.aim;
        let judge = |problem: &mut dyn SearchProblem, chunk: &[(Vec<f64>, usize)], watch: Watch<'_>| {
            let mut judged = Vec::with_capacity(chunk.len());
            for (done, (x, scanned)) in chunk.iter().enumerate() {
                report_progress(watch, STAGE, done, chunk.len())?;
                judged.push(JudgedPoint::along_first(problem, x, *scanned, aim));
            }
            Ok(judged)
        };
        let chunks: Vec<&[(Vec<f64>, usize)]> = points.chunks(size).collect();
        let judged = self.each(chunks, watch, judge)?;
        let mut candidates = judged.concat();
        JudgedPoint::sort(&mut candidates, aim);
        Ok(candidates)
    }

    /// Results of tasks on copies of the problem, in their order.
    fn each<T: Send, R: Send>(
        &mut self,
        tasks: Vec<T>,
        watch: Watch<'_>,
        task: impl Fn(&mut dyn SearchProblem, T, Watch<'_>) -> Result<R, Stopped> + Sync,
    ) -> Result<Vec<R>, Stopped> {
        let mut places: Vec<(BestSeen, Option<R>)> =
            tasks.iter().map(|_| (BestSeen::new(self.options.descent.aim), None)).collect();
        let (task, problem) = (&task, &*self.problem);
        let pieces = places.iter_mut().zip(tasks).map(|((seen, place), one)| {
            let piece: WorkPiece<'_> = Box::new(move |watch: Watch<'_>| {
                let mut problem = problem.clone();
                *place = Some(task(&mut SeenProblem { problem: &mut problem, seen }, one, watch)?);
                Ok(())
            });
            piece
        });
        let ended = self.options.workers.work(pieces.collect(), STAGE, watch);
        let mut results = Vec::with_capacity(places.len());
        for (seen, result) in places {
            self.seen.join(seen);
            results.extend(result);
        }
        ended.map(|()| results)
    }

    /// The samples, if enough of them are stable; otherwise a population evolved from them, the
    /// best first.
    fn evolved(&mut self, samples: Vec<JudgedPoint>, watch: Watch<'_>) -> Result<Vec<JudgedPoint>, Stopped> {
        let mut evolution = Evolution::new(&samples, self.problem.bounds());
        if self.is_enough(evolution.candidates()) || evolution.is_too_small() {
            return Ok(samples);
        }
        while evolution.generation() < self.options.generations && !self.is_enough(evolution.candidates()) {
            report_progress(watch, STAGE, evolution.generation(), self.options.generations)?;
            let problem = &mut SeenProblem { problem: &mut *self.problem, seen: &mut *self.seen };
            evolution.step(problem, &mut self.random);
            self.work.judgements += 1;
        }
        let mut candidates = evolution.candidates().to_vec();
        JudgedPoint::sort(&mut candidates, self.options.descent.aim);
        Ok(candidates)
    }

    fn is_enough(&self, candidates: &[JudgedPoint]) -> bool {
        candidates.iter().filter(|candidate| is_usable(&candidate.judgement)).count() >= self.options.starts
    }

    /// Descents from the best candidates that are distinct; the candidates are sorted.
    fn descents_from(&self, candidates: &[JudgedPoint]) -> Vec<Descent> {
        let bounds = self.problem.bounds();
        let usable: Vec<&JudgedPoint> =
            candidates.iter().filter(|candidate| is_usable(&candidate.judgement)).collect();
        let mut modest: Vec<&JudgedPoint> =
            usable.iter().copied().filter(|one| one.judgement.worst_margin_db > MODEST_DB).collect();
        sort_by_number(&mut modest, |one| one.judgement.objective_db);
        if self.options.descent.aim == Aim::WorstMargin {
            modest.clear();
        }
        let mut starts: Vec<&JudgedPoint> = vec![];
        add_distinct(&mut starts, self.options.starts / 2, &usable, bounds);
        add_distinct(&mut starts, self.options.starts, &modest, bounds);
        add_distinct(&mut starts, self.options.starts, &usable, bounds);
        starts.iter().map(|start| Descent::new(&start.x, self.options.descent)).collect()
    }

    fn leave_all_but_the_best(&mut self, descents: &mut Vec<Descent>) {
        self.sort(descents);
        for left in descents.drain(self.options.finished.max(1).min(descents.len())..) {
            self.work = self.work + left.work();
        }
    }

    /// Sorts descents, the best first.
    fn sort(&self, descents: &mut [Descent]) {
        let rank = |descent: &Descent| rank(&self.options.descent, descent.judgement());
        descents.sort_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
    }

    fn result(&self, points: &[JudgedPoint], descents: &[Descent]) -> Option<SearchResult> {
        let end = |descent: &Descent| {
            Some(DescentEnd {
                x: descent.x().to_vec(),
                judgement: descent.judgement()?,
                status: descent.status()?,
            })
        };
        let ends: Vec<DescentEnd> = descents.iter().filter_map(end).collect();
        let (status, best) = match ends.first() {
            Some(DescentEnd { x, judgement, status }) => {
                (SearchStatus::Ended(*status), JudgedPoint { x: x.clone(), judgement: *judgement })
            }
            None => {
                let best = points.first()?.clone();
                (SearchStatus::NotStabilised { instability: best.judgement.instability }, best)
            }
        };
        Some(SearchResult {
            status,
            x: best.x,
            judgement: best.judgement,
            binding: descents.first().map_or(vec![], |descent| descent.binding().to_vec()),
            points: points.len(),
            stable_points: points.iter().filter(|one| is_usable(&one.judgement)).count(),
            ends,
            work: descents.iter().fold(self.work, |sum, descent| sum + descent.work()),
        })
    }
}

/// Rank of a descent: false if a point satisfies the reserve, true if it misses it, and then its
/// value, dB, smaller is better.
fn rank(options: &DescentOptions, judgement: Option<Judgement>) -> (bool, f64) {
    let Some(judgement) = judgement else { return (true, f64::INFINITY) };
    let misses = judgement.worst_margin_db < options.reserve_db - options.tolerance_db;
    match options.aim {
        Aim::Objective if misses => (true, -judgement.worst_margin_db),
        Aim::Objective => (false, judgement.objective_db),
        Aim::WorstMargin => (false, -judgement.worst_margin_db),
    }
}

/// Adds points distinct from all starts, until there are enough.
fn add_distinct<'c>(
    starts: &mut Vec<&'c JudgedPoint>,
    most: usize,
    from: &[&'c JudgedPoint],
    bounds: &[[f64; 2]],
) {
    for candidate in from {
        if starts.len() < most && starts.iter().all(|start| is_distinct(&candidate.x, &start.x, bounds)) {
            starts.push(candidate);
        }
    }
}

/// True if two points differ by a fraction of the bounds that justifies a second descent.
fn is_distinct(a: &[f64], b: &[f64], bounds: &[[f64; 2]]) -> bool {
    let apart = a.iter().zip(b).zip(bounds);
    apart.into_iter().any(|((a, b), [low, high])| (a - b).abs() > DISTINCT * (high - low))
}
