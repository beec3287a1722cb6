//! Pressure and flow within a line along which waves travel.
//!
//! ```text
//! p(x, t) = sum over i of (F_i(t + (1 - x) T_i) + B_i(t + x T_i))/2 + R_0/2 ((1 - x) Y_0 + x Y_1)
//! q(x, t) = (F(t + (1 - x) T) - B(t + x T))/(2 Z (1 + l))                of a line with one wave
//! ```
//!
//! F_i arrives at the chamber and B_i at the valve, x from 0 at the valve to 1; Y are the flows
//! into the line that its resistance acts on. Exact at rest, in steady flow, and for the waves as
//! they arrive: friction damps them on their whole way.

use phea_dynamics::simulation::{Quartic, Stretch};

use crate::simulate::ControlledMachine;
use crate::simulate::sum::SignalSum;

/// Places within a line, as parts of its length from the valve on.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
/// Parts of a step through whose values a polynomial of degree four is laid.
const QUARTERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// A line along which waves travel.
pub(super) struct WaveLine {
    /// Number of its first wave in the machine.
    first: usize,
    /// T_i, s.
    travel_s: Vec<f64>,
    /// Z (1 + l) of a line with one wave, Pa s/m3.
    impedance: Option<f64>,
    /// R_0/2, Pa s/m3.
    half_resistance: f64,
    /// Into the line at valve and chamber, m3/s.
    flows: [SignalSum<'static>; 2],
}

/// A place within a line over a step.
pub(super) struct WithinLine {
    /// Part of the length from the valve on.
    pub(super) part: f64,
    /// Pa.
    pub(super) pressure: Quartic,
    /// m3/s towards the chamber, of a line with one wave.
    pub(super) flow: Option<Quartic>,
}

impl WaveLine {
    /// The line of a side; its flows at valve and chamber are these.
    pub(super) fn of(
        bench: &ControlledMachine,
        side: usize,
        flows: [SignalSum<'static>; 2],
    ) -> Option<WaveLine> {
        let lines = bench.machine.lines();
        let first = lines.iter().take(side).map(|line| line.delays().len()).sum();
        let line = lines.get(side)?;
        let (impedances, half_resistance) = line.of_waves()?;
        let travel_s = line.delays().get(..impedances.len())?.to_vec();
        let impedance = if let [impedance] = impedances[..] { Some(impedance) } else { None };
        Some(WaveLine { first, travel_s, impedance, half_resistance, flows })
    }

    /// Both at each of the places over a step.
    pub(super) fn within(&self, stretch: &Stretch<'_>) -> [WithinLine; PLACES.len()] {
        let [at_valve, at_chamber] = self.flows.each_ref().map(|flow| flow.over(stretch.states));
        PLACES.map(|part| {
            let [pressure, difference] = self.travelling(stretch, part);
            let lost = [1.0 - part, part].map(|share| share * self.half_resistance);
            let pressure = pressure.plus(lost[0], &at_valve).plus(lost[1], &at_chamber);
            let flow = self.impedance.map(|own| Quartic::constant(0.0).plus(1.0 / own, &difference));
            WithinLine { part, pressure, flow }
        })
    }

    /// Half the sum of the waves at a part of the length, and half their difference, Pa.
    fn travelling(&self, stretch: &Stretch<'_>, part: f64) -> [Quartic; 2] {
        let [start_s, end_s] = [stretch.start_s(), stretch.end_s()];
        let count = self.travel_s.len();
        let mut values = [[0.0; QUARTERS.len()]; 2];
        for (place, quarter) in QUARTERS.into_iter().enumerate() {
            let time_s = start_s + quarter * (end_s - start_s);
            for (wave, travel_s) in self.travel_s.iter().enumerate() {
                let forward = stretch.arriving(self.first + wave, time_s + (1.0 - part) * travel_s);
                let back = stretch.arriving(self.first + count + wave, time_s + part * travel_s);
                values[0][place] += 0.5 * (forward + back);
                values[1][place] += 0.5 * (forward - back);
            }
        }
        values.map(Quartic::through)
    }
}
