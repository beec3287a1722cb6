//! Deployment of the controller of an attempt, with the coefficients that the computer stores.
//!
//! The search shapes a loop without rounding, for rounded coefficients have no slopes. The rounded
//! controller is evaluated, audited and returned. If it violates a limit that the search satisfied,
//! the limits of the search are tightened by the loss due to rounding, and a little more, until the
//! rounded controller also satisfies the limits: rounding moves a controller by a limited amount in
//! an unpredictable direction.

use phea_dynamics::controller::Controller;
use phea_dynamics::watch::Watch;

use super::{Attempt, AttemptEnding, Leave, LoopDesignError, RESERVE_DB};
use crate::closed_loop::Compensation;
use crate::design::quantization::{CoefficientFormat, rounded};
use crate::loop_shaping::{Aim, Judgement, SearchProblem};

/// Multiple of the deficit by which the limits of the search are tightened.
const DRAWN: f64 = 1.25;
/// Tightening of the limits if the rounded controller is not stable or cannot be stored, dB;
/// doubled each time.
const DRAWN_BLINDLY_DB: f64 = 0.1;
/// Largest number of times the limits of a search are tightened.
const DRAWS_MAXIMUM: usize = 24;

impl Attempt {
    /// The deployed controller: in z if the loop is sampled, with rounded coefficients if a format
    /// is given.
    pub(in crate::design) fn deployed(&self) -> Result<Controller, LoopDesignError> {
        let law = self.shaping.controller(&self.x);
        if !self.rounds_coefficients() {
            return Ok(law);
        }
        Ok(rounded(&law, self.options.coefficients)?.controller)
    }

    /// The loop of the deployed controller.
    pub(super) fn compensation(&self) -> Result<Compensation, LoopDesignError> {
        let problem = self.shaping.samples().problem();
        Ok(Compensation::new(&self.deployed()?, problem.sensor.clone())?)
    }

    /// The deployed controller, evaluated on the samples; unusable if its coefficients cannot be
    /// stored.
    pub(super) fn judgement(&mut self) -> Judgement {
        if !self.rounds_coefficients() {
            return self.shaping.judge(&self.x);
        }
        let Ok(law) = self.compensation() else { return Judgement::UNUSABLE };
        let least_db = RESERVE_DB + self.options.reserve_db;
        self.shaping.keep_in_reserve(if self.relaxes { 0.0 } else { least_db });
        let judgement = self.shaping.judge_deployed(&self.x, &law);
        self.shaping.keep_in_reserve(self.reserve_db);
        judgement
    }

    /// Descends further inside its limits, as long as rounding violates a limit that the search
    /// satisfied. This does not apply when the worst margin itself is maximised.
    pub(super) fn draw_in(&mut self, watch: Watch<'_>) -> Result<(), Leave> {
        if !self.rounds_coefficients() || self.aim == Aim::WorstMargin {
            return Ok(());
        }
        loop {
            let Judgement { stable, worst_margin_db, .. } = self.judgement();
            if stable && worst_margin_db >= self.options.feasible_db() {
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
