//! Balances of oil and energy of a run: for each part the content at start and end, the inflow, the
//! loss, and the closing error.

use phea_dynamics::simulation::{Stretch, gauss_points};
use phea_hydraulics::machine::{Account, ENERGY_ACCOUNTS, Ledger, OIL_ACCOUNTS};

use super::bench::ControlledMachine;

/// Balance over a run.
///
/// ```text
/// error = held at the end - held at the start - inflow + lost
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccountSum {
    /// Part: one of [`OIL_ACCOUNTS`] or [`ENERGY_ACCOUNTS`].
    pub part: &'static str,
    /// Content at the start and at the end, m3 or J.
    pub stored: [f64; 2],
    /// Inflow, m3 or J.
    pub inflow: f64,
    /// Loss, m3 or J.
    pub lost: f64,
    /// Integral of the magnitudes of inflow and loss, m3 or J.
    pub throughput: f64,
}

impl AccountSum {
    /// Closing error, m3 or J.
    pub fn closing_error(&self) -> f64 {
        self.stored[1] - self.stored[0] - self.inflow + self.lost
    }

    /// Ratio of closing error to throughput; zero without throughput.
    pub fn relative_error(&self) -> f64 {
        if self.throughput > 0.0 { self.closing_error().abs() / self.throughput } else { 0.0 }
    }
}

/// Balances of a run; the last of each list is that of the whole rig.
#[derive(Clone, Debug, PartialEq)]
pub struct RunLedger {
    /// Balances of oil, m3 at zero gauge pressure.
    pub oil: Vec<AccountSum>,
    /// Balances of energy, J.
    pub energy: Vec<AccountSum>,
}

/// Reason why a run has no balances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLedger {
    /// The balances were not requested.
    NotRequested,
    /// No balance contains the waves in transit along a line.
    InTransit,
}

/// Sums the balances over each step of the integration.
pub(super) struct LedgerWatch {
    sums: Vec<AccountSum>,
    begun: bool,
    /// Storage for states and inputs.
    states: Vec<f64>,
    inputs: Vec<f64>,
}

impl LedgerWatch {
    pub(super) fn of(bench: &ControlledMachine) -> LedgerWatch {
        let [states, inputs] = bench.control.size();
        let empty = |&part: &&'static str| AccountSum {
            part,
            stored: [0.0; 2],
            inflow: 0.0,
            lost: 0.0,
            throughput: 0.0,
        };
        LedgerWatch {
            sums: OIL_ACCOUNTS.iter().chain(&ENERGY_ACCOUNTS).map(empty).collect(),
            begun: false,
            states: vec![0.0; states],
            inputs: vec![0.0; inputs],
        }
    }

    /// Balances at a part of a step, of which all states are requested; `None` with waves.
    fn at(
        &mut self,
        bench: &ControlledMachine,
        stretch: &Stretch<'_>,
        part: f64,
    ) -> Option<impl Iterator<Item = Account<f64>> + use<>> {
        let LedgerWatch { states, inputs, .. } = self;
        states.iter_mut().zip(stretch.states).for_each(|(state, over)| *state = over.at(part));
        stretch.inputs_at(part, inputs);
        let own = inputs.get(bench.control.leading_inputs()..).unwrap_or_default();
        let Ledger { oil, energy } = bench.machine.ledger(states, own)?;
        Some(oil.into_iter().chain(energy))
    }

    /// Takes a step.
    pub(super) fn follow(&mut self, bench: &ControlledMachine, stretch: &Stretch<'_>) {
        if !self.begun {
            let Some(accounts) = self.at(bench, stretch, 0.0) else { return };
            self.sums.iter_mut().zip(accounts).for_each(|(sum, account)| sum.stored = [account.stored; 2]);
            self.begun = true;
        }
        let length_s = stretch.end_s() - stretch.start_s();
        for (part, weight) in gauss_points() {
            let Some(accounts) = self.at(bench, stretch, part) else { return };
            let width_s = weight * length_s;
            for (sum, Account { inflow, lost, .. }) in self.sums.iter_mut().zip(accounts) {
                sum.inflow += width_s * inflow;
                sum.lost += width_s * lost;
                sum.throughput += width_s * (inflow.abs() + lost.abs());
            }
        }
        let Some(accounts) = self.at(bench, stretch, 1.0) else { return };
        self.sums.iter_mut().zip(accounts).for_each(|(sum, account)| sum.stored[1] = account.stored);
    }

    /// Balances of the parts with any content or throughput, and of the rig; absent with waves
    /// along a line, and without a step.
    pub(super) fn finish(self) -> Result<RunLedger, NoLedger> {
        let is_used = |sum: &AccountSum| {
            sum.part == "rig" || sum.throughput != 0.0 || sum.stored.iter().any(|stored| *stored != 0.0)
        };
        let of = |sums: &[AccountSum]| sums.iter().filter(|sum| is_used(sum)).copied().collect();
        let (oil, energy) = self.sums.split_at_checked(OIL_ACCOUNTS.len()).ok_or(NoLedger::InTransit)?;
        if self.begun { Ok(RunLedger { oil: of(oil), energy: of(energy) }) } else { Err(NoLedger::InTransit) }
    }
}
