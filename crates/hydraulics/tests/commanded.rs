//! A machine whose first input is its command, to differentiate it by.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Plant, System};
use phea_hydraulics::machine::Machine;

/// The second number is the gain from the load's velocity to the command, V s/m.
pub(super) struct Commanded(pub(super) Machine, pub(super) f64);

impl System<f64> for Commanded {
    fn states(&self) -> usize {
        self.0.states()
    }
    fn inputs(&self) -> usize {
        1 + self.0.inputs()
    }
    fn scales(&self) -> Vec<f64> {
        self.0.scales()
    }
    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let velocity: T = Plant::<f64>::disturbance(&self.0, state, &inputs[1..]);
        self.0.rates(state, inputs[0] + velocity.times(self.1), &inputs[1..], rates);
    }
    fn delays(&self) -> Vec<f64> {
        self.0.delays()
    }
    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        self.0.outgoing(state, &inputs[1..], waves);
    }
}
