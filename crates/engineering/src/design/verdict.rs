//! The result of a design, by the first reason that decides it.

use phea_qft::design::{ControllerChoice, DesignStatus, NamedStructure};
use phea_qft::verification::Verdict;

use super::{DesignPart, ProjectDesign};
use crate::audit::DelayedPaths;
use crate::robust::DEFAULT_TOLERANCE_DB;

/// Result of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignVerdict {
    /// The watch stopped it: the controller is the best one until then.
    Stopped {
        /// True where it satisfies every specification and keeps every limit.
        is_met: bool,
        /// True where its trial on the nonlinear rig was finished.
        is_driven: bool,
        /// Failure of the nonlinear rig.
        miss: Option<RigMiss>,
    },
    /// Every specification is satisfied over the family, which lacks something that is declared.
    NotProven,
    /// The proof refutes what the search of the audit found to be met.
    Refuted,
    /// Every specification over frequency is satisfied, and linear steps miss what is required.
    StepsMissed,
    /// Every specification is satisfied, and the nonlinear rig misses what is required in time.
    MissedOnRig(RigMiss),
    /// Every specification is satisfied, and the prefilter amplifies by more than its limit.
    PrefilterAmplifies,
    /// Every specification is satisfied, and steps of the scenarios take more than their limit.
    CommandBeyondValve {
        /// Name of the scenario.
        scenario: String,
        /// Largest magnitude of the command, V.
        largest_v: f64,
        /// Most that it may be, V.
        limit_v: f64,
        /// Command that holds the force under any controller, where that is beyond the limit, V.
        held_v: Option<f64>,
    },
    /// Every specification is satisfied, and the loop tolerates less delay than is required.
    DelayNotTolerated(DelayedPaths),
    /// Every specification is satisfied and every limit kept.
    Met {
        /// Tolerance within which alone a margin is met, where that is more than the accuracy of
        /// margins, dB.
        tolerance_db: Option<f64>,
    },
    /// No controller that was tried makes the required steps; the nearest keeps everything else.
    StepsNotReached(TriedControllers),
    /// No controller that was tried satisfies every specification.
    Infeasible {
        /// The controllers.
        tried: TriedControllers,
        /// dB by which every limit is wider where one does.
        relaxation_db: f64,
    },
    /// No audit of a controller that the search found decides it.
    Undecided,
    /// The audit still finds what the search did not evaluate.
    NotConverged {
        /// Rounds of search and audit.
        rounds: usize,
        /// True where the controller satisfies every specification and keeps every limit.
        is_met: bool,
    },
    /// No controller that was tried makes every plant stable.
    NotStabilised(TriedControllers),
}

/// Failure of the nonlinear rig to do what is required in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigMiss {
    /// A run misses it.
    Missed,
    /// Every run satisfies it, without room for the plants between those that were driven.
    WithoutRoom,
}

/// The controllers among which a design was searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriedControllers {
    /// Controllers of the structure that the project gives.
    GivenStructure,
    /// Controllers of a named structure.
    Named(NamedStructure),
    /// Controllers up to an order.
    UpToOrder(usize),
}

impl TriedControllers {
    fn of(choice: &ControllerChoice) -> TriedControllers {
        match choice {
            ControllerChoice::Given(_) => TriedControllers::GivenStructure,
            ControllerChoice::Named { name, .. } => TriedControllers::Named(*name),
            ControllerChoice::Any { maximum_order, .. } | ControllerChoice::Grow { maximum_order } => {
                TriedControllers::UpToOrder(*maximum_order)
            }
        }
    }
}

impl ProjectDesign {
    /// The result of the design.
    pub fn verdict(&self) -> DesignVerdict {
        let tried = TriedControllers::of(&self.options.controller);
        match &self.design.status {
            _ if self.is_stopped() => DesignVerdict::Stopped {
                is_met: self.is_met(),
                is_driven: !self.unfinished.contains(&DesignPart::Trial),
                miss: self.rig_miss(),
            },
            DesignStatus::Met => self.verdict_where_met(),
            DesignStatus::Infeasible(_) if self.keeps_all_but_steps() => {
                DesignVerdict::StepsNotReached(tried)
            }
            DesignStatus::Infeasible(relaxation) => {
                DesignVerdict::Infeasible { tried, relaxation_db: relaxation.relaxation_db }
            }
            DesignStatus::NotConverged { .. } if self.designed.view.audit.verdict == Verdict::NotProven => {
                DesignVerdict::Undecided
            }
            DesignStatus::NotConverged { rounds } => {
                DesignVerdict::NotConverged { rounds: *rounds, is_met: self.is_met() }
            }
            DesignStatus::NotStabilised => DesignVerdict::NotStabilised(tried),
        }
    }

    /// The result where the search found every specification to be satisfied.
    fn verdict_where_met(&self) -> DesignVerdict {
        let view = &self.designed.view;
        if view.verdict() == Verdict::NotProven {
            return DesignVerdict::NotProven;
        }
        if view.audit.verdict == Verdict::Violated {
            return DesignVerdict::Refuted;
        }
        if view.misses_in_time() {
            return DesignVerdict::StepsMissed;
        }
        if let Some(miss) = self.rig_miss() {
            return DesignVerdict::MissedOnRig(miss);
        }
        if self.exceeded_prefilter_gain().is_some() {
            return DesignVerdict::PrefilterAmplifies;
        }
        match self.exceeded_command() {
            Some(command) => DesignVerdict::CommandBeyondValve {
                scenario: command.scenario.clone(),
                largest_v: command.largest_v,
                limit_v: command.limit_v,
                held_v: command.is_out_of_reach().then_some(command.at_rest_v),
            },
            None if !self.tolerates_its_delay => DesignVerdict::DelayNotTolerated(view.delayed_paths),
            None => DesignVerdict::Met { tolerance_db: self.needed_tolerance_db() },
        }
    }

    /// The tolerance, where a specification or a limit of the design is met within it alone, and it
    /// is more than what margins are computed to; dB.
    fn needed_tolerance_db(&self) -> Option<f64> {
        let limits = self.limit_findings.iter().filter(|(kind, _)| !kind.is_led_to()).map(|(_, found)| found);
        let all = self.designed.view.audit.specifications.iter().chain(limits);
        let margins = all.filter_map(|found| Some(found.worst.as_ref()?.margin_db));
        let least = margins.fold(f64::INFINITY, f64::min);
        (least < -DEFAULT_TOLERANCE_DB).then_some(self.designed.view.audit.tolerance_db)
    }

    /// True where a design misses what is required in time and nothing else.
    fn keeps_all_but_steps(&self) -> bool {
        let is_met = self.designed.view.audit.verdict == Verdict::Met && self.keeps_its_limits();
        is_met && self.designed.view.misses_in_time()
    }
}
