//! Lines in time, by a small fixed-step method with delays stored as histories.

use phea_hydraulics::line::{
    Conduit, DynamicLine, END_SHARE, LaminarFriction, Segments, StandardLinearSolid, StiffeningMember,
    TransmissionLine, TwoWaveHose,
};
use phea_hydraulics::reference_rig::hose;

use super::oracle::{conduit, fluid};

/// A line between a flow into its valve port and a chamber of this compliance in m3/Pa out of which
/// a flow is drawn.
struct Run {
    line: DynamicLine,
    chamber: f64,
    step: f64,
    time: f64,
    state: Vec<f64>,
    pressure: f64,
    sent: Vec<Vec<f64>>,
    at_rest: Vec<f64>,
}

impl Run {
    fn new(line: DynamicLine, chamber: f64, step: f64, pressure: f64) -> Run {
        let (state, at_rest) = line.steady_state(pressure, 0.0);
        let sent = vec![Vec::new(); at_rest.len()];
        Run { line, chamber, step, time: 0.0, state, pressure, sent, at_rest }
    }

    /// Waves on arrival at a time: linear between the values sent at the steps.
    fn arriving(&self, time: f64) -> Vec<f64> {
        let of = |(index, delay): (usize, f64)| {
            let place = (time - delay) / self.step;
            if place < 0.0 {
                return self.at_rest[index];
            }
            let history = &self.sent[index];
            let (before, part) = (place.floor() as usize, place - place.floor());
            let after = history.get(before + 1).copied().unwrap_or(history[before]);
            history[before] + part * (after - history[before])
        };
        self.line.delays().into_iter().enumerate().map(of).collect()
    }

    fn record(&mut self) {
        let mut waves = vec![0.0; self.sent.len()];
        self.line.outgoing(self.pressure, &self.state, &self.arriving(self.time), &mut waves);
        for (history, wave) in self.sent.iter_mut().zip(waves) {
            history.push(wave);
        }
    }

    /// Advances by one step of the classical Runge-Kutta method; returns the energy in J that valve
    /// and chamber put into the line.
    fn advance(&mut self, inflow: f64, outflow: f64) -> f64 {
        self.record();
        let states = self.state.len();
        let total = self.chamber + self.line.chamber_compliance();
        let rates = |values: &[f64], time: f64| {
            let mut rates = vec![0.0; states + 2];
            let arriving = self.arriving(time);
            let pressure = values[states];
            let flow = self.line.rates(inflow, pressure, &values[..states], &arriving, &mut rates[..states]);
            rates[states] = (flow - outflow) / total;
            // power at the valve port, and power taken by the chamber with its outflow
            let port = self.line.port_pressure(&values[..states], pressure);
            rates[states + 1] = port * inflow - pressure * (outflow + self.chamber * rates[states]);
            rates
        };
        let start: Vec<f64> = self.state.iter().copied().chain([self.pressure, 0.0]).collect();
        let moved = |by: &[f64], step: f64| -> Vec<f64> {
            start.iter().zip(by).map(|(value, rate)| value + step * rate).collect()
        };
        let one = rates(&start, self.time);
        let two = rates(&moved(&one, self.step / 2.0), self.time + self.step / 2.0);
        let three = rates(&moved(&two, self.step / 2.0), self.time + self.step / 2.0);
        let four = rates(&moved(&three, self.step), self.time + self.step);
        let mean: Vec<f64> =
            (0..states + 2).map(|i| (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]) / 6.0).collect();
        let end = moved(&mean, self.step);
        self.time += self.step;
        self.state = end[..states].to_vec();
        self.pressure = end[states];
        end[states + 1]
    }

    fn port(&self) -> f64 {
        self.line.port_pressure(&self.state, self.pressure)
    }
}

fn two_waves() -> TwoWaveHose {
    TwoWaveHose::assumed(&hose(), 1.5, &fluid(), 35e5, StiffeningMember::Nominal)
}

