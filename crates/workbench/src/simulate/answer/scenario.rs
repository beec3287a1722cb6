//! The run of a scenario.

use super::event::{OccurrenceAnswer, ScenarioEventAnswer, event, occurrence};
use super::gas::{BeyondExpansionAnswer, ChamberGasAnswer, GasAdjustmentAnswer, adjustment, beyond, gas};
use super::growth::{AmplificationAnswer, UnfollowedKinksAnswer, amplification, unfollowed};
use super::ledger::{RunLedgersAnswer, ledgers};
use super::limits::{ExceededRigLimitAnswer, exceeded};
use super::repetition::{DivergenceAnswer, RepetitionAnswer, divergence, repetition};
use super::step_counts::StepCountsAnswer;
use crate::answer::{Answer, Reasoned};
use crate::quantity::{MotionKind, QuantityName};
use crate::simulate::check::{self, ToleranceCheckAnswer};
use crate::simulate::reasons::{no_ledger_words, not_saved_words, unmeasured_words};
use crate::simulate::required::{ScenarioRequirementAnswer, requirement};
use crate::simulate::{Overlay, RunStatus, ScenarioRequirement, ScenarioRun, StoppedRun, UnresolvedMode};

/// Run of a scenario.
#[derive(Answer)]
pub(super) struct ScenarioAnswer {
    /// Name of the scenario.
    name: String,
    /// Status of the run.
    status: RunStatus,
    /// Simulated time at which the run ended early.
    end_time_s: Reasoned<f64>,
    /// Divergence of a run that reached its end.
    divergence: Reasoned<DivergenceAnswer>,
    /// Growing mode whose oscillation needs more steps than are permitted.
    unresolved_mode: Reasoned<UnresolvedModeAnswer>,
    /// Steps of the reported pass.
    work: StepCountsAnswer,
    /// Tolerance of the integration in the reported pass.
    tolerance: f64,
    /// Time between two samples of the signals.
    sample_interval_s: f64,
    /// True if a stated command drives the valve and no controller.
    open_loop: bool,
    /// Name of the file with the final state, which is written with `--out`.
    state_file: Reasoned<String>,
    /// Windows of the run with their metrics, each from an event to the next.
    events: Vec<ScenarioEventAnswer>,
    /// Beginnings and ends of conditions of the machine and of its command, in the order of time.
    occurrences: Vec<OccurrenceAnswer>,
    /// Time from which the equations of the machine do not hold.
    outside_model_s: Reasoned<f64>,
    /// Measured signals compared with the simulated ones.
    measured: Vec<MeasuredSignalAnswer>,
    /// Growth by which errors within the tolerance may become visible.
    errors_amplified: Reasoned<AmplificationAnswer>,
    /// Kinks from which no deviation was carried to the next, so that their amplification is not
    /// known.
    kinks_unfollowed: Reasoned<UnfollowedKinksAnswer>,
    /// Passes of a run that was repeated because errors may be visible.
    repetition: Reasoned<RepetitionAnswer>,
    /// Difference from a run at a tenth of the tolerance, if requested.
    check: Reasoned<ToleranceCheckAnswer>,
    /// Chambers whose pressure exceeded that up to which the expansion of their hose is stated.
    beyond_expansion: Vec<BeyondExpansionAnswer>,
    #[answer(flatten)]
    adjustment: GasAdjustmentAnswer,
    /// Gas at each chamber that has some.
    gas: Vec<ChamberGasAnswer>,
    /// Accounts of oil and energy over the run, if requested.
    ledgers: Reasoned<RunLedgersAnswer>,
    /// Limits of the rig that the run exceeds.
    exceeded: Vec<ExceededRigLimitAnswer>,
    /// Requirements in time against the steps of the run.
    requirements: Vec<ScenarioRequirementAnswer>,
}

/// Mode that grows and is not resolved.
#[derive(Answer)]
struct UnresolvedModeAnswer {
    /// Magnitude of its eigenvalue.
    frequency_rad_per_s: f64,
    /// Real part of its eigenvalue, which is positive.
    growth_per_s: f64,
}

