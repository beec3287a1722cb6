//! Pressure and flow within a line with waves.
//!
//! ```text
//! p(x, t) = sum over i of (F_i + B_i)/2 + R_0/2 ((1 - x) Y_0 + x Y_1)
//! q(x, t) = (F - B)/(2 Z (1 + l))                                        of a line with one wave
//! F_i(x, t) = (1 - x) h_i + x s_i,    h_i, s_i at t - x T_i              B_i likewise from the other end
//! ```
//!
//! h_i leaves an end and s_i is sent off there, smeared by the friction of the whole length; x
//! ranges from 0 at the valve to 1; Y are the flows into the line on which its resistance acts. At
//! rest, in steady flow and at both ends this equals the line itself. In between, the smearing of a
//! wave by the distance travelled is correct to first order in friction, and too small beyond that:
//! a fall of pressure is rather too deep than too flat.
//!
//! The least and the greatest values are searched over the whole length by bisection: a part of it
//! is evaluated as long as the bounds of its waves extend beyond the known values. In time the
//! search is exact: between two of its joints a wave is a polynomial of degree four.

use phea_dynamics::order::sort_by_number;
use phea_dynamics::simulation::{Quartic, Stretch, WaveHistory};

use crate::simulate::ControlledMachine;
use crate::simulate::sum::SignalSum;

/// Number of parts of a line, a power of two, between which values are found.
const PARTS: u32 = 64;
/// Parts of a time through whose values a polynomial of degree four is fitted.
const QUARTERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Distance of joints below which they are merged, as a fraction of a step.
const SHORTEST: f64 = 1e-9;

/// A line with waves.
pub(super) struct WaveLine {
    /// Index of its first wave in the machine.
    first: usize,
    /// Travel times T_i, s.
    travel_s: Vec<f64>,
    /// Impedance Z (1 + l) of a line with one wave, Pa s/m3.
    impedance: Option<f64>,
    /// Half the resistance, R_0/2, Pa s/m3.
    half_resistance: f64,
    /// Flows into the line at valve and chamber, m3/s.
    flows: [SignalSum<'static>; 2],
    /// Sum a X of each wave that is sent, and 1 - sum a.
    late: Vec<(SignalSum<'static>, f64)>,
    /// History h of each wave that is sent, from its first step on.
    leaving: Vec<WaveHistory>,
}

/// A place within a line from one time to another.
pub(super) struct WithinLine {
    /// Fraction of the length from the valve.
    pub(super) part: f64,
    /// Times, s.
    pub(super) times_s: [f64; 2],
    /// Pressure, Pa.
    pub(super) pressure: Quartic,
    /// Flow towards the chamber, for a line with one wave, m3/s.
    pub(super) flow: Option<Quartic>,
}

/// Bounds of pressure and flow.
pub(super) struct WithinBounds {
    /// Bounds of the pressure, Pa.
    pub(super) pressure: [f64; 2],
    /// Bounds of the flow, for a line with one wave, m3/s.
    pub(super) flow: Option<[f64; 2]>,
}

/// Receiver of the values within a line.
pub(super) trait WithinSearch {
    /// True if a value within these bounds is required.
    fn wants(&self, bounds: &WithinBounds) -> bool;

    /// Takes a place.
    fn take(&mut self, found: &WithinLine);
}

/// A step of a line.
struct WavesOfStep<'a> {
    line: &'a WaveLine,
    stretch: &'a Stretch<'a>,
    /// Flows into the line at valve and chamber.
    flows: [Quartic; 2],
    /// Bounds of the pressure loss of the resistance.
    lost: [f64; 2],
}

impl WaveLine {
    /// Line of a side, from these observed states; its flows at valve and chamber are its states
    /// with these indices.
    pub(super) fn of(
        bench: &ControlledMachine,
        side: usize,
        wanted: &[usize],
        [at_valve, at_chamber]: [usize; 2],
    ) -> Option<WaveLine> {
        let lines = bench.machine.lines();
        let first = lines.iter().take(side).map(|line| line.delays().len()).sum();
        let line = lines.get(side)?;
        let (impedances, half_resistance) = line.of_waves()?;
        let travel_s = line.delays().get(..impedances.len())?.to_vec();
        let impedance = if let [impedance] = impedances[..] { Some(impedance) } else { None };
        let (_, places) = super::places(bench, side);
        let sum = |terms: Vec<(usize, f64)>| {
            let place = |(number, weight): (usize, f64)| Some((*places.get(number)?, weight));
            let terms: Option<Vec<(usize, f64)>> = terms.into_iter().map(place).collect();
            let terms = terms?;
            let weighted = move |state: &[f64], _: &[f64]| {
                terms.iter().map(|(place, weight)| weight * state[*place]).sum()
            };
            Some(SignalSum::of(wanted, bench.control.size(), weighted))
        };
        let late = line.smearing().into_iter().map(|own| {
            let kept = 1.0 - own.iter().map(|(_, weight)| weight).sum::<f64>();
            Some((sum(own)?, kept))
        });
        let late: Option<Vec<_>> = late.collect();
        let (late, leaving) = (late?, Vec::new());
        let flows = [sum(vec![(at_valve, 1.0)])?, sum(vec![(at_chamber, 1.0)])?];
        Some(WaveLine { first, travel_s, impedance, half_resistance, flows, late, leaving })
    }

