//! Table `[simulation]`: the accuracy of simulations.

use phea_dynamics::simulation::Method;
use phea_quantity::RATIO;
use phea_table::Visitor;
use phea_table::{key, plain};

/// Method, accuracy, random numbers and largest effort.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulation {
    /// Integration method.
    pub method: Method,
    /// Largest error of a step, relative to each state plus its scale.
    pub tolerance: f64,
    /// Number of steps after which a simulation ends.
    pub maximum_steps: u32,
    /// Seed of all random numbers.
    pub seed: u32,
}

impl Default for Simulation {
    fn default() -> Simulation {
        Simulation { method: Method::default(), tolerance: 1e-6, maximum_steps: 10_000_000, seed: 1 }
    }
}

impl Simulation {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[("rosenbrock", Method::Rosenbrock), ("dormand_prince", Method::DormandPrince)];
        v.choice(plain("method", "How steps are made."), words, &mut self.method, false);
        let k = key("tolerance", &RATIO, "Largest error of a step, relative to each state plus its scale.");
        v.quantity(k.at_least(1e-12).at_most(1e-2).or(1e-6), &mut self.tolerance);
        let k = key("maximum_steps", &RATIO, "Number of steps after which a simulation ends.").at_least(1.0);
        v.count(k.at_most(4e9).or(1e7), &mut self.maximum_steps);
        let k = key("seed", &RATIO, "Seed of all random numbers.").not_negative().at_most(4e9).or(1.0);
        v.count(k, &mut self.seed);
    }
}
