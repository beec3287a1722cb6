//! A design stepped by its owner.

use super::problem::{DesignOptions, DesignProblem};
use super::result::Design;

/// A design stepped by its owner, who may show its progress or stop it at any step.
#[derive(Clone, Debug)]
pub struct DesignRun {
    problem: DesignProblem,
    options: DesignOptions,
    design: Option<Design>,
}

impl DesignRun {
    /// A design that has not begun.
    pub fn new(problem: DesignProblem, options: DesignOptions) -> DesignRun {
        DesignRun { problem, options, design: None }
    }

    /// What it works on.
    pub fn problem(&self) -> &DesignProblem {
        &self.problem
    }

    /// How it works.
    pub fn options(&self) -> &DesignOptions {
        &self.options
    }

    /// Does a small part of the work; whether there is more to do.
    pub fn step(&mut self) -> bool {
        false
    }

    /// What is being done.
    pub fn stage(&self) -> &'static str {
        "shaping the loop"
    }

    /// The share of the work that is done, 0 to 1: an estimate, for the rounds that it takes are not known before.
    pub fn progress(&self) -> f64 {
        0.0
    }

    /// The best design so far; the last one once [`DesignRun::step`] has answered that there is nothing left.
    pub fn design(&self) -> Option<&Design> {
        self.design.as_ref()
    }
}
