//! Lines driven by the integrator of the machine, with delays from its histories.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    Input, InputSchedule, Profile, Simulated, SimulationSettings, Status, System, simulate,
};
use phea_hydraulics::line::{Conduit, DynamicLine, LineModel, LineWall, StiffeningMember, TransmissionLine};
use phea_hydraulics::reference_rig::hose_line;

use super::oracle::{conduit, fluid};

/// A flow into the valve port, a chamber of this compliance in m3/Pa out of which a flow is drawn:
/// states of the line, the chamber's pressure, the energy put in.
#[derive(Clone)]
struct Fed {
    line: DynamicLine,
    chamber: f64,
}

impl System<f64> for Fed {
    fn states(&self) -> usize {
        self.line.states() + 2
    }
    fn inputs(&self) -> usize {
        2 + self.line.delays().len()
    }
    fn scales(&self) -> Vec<f64> {
        [self.line.scales(1e5, 1e-4), vec![1e5, 1.0]].concat()
    }
    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let lines = self.line.states();
        let (inside, pressure) = (&state[..lines], state[lines]);
        let into_chamber = self.line.rates(inputs[0], pressure, inside, &inputs[2..], &mut rates[..lines]);
        rates[lines] = (into_chamber - inputs[1]) / T::from(self.chamber + self.line.chamber_compliance());
        let taken = inputs[1] + T::from(self.chamber) * rates[lines];
        rates[lines + 1] = self.line.port_pressure(inside, pressure) * inputs[0] - pressure * taken;
    }
    fn delays(&self) -> Vec<f64> {
        self.line.delays()
    }
    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let lines = self.line.states();
        self.line.outgoing(state[lines], &state[..lines], &inputs[2..], waves);
    }
}

impl Fed {
    fn run(&self, flow: f64, inflow: Profile, outflow: Profile, duration_s: f64) -> Simulated {
        let (state, waves) = self.line.steady_state(0.0, flow);
        let start = [state, vec![0.0, 0.0], waves].concat();
        let schedule = InputSchedule {
            duration_s,
            output_step_s: duration_s / 200.0,
            inputs: vec![Input::Value(inflow), Input::Value(outflow)],
        };
        let settings = SimulationSettings { tolerance: 1e-7, ..SimulationSettings::default() };
        let result = simulate(self, &start, &schedule, None, &settings, &mut |_| true).unwrap();
        assert_eq!(result.outcome.status, Status::Completed);
        result
    }
}

/// Water hammer at a shut valve: a flow that stops leaves -Z_c q, which the constant pressure at
/// the far end reflects with reversed sign: a square wave of the period 4 T.
#[test]
fn a_valve_that_shuts_leaves_a_square_wave() {
    let smooth = Conduit { kinematic_viscosity: 1e-12, ..conduit() };
    let line = DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&smooth, 2e-3).unwrap());
    let fed = Fed { line, chamber: 1.0 };
    let (flow, delay) = (1e-4, smooth.delay());
    let inflow = Profile::steps(flow, &[(delay, 0.0)]).unwrap();
    let result = fed.run(flow, inflow, Profile::constant(flow), 12.0 * delay);
    let rise = smooth.characteristic_impedance() * flow;
    let mut seen = [0, 0];
    for (time, state) in result.trajectory.times_s.iter().zip(&result.trajectory.states) {
        let phase = (time / delay - 1.0) / 2.0;
        let within = phase - phase.floor();
        if phase > 0.0 && (0.15..0.85).contains(&within) {
            let falls = (phase.floor() as usize).is_multiple_of(2);
            let expected = if falls { -rise } else { rise };
            assert!((state[0] / expected - 1.0).abs() < 0.05, "{} at {time} s", state[0] / rise);
            seen[usize::from(falls)] += 1;
        }
    }
    assert!(seen[0] > 30 && seen[1] > 30);
}

/// Models of one hose filled slowly agree; none supplies energy; each ends with the volume that
/// entered.
#[test]
fn all_models_of_a_hose_agree_on_a_slow_flow() {
    let models = [
        LineModel::Lumped,
        LineModel::Segments {
            count: 4,
            friction: phea_hydraulics::line::LaminarFriction::FrequencyDependent,
            relaxation_time: None,
        },
        LineModel::TransmissionLine { end_share: 0.01 },
        LineModel::TwoWave { end_share: 0.01, wall: LineWall::default() },
    ];
    let compliance = hose_line().compliance(1.45e9, StiffeningMember::Nominal);
    for model in models {
        let line = DynamicLine::new(&hose_line(), &fluid(), 35e5, StiffeningMember::Nominal, &model).unwrap();
        let fed = Fed { line, chamber: 1e-13 };
        let inflow = Profile::smooth_step(0.0, 0.4, 1e-4).unwrap();
        let result = fed.run(0.0, inflow, Profile::constant(0.0), 0.5);
        // a smooth step is half its height on average
        let given = 1e-4 * (0.2 + 0.1);
        let lines = fed.line.states();
        let mut energy = 0.0;
        for state in &result.trajectory.states {
            assert!(state[lines + 1] > -1e-9, "{model:?} gives energy");
            energy = state[lines + 1];
        }
        let pressure = result.outcome.end[lines];
        let expected = given / (compliance + fed.chamber);
        assert!((pressure / expected - 1.0).abs() < 2e-3, "{model:?}: {pressure} against {expected}");
        // half of p V stays in the line, the loss to friction is small
        let stored = 0.5 * compliance * pressure * pressure;
        assert!((energy / stored - 1.0).abs() < 0.01, "{model:?}: {energy} J against {stored} J");
        assert!(result.outcome.work.steps < 4000, "{:?}", result.outcome.work);
    }
}