    /// Searches the places between both ends over a step.
    pub(super) fn search(&mut self, stretch: &Stretch<'_>, search: &mut impl WithinSearch) {
        self.send(stretch);
        let flows = self.flows.each_ref().map(|flow| flow.over(stretch.states));
        let [one, other] = flows.each_ref().map(|flow| flow.bounds().map(|flow| self.half_resistance * flow));
        let lost = [one[0].min(other[0]), one[1].max(other[1])];
        WavesOfStep { line: self, stretch, flows, lost }.halve([0, PARTS], search);
    }

    /// Adds the waves that leave both ends over a step.
    fn send(&mut self, stretch: &Stretch<'_>) {
        let [start_s, end_s] = [stretch.start_s(), stretch.end_s()];
        let sent = (self.first..).map_while(|number| stretch.wave(number));
        if self.leaving.is_empty() {
            // at rest, the departing wave equals the sent one
            let before = |sent: &WaveHistory| sent.arriving(start_s, start_s - 1.0)[0];
            let count = self.late.len();
            self.leaving =
                sent.clone().take(count).map(|sent| WaveHistory::new(sent.delay_s(), before(sent))).collect();
        }
        for ((leaving, sent), (late, kept)) in self.leaving.iter_mut().zip(sent).zip(&self.late) {
            let late = late.over(stretch.states);
            let beside_s = 0.5 * (start_s + end_s) + sent.delay_s();
            let values = QUARTERS.map(|part| {
                let arrives_s = start_s + part * (end_s - start_s) + sent.delay_s();
                (sent.arriving(arrives_s, beside_s)[0] - late.at(part)) / kept
            });
            leaving.send(start_s, end_s - start_s, values);
        }
    }

    /// Indices of a wave among those of the line, on its path to the chamber and back.
    fn waves(&self, wave: usize) -> [usize; 2] {
        [wave, self.travel_s.len() + wave]
    }
}

impl WavesOfStep<'_> {
    fn times_s(&self) -> [f64; 2] {
        [self.stretch.start_s(), self.stretch.end_s()]
    }

    /// A wave of the line as it is sent and as it leaves.
    fn wave(&self, number: usize) -> Option<[&WaveHistory; 2]> {
        Some([self.stretch.wave(self.line.first + number)?, self.line.leaving.get(number)?])
    }

    /// Searches between two places, in fractions of the length.
    fn halve(&self, [from, until]: [u32; 2], search: &mut impl WithinSearch) {
        let parts = [from, until].map(|place| f64::from(place) / f64::from(PARTS));
        if until - from < 2 || !search.wants(&self.bounds(parts)) {
            return;
        }
        let middle = from + (until - from) / 2;
        self.at(f64::from(middle) / f64::from(PARTS), search);
        self.halve([from, middle], search);
        self.halve([middle, until], search);
    }

