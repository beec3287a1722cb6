//! A loop of phea for CVODE that counts the cost of its runs and ends them.

use std::cell::Cell;

use phea_machine::Control as Loop;
use sundials::Equations;

/// Loop of phea, as compiled for its users, whose rates cease to be numbers after this number of
/// evaluations, which ends a run of CVODE.
pub(crate) struct Limited<'a> {
    control: &'a Loop,
    evaluation_limit: u64,
    left: Cell<u64>,
    /// Number of attempted steps, and the time of the last.
    steps: Cell<u64>,
    evaluated_at: Cell<f64>,
}

impl<'a> Limited<'a> {
    /// Wraps a loop for this number of evaluations.
    pub(crate) fn new(control: &'a Loop, evaluation_limit: u64) -> Limited<'a> {
        let (left, steps, evaluated_at) = (Cell::new(evaluation_limit), Cell::new(0), Cell::new(f64::NAN));
        Limited { control, evaluation_limit, left, steps, evaluated_at }
    }

    /// Number of evaluations of the rates, and of attempted steps.
    pub(crate) fn cost(&self) -> [u64; 2] {
        [self.evaluation_limit - self.left.get(), self.steps.get()]
    }
}

impl Equations for Limited<'_> {
    fn states(&self) -> usize {
        self.control.size()[0]
    }

    fn inputs(&self) -> usize {
        self.control.size()[1]
    }

    fn scales(&self) -> Vec<f64> {
        self.control.scales()
    }

    fn delays(&self) -> Vec<f64> {
        self.control.delays()
    }

    fn outgoing(&self, state: &[f64], inputs: &[f64], waves: &mut [f64]) {
        self.control.outgoing(state, inputs, waves);
    }

    fn rates(&self, state: &[f64], inputs: &[f64], rates: &mut [f64]) {
        self.control.rates(state, inputs, rates);
        self.left.set(self.left.get().saturating_sub(1));
        if self.left.get() == 0 {
            rates.fill(f64::NAN);
        }
    }

    fn is_evaluated_at(&self, time: f64) {
        if self.evaluated_at.replace(time) != time {
            self.steps.set(self.steps.get() + 1);
        }
    }
}
