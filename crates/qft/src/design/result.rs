//! What a design ends with.

use phea_dynamics::controller::Controller;

use crate::loop_shaping::Structure;
use crate::verification::{Audit, PlantPoint};

/// Why a design ended.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignStatus {
    /// The audit finds that every specification is met.
    Met,
    /// No controller that was tried meets every specification; this is the smallest relaxation under which one does.
    Infeasible(Relaxation),
    /// The audit could not be brought to agree within the rounds allowed.
    NotConverged {
        /// How many rounds were made.
        rounds: usize,
    },
    /// No controller that was tried stabilises the family.
    NotStabilised,
}

/// The smallest common relaxation of all limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// dB added to every upper limit and taken from every lower one.
    pub relaxation_db: f64,
    /// The limits that stand against one another at it.
    pub conflicts: Vec<Conflict>,
}

/// A limit that is reached where the design can do no better.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// Index of the specification.
    pub specification: usize,
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
    /// Its margin to the limit as it was asked for, dB.
    pub margin_db: f64,
}

/// What the specification costs: the limits that the loop of the design touches.
#[derive(Clone, Debug, PartialEq)]
pub struct BindingLimit {
    /// Index of the specification.
    pub specification: usize,
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// The plant with the least margin.
    pub plant: PlantPoint,
    /// That margin, dB.
    pub margin_db: f64,
}

/// One search with the audit that followed it.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRound {
    /// What was shaped.
    pub structure: Structure,
    /// Its objective, dB.
    pub objective_db: f64,
    /// Plants that were looked at by the search.
    pub plants: usize,
    /// Frequencies that were looked at by the search.
    pub frequencies: usize,
    /// Worst margin on them, dB.
    pub searched_margin_db: f64,
    /// Worst margin of the audit, dB; `None` where the audit finds the family unstable.
    pub audited_margin_db: Option<f64>,
}

/// A controller, its prefilter, and the audit of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Why it ended.
    pub status: DesignStatus,
    /// Controller, prefilter and timing, as they are deployed and were audited: where coefficients are rounded, in z and with those.
    pub controller: Controller,
    /// The same before it was sampled and rounded.
    pub law: Controller,
    /// What was shaped.
    pub structure: Structure,
    /// Its objective, dB.
    pub objective_db: f64,
    /// Its audit against the specifications as they were asked for.
    pub audit: Audit,
    /// The limits that it touches, by frequency.
    pub binding: Vec<BindingLimit>,
    /// How it came about.
    pub rounds: Vec<DesignRound>,
}