    /// Bounds of pressure and flow between two fractions of the length.
    fn bounds(&self, [near, far]: [f64; 2]) -> WithinBounds {
        let line = self.line;
        let (mut sum, mut difference) = (self.lost, [0.0; 2]);
        for (wave, travel_s) in line.travel_s.iter().enumerate() {
            let [forward, back] = line.waves(wave);
            let of = |number: usize, ahead: [f64; 2]| {
                let [start_s, end_s] = self.times_s();
                let times_s = [start_s + ahead[0] * travel_s, end_s + ahead[1] * travel_s];
                let bounds = self.wave(number).map(|both| both.map(|wave| wave.bounds(times_s)));
                bounds.map_or([f64::NAN; 2], |[one, other]| [one[0].min(other[0]), one[1].max(other[1])])
            };
            let (forward, back) = (of(forward, [1.0 - far, 1.0 - near]), of(back, [near, far]));
            for end in [0, 1] {
                sum[end] += 0.5 * (forward[end] + back[end]);
                difference[end] += 0.5 * (forward[end] - back[1 - end]);
            }
        }
        let flow = line.impedance.map(|own| difference.map(|difference| difference / own));
        WithinBounds { pressure: sum, flow }
    }

    /// Pressure and flow at a fraction of the length, from joint to joint of the waves.
    fn at(&self, part: f64, search: &mut impl WithinSearch) {
        let [start_s, end_s] = self.times_s();
        for pair in self.joints(part).windows(2) {
            let &[from_s, until_s] = pair else { continue };
            if until_s - from_s <= SHORTEST * (end_s - start_s) {
                continue;
            }
            let mut values = [[0.0; QUARTERS.len()]; 2];
            for (place, quarter) in QUARTERS.into_iter().enumerate() {
                let time_s = from_s + quarter * (until_s - from_s);
                let [sum, difference] = self.travelling(part, [time_s, 0.5 * (from_s + until_s)]);
                let fraction = (time_s - start_s) / (end_s - start_s);
                let [at_valve, at_chamber] = self.flows.each_ref().map(|flow| flow.at(fraction));
                let lost = self.line.half_resistance * ((1.0 - part) * at_valve + part * at_chamber);
                (values[0][place], values[1][place]) = (sum + lost, difference);
            }
            let [pressure, difference] = values.map(Quartic::through);
            let flow = self.line.impedance.map(|own| Quartic::constant(0.0).plus(1.0 / own, &difference));
            search.take(&WithinLine { part, times_s: [from_s, until_s], pressure, flow });
        }
    }

    /// Ends of the step, and times of the joints of waves at a fraction of the length.
    fn joints(&self, part: f64) -> Vec<f64> {
        let times_s = self.times_s();
        let mut joints = times_s.to_vec();
        for (wave, travel_s) in self.line.travel_s.iter().enumerate() {
            for (number, ahead) in self.line.waves(wave).into_iter().zip([1.0 - part, part]) {
                let ahead_s = ahead * travel_s;
                let Some([sent, _]) = self.wave(number) else { continue };
                let at = sent.joints(times_s.map(|time_s| time_s + ahead_s));
                joints.extend(at.map(|joint_s| joint_s - ahead_s));
            }
        }
        sort_by_number(&mut joints, |joint_s| *joint_s);
        joints
    }

    /// Half the sum of the waves at a fraction of the length, and half their difference, Pa: at a
    /// time, and at a jump on the side of another time.
    fn travelling(&self, part: f64, [time_s, beside_s]: [f64; 2]) -> [f64; 2] {
        let mut found = [0.0; 2];
        for (wave, travel_s) in self.line.travel_s.iter().enumerate() {
            let [forward, back] = self.line.waves(wave);
            let smeared = |number: usize, way: f64| {
                let ahead_s = (1.0 - way) * travel_s;
                let arriving = |wave: &WaveHistory| wave.arriving(time_s + ahead_s, beside_s + ahead_s)[0];
                self.wave(number).map_or(f64::NAN, |[sent, leaving]| {
                    way * arriving(sent) + (1.0 - way) * arriving(leaving)
                })
            };
            let (forward, back) = (smeared(forward, part), smeared(back, 1.0 - part));
            found[0] += 0.5 * (forward + back);
            found[1] += 0.5 * (forward - back);
        }
        found
    }
}
