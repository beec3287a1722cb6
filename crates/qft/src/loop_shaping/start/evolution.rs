//! Differential evolution: a population that improves where no slopes are available.

use phea_dynamics::random::uniform;

use super::JudgedPoint;
use crate::loop_shaping::search::{Aim, SearchProblem};

/// Weight of the difference that is added, and probability that a coordinate is included.
const WEIGHT: f64 = 0.7;
const CROSSOVER: f64 = 0.9;
/// Number of members for each coordinate, and least number of members.
const MEMBERS_PER_COORDINATE: usize = 8;
const MEMBERS_MINIMUM: usize = 24;
/// Number of members needed to form a trial point: a member, and three others.
const MEMBERS_NEEDED: usize = 4;

/// A population that evolves from unstable points to stable ones, and from small worst margins to
/// larger ones.
///
/// ```text
/// trial_j = a_j + F (b_j - c_j)  with probability CR,  else x_j;      the trial replaces x unless it is worse
/// ```
///
/// a, b and c are three other members. Source: Storn and Price (1997), variant rand/1/bin; a
/// coordinate that would leave its bounds moves half of the way to them.
#[derive(Clone, Debug)]
pub(super) struct Evolution {
    population: Vec<JudgedPoint>,
    generation: usize,
    member: usize,
}

impl Evolution {
    /// The best candidates, sorted, as a population.
    pub(super) fn new(candidates: &[JudgedPoint], bounds: &[[f64; 2]]) -> Evolution {
        let size = (MEMBERS_PER_COORDINATE * bounds.len()).max(MEMBERS_MINIMUM);
        Evolution { population: candidates.iter().take(size).cloned().collect(), generation: 0, member: 0 }
    }

    pub(super) fn candidates(&self) -> &[JudgedPoint] {
        &self.population
    }

    /// Number of complete generations.
    pub(super) fn generation(&self) -> usize {
        self.generation
    }

    /// True if there are too few members to form trial points.
    pub(super) fn is_too_small(&self) -> bool {
        self.population.len() < MEMBERS_NEEDED
    }

    /// Evaluates one trial point.
    pub(super) fn step(&mut self, problem: &mut dyn SearchProblem, random: &mut u64) {
        let x = self.trial(problem.bounds(), random);
        let judgement = problem.judge(&x);
        let trial = JudgedPoint { x, judgement };
        if !self.population[self.member].is_better_than(&trial, Aim::WorstMargin) {
            self.population[self.member] = trial;
        }
        self.member += 1;
        if self.member == self.population.len() {
            (self.member, self.generation) = (0, self.generation + 1);
        }
    }

    fn trial(&self, bounds: &[[f64; 2]], random: &mut u64) -> Vec<f64> {
        let mut below = |count: usize| (uniform(random) * count as f64) as usize;
        let mut chosen = vec![self.member];
        while chosen.len() < MEMBERS_NEEDED {
            let next = below(self.population.len());
            if !chosen.contains(&next) {
                chosen.push(next);
            }
        }
        let forced = below(bounds.len());
        let of = |parent: usize, coordinate: usize| self.population[chosen[parent]].x[coordinate];
        let coordinate = |(at, [low, high]): (usize, &[f64; 2])| {
            let old = of(0, at);
            if uniform(random) >= CROSSOVER && at != forced {
                return old;
            }
            let new = of(1, at) + WEIGHT * (of(2, at) - of(3, at));
            if new < *low {
                (old + low) / 2.0
            } else if new > *high {
                (old + high) / 2.0
            } else {
                new
            }
        };
        bounds.iter().enumerate().map(coordinate).collect()
    }
}
