//! What is deployed of an attempt: its controller with the coefficients that the computer keeps.
//!
//! The search shapes a loop without rounding, for rounded coefficients have no slopes. What is judged, audited and handed out is the rounded
//! controller. Where that breaks a limit which the search kept, the search is drawn in by what rounding took, and a little more, until the
//! rounded controller keeps to the limits too: rounding moves a controller by no more than so much, in a direction that nobody can tell.

use phea_dynamics::controller::Controller;
use phea_dynamics::watch::Watch;

use super::{Attempt, AttemptEnding, FEASIBLE_DB, Leave, LoopDesignError, RESERVE_DB};
use crate::closed_loop::Compensation;
use crate::design::quantisation::{CoefficientFormat, rounded};
use crate::loop_shaping::{Aim, Judgement, SearchProblem};

/// The search is drawn in by this many times what is missing.
const DRAWN: f64 = 1.25;
/// By how much where the rounded controller is not stable or cannot be kept, dB; twice as much each time.
const DRAWN_BLINDLY_DB: f64 = 0.1;
/// How often a search is drawn in.
const DRAWS_MAXIMUM: usize = 24;

impl Attempt {
    /// The controller as it is deployed: in z and with rounded coefficients where the loop samples and they are not kept as they are.
    pub(in crate::design) fn deployed(&self) -> Result<Controller, LoopDesignError> {
        let law = self.shaping.controller(&self.x);
        if !self.rounds_coefficients() {
            return Ok(law);
        }
        Ok(rounded(&law, self.options.coefficients)?.controller)
    }

    /// The loop of what is deployed.
    pub(super) fn compensation(&self) -> Result<Compensation, LoopDesignError> {
        let problem = self.shaping.samples().problem();
        Ok(Compensation::new(&self.deployed()?, problem.sensor.clone())?)
    }

    /// What is deployed, judged by the samples; unusable where it cannot be kept.
    pub(super) fn judgement(&mut self) -> Judgement {
        if !self.rounds_coefficients() {
            return self.shaping.judge(&self.x);
        }
        let Ok(law) = self.compensation() else { return Judgement::UNUSABLE };
        self.shaping.keep_in_reserve(if self.relaxes { 0.0 } else { RESERVE_DB });
        let judgement = self.shaping.judge_deployed(&self.x, &law);
        self.shaping.keep_in_reserve(self.reserve_db);
        judgement
    }

    /// Descends further inside its limits, as long as rounding breaks one that the search kept. A worst margin that is made as large as it
    /// can be has nothing to be drawn in from.
    pub(super) fn draw_in(&mut self, watch: Watch<'_>) -> Result<(), Leave> {
        if !self.rounds_coefficients() || self.aim == Aim::WorstMargin {
            return Ok(());
        }
        loop {
            let Judgement { stable, worst_margin_db, .. } = self.judgement();
            if stable && worst_margin_db >= FEASIBLE_DB {
                return Ok(());
            }
            if self.draws >= DRAWS_MAXIMUM {
                return Err(Leave::Ended(AttemptEnding::Missed { worst_margin_db, audit: None }));
            }
            self.draws += 1;
            self.reserve_db += match stable {
                true => DRAWN * (-worst_margin_db).max(RESERVE_DB),
                false => self.reserve_db.max(DRAWN_BLINDLY_DB),
            };
            self.shaping.keep_in_reserve(self.reserve_db);
            self.descend(true, watch)?;
        }
    }

    fn rounds_coefficients(&self) -> bool {
        let sampled = self.shaping.samples().problem().timing.sample_time_s.is_some();
        sampled && self.options.coefficients != CoefficientFormat::Double
    }
}
