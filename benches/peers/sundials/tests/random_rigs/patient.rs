//! A loop of phea for CVODE: what its runs cost is counted, and they come to an end.

use std::cell::Cell;

use phea_machine::Control as Loop;
use sundials::Equations;

/// phea's own loop, as compiled for its users, whose rates cease to be numbers after this number of
/// evaluations: how a run on CVODE is ended.
pub(crate) struct Patient<'a> {
    control: &'a Loop,
    patience: u64,
    left: Cell<u64>,
    /// Steps tried, and the time of the last.
    steps: Cell<u64>,
    asked_at: Cell<f64>,
}

impl<'a> Patient<'a> {
    /// For so many evaluations.
    pub(crate) fn new(control: &'a Loop, patience: u64) -> Patient<'a> {
        let (left, steps, asked_at) = (Cell::new(patience), Cell::new(0), Cell::new(f64::NAN));
        Patient { control, patience, left, steps, asked_at }
    }

    /// Evaluations of the rates, and steps tried.
    pub(crate) fn cost(&self) -> [u64; 2] {
        [self.patience - self.left.get(), self.steps.get()]
    }
}

impl Equations for Patient<'_> {
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

    fn is_asked_at(&self, time: f64) {
        if self.asked_at.replace(time) != time {
            self.steps.set(self.steps.get() + 1);
        }
    }
}
