//! Machine without a controller under an input schedule, with all of its states recorded.

#![allow(clippy::unwrap_used, reason = "a helper of tests")]

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{
    CommandedPlant, Input, InputSchedule, Observer, Outcome, Profile, Sensed, SimulationSettings, Task,
};
use phea_hydraulics::machine::Machine;
use phea_machine::Control;

/// States and inputs of the machine at each row.
pub(crate) struct Driven {
    pub(crate) times_s: Vec<f64>,
    pub(crate) states: Vec<Vec<f64>>,
    pub(crate) inputs: Vec<Vec<f64>>,
    pub(crate) outcome: Outcome,
}

#[derive(Default)]
struct Rows {
    times_s: Vec<f64>,
    states: Vec<Vec<f64>>,
    inputs: Vec<Vec<f64>>,
}

struct Recorder<'r> {
    wanted: Vec<usize>,
    rows: &'r mut Rows,
}

impl Observer for Recorder<'_> {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        self.rows.times_s.push(time_s);
        self.rows.states.push(states.to_vec());
        self.rows.inputs.push(inputs.to_vec());
    }
}

/// Simulated machine from a state, followed by the waves in transit, under a command, V, with its
/// ground moved.
pub(crate) fn driven(
    machine: Machine,
    start: Vec<f64>,
    [duration_s, output_step_s]: [f64; 2],
    command: Profile,
    ground: Profile,
    settings: &SimulationSettings,
) -> Driven {
    let one = TransferFunction::gain_only(1.0);
    let open = CommandedPlant::on_hold(Sensed::new(machine, &one).unwrap(), &one).unwrap();
    let control = Control::Open(Box::new(open));
    let reference = Input::Value(Profile::constant(0.0));
    let inputs = vec![Input::Value(command), reference, Input::Value(ground.clone()), Input::Rate(ground)];
    let schedule = InputSchedule { duration_s, output_step_s, inputs };
    let leading = control.leading_inputs();
    let mut rows = Rows::default();
    let recorder = Recorder { wanted: (0..control.size()[0]).collect(), rows: &mut rows };
    let task =
        Task { start, schedule: &schedule, sampler: None, observer: Box::new(recorder) as Box<dyn Observer> };
    let outcome = control.drive(task, settings, &mut |_| true).unwrap();
    let inputs = rows.inputs.into_iter().map(|all| all[leading..].to_vec()).collect();
    Driven { times_s: rows.times_s, states: rows.states, inputs, outcome }
}