/// Measured signal compared with the simulated one.
#[derive(Answer)]
struct MeasuredSignalAnswer {
    /// File with the measurement.
    file: String,
    /// Column of the file.
    column: String,
    /// Name of the simulated signal.
    signal: QuantityName,
    /// Number of compared rows.
    rows: usize,
    /// Number of rows before the scenario begins or after the simulated time.
    rows_outside: usize,
    /// Root mean square of the difference, in the SI unit of the signal.
    rmse: Reasoned<f64>,
    /// Ratio of `rmse` to the range of the measured values.
    nrmse: Reasoned<f64>,
}

const NOT_AMPLIFIED: &str = "no mode grew so much that errors within the tolerance may be visible";
const FOLLOWED: &str = "a deviation was carried along the run, or fewer than two steps pass a kink";

/// A run, with its final state in a file of this name.
pub(super) fn scenario(
    run: &ScenarioRun,
    state_file: String,
    requirements: &[ScenarioRequirement],
) -> ScenarioAnswer {
    let motion = run.record.units.motion;
    let end_time_s = StoppedRun::of(run.status).map(|stopped| stopped.time_s);
    let mode = run.stopped().and_then(|stopped| stopped.mode).map(unresolved);
    let check = run.check.as_ref().map(|check| check::answer(check, motion));
    let ledger = run.ledger.as_ref().map(|one| ledgers(one, motion));
    let state_file = run.end.as_ref().map(|_| state_file);
    ScenarioAnswer {
        name: run.name.clone(),
        status: run.run_status(),
        end_time_s: Reasoned::new(end_time_s, "it ran to its end"),
        divergence: Reasoned::new(run.divergence.map(divergence), "it does not diverge"),
        unresolved_mode: Reasoned::new(mode, "every mode that grew was resolved"),
        work: run.work.into(),
        tolerance: run.tolerance,
        sample_interval_s: run.sample_interval_s,
        open_loop: run.open_loop,
        state_file: Reasoned::of(state_file.map_err(|why| not_saved_words(*why))),
        events: run.windows.iter().map(|one| event(one, motion)).collect(),
        occurrences: run.occurrences.iter().map(occurrence).collect(),
        outside_model_s: Reasoned::new(run.outside_model_s, "its equations hold throughout"),
        measured: run.measured.iter().map(|one| overlay(one, motion)).collect(),
        errors_amplified: Reasoned::new(run.errors_amplified.map(amplification), NOT_AMPLIFIED),
        kinks_unfollowed: Reasoned::new(run.unfollowed.map(unfollowed), FOLLOWED),
        repetition: Reasoned::new(
            run.repetition.as_ref().map(|one| repetition(one, motion)),
            "one pass was enough",
        ),
        check: Reasoned::new(check, "it was not checked"),
        beyond_expansion: run.beyond_expansion.iter().map(beyond).collect(),
        adjustment: adjustment(run),
        gas: run.gas.iter().map(gas).collect(),
        ledgers: Reasoned::of(ledger.map_err(|why| no_ledger_words(*why))),
        exceeded: run.exceeded.iter().map(exceeded).collect(),
        requirements: requirements.iter().map(requirement).collect(),
    }
}

fn unresolved(mode: UnresolvedMode) -> UnresolvedModeAnswer {
    UnresolvedModeAnswer { frequency_rad_per_s: mode.frequency_rad_per_s, growth_per_s: mode.growth_per_s }
}

/// A measured signal and the simulated one.
fn overlay(overlay: &Overlay, motion: MotionKind) -> MeasuredSignalAnswer {
    MeasuredSignalAnswer {
        file: overlay.file.clone(),
        column: overlay.column.clone(),
        signal: overlay.signal.quantity(),
        rows: overlay.times_s.len(),
        rows_outside: overlay.rows_outside,
        rmse: Reasoned::of(overlay.rmse.map_err(|why| unmeasured_words(why, motion))),
        nrmse: Reasoned::of(overlay.nrmse.map_err(|why| unmeasured_words(why, motion))),
    }
}