fn models() -> Vec<DynamicLine> {
    let conduit = conduit();
    let wall = StandardLinearSolid::of_hose(&hose(), StiffeningMember::Nominal, 0.01);
    let creeping = Segments::new(&conduit, 3, LaminarFriction::FrequencyDependent).unwrap();
    vec![
        DynamicLine::Segments(creeping.with_creep(&conduit, &wall).unwrap()),
        DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&conduit, END_SHARE).unwrap()),
        DynamicLine::TwoWave(two_waves().in_time(END_SHARE).unwrap()),
    ]
}

/// Joukowsky: the onset of a flow raises the pressure by Z_c q; after T it arrives at the shut end,
/// doubled.
#[test]
fn a_step_of_flow_follows_joukowsky() {
    let smooth = Conduit { kinematic_viscosity: 1e-12, ..conduit() };
    let end_fraction = 2e-3;
    let line = DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&smooth, end_fraction).unwrap());
    let rise = smooth.characteristic_impedance() * 1e-4;
    let delay = smooth.delay();
    let mut run = Run::new(line, 1e-18, 2e-6, 0.0);
    while run.time < 2.5 * delay {
        let time = run.time;
        run.advance(1e-4, 0.0);
        let (early, late) = (1.0 - 6.0 * end_fraction, 1.0 + 6.0 * end_fraction);
        if time > 0.05 * delay && time < 2.0 * early * delay {
            assert!((run.port() / rise - 1.0).abs() < 0.01, "{} at {time} s", run.port() / rise);
        }
        if time < early * delay {
            assert!(run.pressure.abs() < 0.01 * rise, "{} at {time} s", run.pressure / rise);
        } else if time > late * delay {
            assert!((run.pressure / rise - 2.0).abs() < 0.03, "{} at {time} s", run.pressure / rise);
        }
    }
}

/// A small generator of numbers between -1 and 1 (Park and Miller 1988).
pub(crate) fn next(seed: &mut u64) -> f64 {
    *seed = *seed * 48271 % 2_147_483_647;
    *seed as f64 / 1_073_741_823.5 - 1.0
}

/// Lines driven from rest without pressure never supply more energy than they received.
#[test]
fn random_flows_get_no_energy_out() {
    for (index, line) in models().into_iter().enumerate() {
        let mut seed = 4711 + index as u64;
        let mut run = Run::new(line, 1e-13, 1e-5, 0.0);
        let (mut energy, mut turnover) = (0.0, 0.0);
        let (mut inflow, mut outflow) = (0.0, 0.0);
        for step in 0..8000 {
            if step % 40 == 0 {
                let fast = next(&mut seed);
                inflow = 1e-4 * fast;
            }
            if step % 170 == 0 {
                outflow = 1e-4 * next(&mut seed);
            }
            let put_in: f64 = run.advance(inflow, outflow);
            energy += put_in;
            turnover += put_in.abs();
            assert!(energy > -1e-6 * turnover, "{index}: {energy} J of {turnover} J at {} s", run.time);
        }
        assert!(energy < 0.98 * turnover && turnover > 0.1, "{index}: {energy} J of {turnover} J");
    }
}

/// Inflow less outflow is stored: after settling, volume over compliance is the pressure.
#[test]
fn volume_is_conserved() {
    for line in models() {
        let chamber = 1e-13;
        let creeping = matches!(line, DynamicLine::Segments(_));
        let conduit = conduit();
        let wall = StandardLinearSolid::of_hose(&hose(), StiffeningMember::Nominal, 0.01);
        let volume = conduit.area() * conduit.length;
        let crept = if creeping { volume * wall.retarded_compliance() } else { 0.0 };
        let mut run = Run::new(line, chamber, 1e-5, 10e5);
        let (mut given, mut mean) = (0.0, 0.0);
        for step in 0..30_000 {
            let part = (f64::from(step) / 3000.0).min(1.0);
            let inflow = 6e-4 * part * (1.0 - part);
            given += inflow * run.step;
            run.advance(inflow, 0.0);
            // the remaining oscillation cancels in the mean of both ends over a third of the run
            mean += if step < 20_000 { 0.0 } else { (run.pressure + run.port()) / 20_000.0 };
        }
        let expected = 10e5 + given / (conduit.compliance() + crept + chamber);
        assert!((mean / expected - 1.0).abs() < 2e-5, "{mean} against {expected}: {:?}", run.line);
    }
}
