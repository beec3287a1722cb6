//! Limits that leave the search of a design no room.

use phea_qft::design::{BINDING_DB, DesignStatus, PoleRange};
use phea_qft::loop_shaping::Structure;
use phea_qft::verification::SpecificationFinding;

use super::{DesignLimit, DesignLimitKind, ProjectDesign};

/// Fraction of a required delay margin, of the limit of a command and of the end of a range of
/// poles within which it binds.
const NEAR: f64 = 0.01;

/// Reason that led the last search of a design.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LedBy {
    /// Limits over frequency.
    #[default]
    Frequency,
    /// Steps of the linear loop.
    LinearSteps,
    /// Steps of the linear loop with the contribution of the nonlinear rig in its runs.
    NonlinearRuns,
}

/// A limit that a search satisfies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchedLimit {
    /// A specification of the project, by its index.
    Specification(usize),
    /// A limit of a deployable controller.
    Design(DesignLimitKind),
}

impl ProjectDesign {
    /// Finding of the audit for a limit that is a specification.
    pub fn limit_finding(&self, kind: DesignLimitKind) -> Option<&SpecificationFinding> {
        self.limit_findings.iter().find(|(known, _)| *known == kind).map(|(_, found)| found)
    }

    /// True if a limit of a deployable controller leaves the search no room; `None` if that is not
    /// known. A specification binds within [`BINDING_DB`] of its limit.
    pub fn binds(&self, limit: &DesignLimit) -> Option<bool> {
        match limit.kind {
            DesignLimitKind::NoiseToCommand
            | DesignLimitKind::ModulusMargin
            | DesignLimitKind::HighestBandwidth
            | DesignLimitKind::PrefilterGain
            | DesignLimitKind::RequiredStep => {
                let margin_db = self.limit_finding(limit.kind)?.worst.as_ref()?.margin_db;
                let own = self.designed.problem.specifications.len();
                let index = self.limit_findings.iter().position(|(known, _)| *known == limit.kind);
                let is_touched = index.is_some_and(|index| self.touched().contains(&(own + index)));
                Some(margin_db < BINDING_DB || is_touched)
            }
            DesignLimitKind::MinimumDelayMargin => {
                let margin_s = self.designed.figures.delay_margin_s?;
                Some(margin_s <= (1.0 + NEAR) * limit.value)
            }
            DesignLimitKind::CommandOfSteps => Some(self.command_of_steps.as_ref()?.ratio() >= 1.0 - NEAR),
            DesignLimitKind::PoleDampingRatio | DesignLimitKind::FastestPole => {
                Some(self.is_at_end(limit.kind))
            }
        }
    }

    /// Specifications of the search that the loop touches, or with which it is in conflict, by
    /// their indices: those of the project, then those of its limits.
    pub(super) fn touched(&self) -> Vec<usize> {
        let conflicts = match &self.design.status {
            DesignStatus::Infeasible(relaxation) => relaxation.conflicts.as_slice(),
            _ => &[],
        };
        let touched = self.design.binding.iter().map(|one| one.specification);
        touched.chain(conflicts.iter().map(|one| one.specification)).collect()
    }

    /// True if a free number is at an end of its range that this limit moves.
    fn is_at_end(&self, kind: DesignLimitKind) -> bool {
        let (own, wider) = (self.design.structure.bounds(), self.structure_with_wider(kind).bounds());
        let is_near = |one: f64, other: f64| (one - other).abs() < NEAR;
        own.iter().zip(wider).zip(&self.design.free_numbers).any(|((own, wider), number)| {
            [0, 1].into_iter().any(|end| own[end] != wider[end] && is_near(own[end], *number))
        })
    }

    /// The structure with poles in a range that is wider by this limit.
    pub(super) fn structure_with_wider(&self, kind: DesignLimitKind) -> Structure {
        let poles = self.options.poles;
        let wider = match kind {
            DesignLimitKind::PoleDampingRatio => {
                PoleRange { least_damping_ratio: kind.relaxed(poles.least_damping_ratio), ..poles }
            }
            DesignLimitKind::FastestPole => {
                PoleRange { fastest_rad_per_s: kind.relaxed(poles.fastest_rad_per_s), ..poles }
            }
            _ => poles,
        };
        self.design.structure.with_poles_in([poles, wider])
    }
}
