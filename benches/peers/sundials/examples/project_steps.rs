//! Steps of CVODE and of phea on the first scenario of a project under a continuous controller, at
//! some tolerances.
//!
//!     cargo run -p sundials --example project_steps -- rig.toml 1e-6 1e-8
//!
//! Both solve identical equations. CVODE restarts at each break of an input, with the detection of
//! its stability limit: without it a lightly damped mode makes it take even more steps.

use std::cell::Cell;

use phea_dynamics::simulation::{Observer, SimulationSettings, Task};
use phea_engineering::setup::Setup;
use phea_engineering::simulate::{ScenarioProblem, scenario_problems};
use phea_machine::Watcher;
use phea_project::source::Memory;
use sundials::{Equations, Following, Method, follow};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let path = words.next().ok_or("the name of a project")?;
    let source = Memory::default().with("rig.toml", std::fs::read_to_string(path)?);
    let loaded = phea_project::read(&source, "rig.toml", &[], &[]).map_err(|report| report.to_string())?;
    let setup = Setup::new(&loaded.project)?;
    let problem = scenario_problems(&source, &setup)?.swap_remove(0);
    for word in words {
        let tolerance = word.parse()?;
        let settings = SimulationSettings { tolerance, ..SimulationSettings::default() };
        let task = Task {
            start: problem.start.clone(),
            schedule: &problem.schedule,
            sampler: None,
            observer: Box::new(Nobody) as Watcher<'_>,
        };
        let outcome = problem.control.drive(task, &settings, &mut |_| true)?;
        println!("{tolerance:e}: phea {:?}, {:?}", outcome.status, outcome.work);
        for method in [Method::BackwardDifferentiation, Method::StabilityLimit, Method::Adams] {
            let counted =
                Counted { problem: &problem, evaluated_at: Cell::new(f64::NAN), steps: Cell::new(0) };
            let following = Following::new(tolerance, method);
            let rows = follow(&counted, &problem.start, &problem.schedule, None, &following);
            println!(
                "  CVODE {method:?}: {:?}, {} steps tried",
                rows.map(|rows| rows.len()),
                counted.steps.get()
            );
        }
    }
    Ok(())
}

struct Nobody;

impl Observer for Nobody {
    fn wanted(&self) -> &[usize] {
        &[]
    }
    fn observe(&mut self, _time_s: f64, _states: &[f64], _inputs: &[f64]) {}
}

/// Counts the times at which rates are computed: one for each attempted step.
struct Counted<'a> {
    problem: &'a ScenarioProblem,
    evaluated_at: Cell<f64>,
    steps: Cell<u64>,
}

impl Equations for Counted<'_> {
    fn states(&self) -> usize {
        self.problem.control.size()[0]
    }
    fn inputs(&self) -> usize {
        self.problem.control.size()[1]
    }
    fn scales(&self) -> Vec<f64> {
        self.problem.control.scales()
    }
    fn delays(&self) -> Vec<f64> {
        self.problem.control.delays()
    }
    fn rates(&self, state: &[f64], inputs: &[f64], rates: &mut [f64]) {
        self.problem.control.rates(state, inputs, rates);
    }
    fn outgoing(&self, state: &[f64], inputs: &[f64], waves: &mut [f64]) {
        self.problem.control.outgoing(state, inputs, waves);
    }
    fn is_evaluated_at(&self, time: f64) {
        if self.evaluated_at.replace(time) != time {
            self.steps.set(self.steps.get() + 1);
        }
    }
}
