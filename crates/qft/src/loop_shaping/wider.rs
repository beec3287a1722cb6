//! Benefit of a wider limit: a search that continues from its end with that limit wider.

use phea_dynamics::watch::{Stopped, Watch};

use super::descent::{DescentOptions, descend};
use super::search::{Aim, Judgement, SearchProblem};

/// Accuracy of the benefit, dB.
const TOLERANCE_DB: f64 = 2e-3;
/// Deficit of a margin from its reserve at the end above which no comparison is possible, dB.
const MISSED_DB: f64 = 0.1;
/// Number of steps of one descent.
const STEPS: usize = 20;

/// A local optimum of a search, and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalOptimum {
    /// The end of the search.
    pub x: Vec<f64>,
    /// The objective, or the negative worst margin, dB: smaller is better.
    pub value_db: f64,
    options: DescentOptions,
}

impl LocalOptimum {
    /// The local optimum near x, with all margins at least this reserve, dB, if the objective is
    /// the aim; `None` if they are not, or if a plant is not stable.
    ///
    /// # Errors
    /// [`Stopped`] by the watch.
    ///
    /// # Example
    /// Minimum of x with the margin ln x - c, and c reduced by 1/4:
    /// ```
    /// use phea_dynamics::watch::unwatched;
    /// use phea_qft::loop_shaping::{Aim, Judgement, MarginRow, LocalOptimum, SearchProblem, Slopes};
    ///
    /// struct Least(f64, [[f64; 2]; 1]);
    ///
    /// impl SearchProblem for Least {
    ///     fn bounds(&self) -> &[[f64; 2]] {
    ///         &self.1
    ///     }
    ///     fn judge(&mut self, x: &[f64]) -> Judgement {
    ///         Judgement { objective_db: x[0], worst_margin_db: x[0].ln() - self.0, stable: true, instability: 0.0 }
    ///     }
    ///     fn slopes(&mut self, x: &[f64]) -> Slopes {
    ///         let row = MarginRow { sample: 0, margin_db: x[0].ln() - self.0, rate: 1.0, slopes: vec![1.0 / x[0]] };
    ///         Slopes { objective_db: x[0], objective_slopes: vec![1.0], margins: vec![row] }
    ///     }
    /// }
    ///
    /// let mut least = |c: f64| Least(c, [[0.1, 100.0]]);
    /// let end = LocalOptimum::near(&mut least(1.0), &[3.0], (Aim::Objective, 0.0), &mut unwatched)?.unwrap();
    /// let wider = end.continued(&mut least(0.75), &mut unwatched)?.unwrap();
    /// assert!((end.value_db - wider.value_db - (1.0_f64.exp() - 0.75_f64.exp())).abs() < 0.01);
    /// # Ok::<(), phea_dynamics::watch::Stopped>(())
    /// ```
    pub fn near(
        problem: &mut dyn SearchProblem,
        x: &[f64],
        (aim, reserve_db): (Aim, f64),
        watch: Watch<'_>,
    ) -> Result<Option<LocalOptimum>, Stopped> {
        let options = DescentOptions {
            reserve_db,
            tolerance_db: TOLERANCE_DB,
            steps_maximum: STEPS,
            is_near: true,
            ..DescentOptions::new(aim)
        };
        LocalOptimum { x: x.to_vec(), value_db: f64::NAN, options }.continued(problem, watch)
    }

    /// The end of this search continued with other limits; `None` if it finds no point that
    /// satisfies them.
    ///
    /// # Errors
    /// [`Stopped`] by the watch.
    pub fn continued(
        &self,
        problem: &mut dyn SearchProblem,
        watch: Watch<'_>,
    ) -> Result<Option<LocalOptimum>, Stopped> {
        let found = descend(problem, &self.x, self.options, watch)?;
        let value_db = |judgement: Judgement| match self.options.aim {
            Aim::WorstMargin => Some(-judgement.worst_margin_db),
            Aim::Objective => {
                let is_satisfied = judgement.worst_margin_db >= self.options.reserve_db - MISSED_DB;
                is_satisfied.then_some(judgement.objective_db)
            }
        };
        let judgement = found.judgement.filter(|judgement| judgement.stable);
        let value_db = judgement.and_then(value_db);
        Ok(value_db.map(|value_db| LocalOptimum { x: found.x, value_db, options: self.options }))
    }
}
