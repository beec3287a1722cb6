//! Result of a design, by the first reason that decides it.

use phea_qft::design::{ControllerChoice, DesignStatus, NamedStructure};
use phea_qft::verification::Verdict;

use super::{DesignPart, ProjectDesign};
use crate::audit::DelayedPaths;
use crate::robust::DEFAULT_TOLERANCE_DB;

/// Result of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignVerdict {
    /// `watch` cancelled the design: the controller is the best one until then.
    Stopped {
        /// True if the controller satisfies every specification and every limit.
        is_met: bool,
        /// True if its trial on the nonlinear rig was finished.
        is_driven: bool,
        /// Failure of the nonlinear rig.
        miss: Option<RigMiss>,
    },
    /// Every specification is satisfied over the family, which lacks a declared effect.
    NotProven,
    /// The proof refutes a specification that the search of the audit found to be met.
    Refuted,
    /// Every specification over frequency is satisfied, but linear steps miss a requirement.
    StepsMissed,
    /// Every specification is satisfied, but the nonlinear rig misses a requirement in time.
    MissedOnRig(RigMiss),
    /// Every specification is satisfied, but the prefilter amplifies by more than its limit.
    PrefilterAmplifies,
    /// Every specification is satisfied, but steps of the scenarios need more command than its
    /// limit.
    CommandBeyondValve {
        /// Name of the scenario.
        scenario: String,
        /// Largest magnitude of the command, V.
        largest_v: f64,
        /// Largest permitted magnitude, V.
        limit_v: f64,
        /// Command that holds the force under any controller, if it is beyond the limit, V.
        held_v: Option<f64>,
    },
    /// Every specification is satisfied, but the loop tolerates less delay than is required.
    DelayNotTolerated(DelayedPaths),
    /// Every specification and every limit is satisfied.
    Met {
        /// Tolerance without which a margin is not met, if it is larger than the accuracy of
        /// margins, dB.
        tolerance_db: Option<f64>,
    },
    /// None of the controllers makes the required steps; the nearest one satisfies everything else.
    StepsNotReached(SearchedControllers),
    /// None of the controllers satisfies every specification.
    Infeasible {
        /// Controllers of the search.
        searched: SearchedControllers,
        /// Amount by which every limit must be wider for one of them, dB.
        relaxation_db: f64,
    },
    /// No audit of a controller from the search decides it.
    Undecided,
    /// The audit still finds deficits that the search did not evaluate.
    NotConverged {
        /// Number of rounds of search and audit.
        rounds: usize,
        /// True if the controller satisfies every specification and every limit.
        is_met: bool,
    },
    /// None of the controllers makes every plant stable.
    NotStabilised(SearchedControllers),
}

/// Failure of the nonlinear rig to satisfy a requirement in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigMiss {
    /// A run misses the requirement.
    Missed,
    /// Every run satisfies the requirement, without room for the plants between the simulated ones.
    WithoutRoom,
}

/// Controllers among which a design was searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchedControllers {
    /// Controllers of the structure that the project gives.
    GivenStructure,
    /// Controllers of a named structure.
    Named(NamedStructure),
    /// Controllers up to an order.
    UpToOrder(usize),
}

impl SearchedControllers {
    fn of(choice: &ControllerChoice) -> SearchedControllers {
        match choice {
            ControllerChoice::Given(_) => SearchedControllers::GivenStructure,
            ControllerChoice::Named { name, .. } => SearchedControllers::Named(*name),
            ControllerChoice::Any { maximum_order, .. } | ControllerChoice::Grow { maximum_order } => {
                SearchedControllers::UpToOrder(*maximum_order)
            }
        }
    }
}

impl ProjectDesign {
    /// Result of the design.
    pub fn verdict(&self) -> DesignVerdict {
        let searched = SearchedControllers::of(&self.options.controller);
        match &self.design.status {
            _ if self.is_stopped() => DesignVerdict::Stopped {
                is_met: self.is_met(),
                is_driven: !self.unfinished.contains(&DesignPart::Trial),
                miss: self.rig_miss(),
            },
            DesignStatus::Met => self.verdict_where_met(),
            DesignStatus::Infeasible(_) if self.keeps_all_but_steps() => {
                DesignVerdict::StepsNotReached(searched)
            }
            DesignStatus::Infeasible(relaxation) => {
                DesignVerdict::Infeasible { searched, relaxation_db: relaxation.relaxation_db }
            }
            DesignStatus::NotConverged { .. } if self.designed.view.audit.verdict == Verdict::NotProven => {
                DesignVerdict::Undecided
            }
            DesignStatus::NotConverged { rounds } => {
                DesignVerdict::NotConverged { rounds: *rounds, is_met: self.is_met() }
            }
            DesignStatus::NotStabilised => DesignVerdict::NotStabilised(searched),
        }
    }

    /// Result if the search found every specification to be satisfied.
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

    /// Tolerance without which a specification or a limit of the design is not met, if it is larger
    /// than the accuracy of margins, dB.
    fn needed_tolerance_db(&self) -> Option<f64> {
        let limits = self.limit_findings.iter().filter(|(kind, _)| !kind.is_led_to()).map(|(_, found)| found);
        let all = self.designed.view.audit.specifications.iter().chain(limits);
        let margins = all.filter_map(|found| Some(found.worst.as_ref()?.margin_db));
        let least = margins.fold(f64::INFINITY, f64::min);
        (least < -DEFAULT_TOLERANCE_DB).then_some(self.designed.view.audit.tolerance_db)
    }

    /// True if a design misses only a requirement in time.
    fn keeps_all_but_steps(&self) -> bool {
        let is_met = self.designed.view.audit.verdict == Verdict::Met && self.satisfies_its_limits();
        is_met && self.designed.view.misses_in_time()
    }
}
