//! The accounts of oil and energy of a run.

use phea_engineering::simulate::{AccountSum, RunLedger};

use crate::answer::Answer;
use crate::quantity::MotionKind;

/// Accounts of oil and energy over a run; the last of each is that of the whole rig.
#[derive(Answer)]
pub(super) struct RunLedgersAnswer {
    /// Accounts of oil, in volume at zero gauge pressure except for the volumes of lines and gas.
    oil_m3: Vec<RunAccountAnswer>,
    /// Accounts of energy.
    energy_j: Vec<RunAccountAnswer>,
}

/// Account of a part of the rig over a run, in m3 or J.
#[derive(Answer)]
struct RunAccountAnswer {
    /// Part of the rig, or `rig`.
    part: &'static str,
    /// Content at the start and at the end.
    stored: [f64; 2],
    /// Net inflow through its ports over the run.
    inflow: f64,
    /// Loss over the run: dissipation, or for oil the loss of equations in volumes.
    lost: f64,
    /// Increase of the content less the inflow plus the loss, which is zero for an exact solution.
    closing_error: f64,
    /// Ratio of the magnitude of the closing error to the integral of the magnitudes of inflow and
    /// loss; zero if both are zero throughout.
    relative_error: f64,
}

/// The accounts, each with its closing error.
pub(super) fn ledgers(ledger: &RunLedger, motion: MotionKind) -> RunLedgersAnswer {
    let account = |sum: &AccountSum| RunAccountAnswer {
        part: if sum.part == "piston" { motion.words().piston } else { sum.part },
        stored: sum.stored,
        inflow: sum.inflow,
        lost: sum.lost,
        closing_error: sum.closing_error(),
        relative_error: sum.relative_error(),
    };
    RunLedgersAnswer {
        oil_m3: ledger.oil.iter().map(account).collect(),
        energy_j: ledger.energy.iter().map(account).collect(),
    }
}
