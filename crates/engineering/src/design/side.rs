//! A controller with its audit and the figures by which an engineer compares controllers.

use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::{LinearError, TimeDomain};
use phea_dynamics::portable;

pub use crate::audit::NominalMargins;
use crate::audit::{AuditedProblem, ProjectAudit};
use crate::robust::RobustProblem;

/// A controller with its audit.
#[derive(Clone, Debug)]
pub struct AuditedController {
    /// Controller, prefilter and timing.
    pub controller: Controller,
    /// Family in the loop of the controller.
    pub problem: RobustProblem,
    /// Audit of the loop.
    pub view: ProjectAudit,
    /// Figures for comparison.
    pub figures: LoopFigures,
}

/// The numbers by which controllers are compared, in addition to their verdicts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopFigures {
    /// Number of poles of the controller: of the continuous controller if there is one, even in a
    /// sampled loop.
    pub order: usize,
    /// Number of poles minus number of zeros of that controller.
    pub relative_degree: i64,
    /// High-frequency gain, dB: lim s^r G(s) for that relative degree r, of the continuous
    /// controller if there is one; for one in z, |G| at pi/T.
    pub high_frequency_gain_db: f64,
    /// Number of poles of the prefilter, of the continuous one if there is one.
    pub prefilter_order: usize,
    /// Margins of the nominal loop; `None` if it is not known to be stable.
    pub nominal: Option<NominalMargins>,
    /// Least |1 + L| of the family; `None` unless it is stable.
    pub modulus_margin: Option<f64>,
    /// Least delay that makes a plant unstable, s; `None` unless the family is stable.
    pub delay_margin_s: Option<f64>,
}

impl LoopFigures {
    /// Highest frequency at which |L| of the nominal loop is 1, rad/s, which a resonance may raise
    /// far beyond the crossover; `None` if |L| does not cross 1, or the loop is not known to be
    /// stable.
    pub fn last_crossing_rad_per_s(&self) -> Option<f64> {
        let nominal = self.nominal.as_ref()?;
        Some(nominal.crossover_rad_per_s).filter(|crossing| *crossing > 0.0)
    }
}

impl AuditedController {
    /// A controller with the audit of its loop.
    ///
    /// # Errors
    /// [`LinearError`] for a controller or a nominal plant that is not a transfer function.
    pub fn new(
        controller: Controller,
        problem: RobustProblem,
        view: ProjectAudit,
    ) -> Result<AuditedController, LinearError> {
        let figures = figures(&controller, &problem, &view)?;
        Ok(AuditedController { controller, problem, view, figures })
    }

    /// Loop with its audit.
    pub(super) fn audited(&self) -> AuditedProblem<'_> {
        AuditedProblem { problem: &self.problem, view: &self.view }
    }

    /// True if the controller is given in z.
    pub fn is_in_z(&self) -> bool {
        let law = self.controller.feedback.transfer_function();
        law.is_ok_and(|law| law.domain() != TimeDomain::Continuous)
    }
}

fn figures(
    controller: &Controller,
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> Result<LoopFigures, LinearError> {
    let law = controller.feedback.transfer_function()?;
    let (zeros, poles) = (law.zeros().len() as i64, law.poles().len() as i64);
    let stability = &view.audit.stability;
    let deployed = problem.compensation.feedback();
    let end = problem.compensation.highest_frequency_rad_per_s();
    Ok(LoopFigures {
        order: law.poles().len(),
        relative_degree: poles - zeros,
        high_frequency_gain_db: decibels(match law.domain() {
            TimeDomain::Continuous => law.gain().abs(),
            TimeDomain::Discrete { .. } => portable::magnitude(deployed.at_frequency(end)),
        }),
        prefilter_order: controller.prefilter.transfer_function()?.poles().len(),
        nominal: view.nominal,
        modulus_margin: stability.closest_approach.as_ref().map(|approach| approach.distance),
        delay_margin_s: view.audit.delay_margin.as_ref().map(|margin| margin.delay_s),
    })
}
