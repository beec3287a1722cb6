mod response;

use phea_dynamics::scalar::Scalar;

use super::LineError;
use super::attenuation::{CORNERS, GREATEST_DISSIPATION, TERMS, attenuation_weights};

/// Line along which M waves travel in each direction, smeared by friction, between two small end
/// volumes.
///
/// ```text
/// at each end, with pressure p, flow q into the line, and arriving waves c_i:
///     p = R_0/2 Q + sum over i of [c_i + Z_i (q + sum_k (a_ik/b_k) Y_ik)]          thesis (4.36), (4.37)
///     h_i = c_i + 2 Z_i (q + sum_k (a_ik/b_k) Y_ik)              leaving wave; thesis (4.39) to (4.42)
///     sent off: (1 - sum_k a_ik) h_i + sum_k a_ik X_ik            arrives at the other end T_i later; thesis (4.43)
///     dY_ik/dt = (b_k/T_i)(q - Y_ik),    dX_ik/dt = (b_k/T_i)(h_i - X_ik),    Q = Y_11         thesis (4.44)
/// ```
///
/// With A_i(s) the attenuation of wave i from the weights a_ik and corners b_k/T_i, this is
///
/// ```text
/// Z_i(s) = Z_i [1 + (1 - A_i)/(s T_i)],    c_i = e^(-s T_i) A_i(s) [c_i + 2 Z_i(s) q of the other end]
/// ```
///
/// the exact line where A_i = exp(sT_i - Gamma_i) and Z_i(s) = Z_i Gamma_i/(s T_i), of which the
/// bracket is the first term of the logarithm: one set of weights gives attenuation and impedance.
/// At rest it has the whole compliance of the line and its steady resistance. It is passive when
/// R_0/2 is at least sum Z_i l_i^2/(1 + l_i), l_i = sum_k a_ik/b_k, and wave 1 has the shortest
/// delay; a single wave always is. Structure after the transmission line method (Krus, Weddfelt and
/// Palmberg 1994; Johnston 2012); weights and impedance are original.
///
/// States: the pressure of the valve's end volume, then for the valve end and the chamber end, for
/// each wave, Y and X. Waves, sent or arriving: for each i the wave from the valve end to the
/// chamber end, then the opposite one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TravellingWaves<const M: usize, S = f64> {
    waves: [Wave<S>; M],
    end_compliance: S,
    half_resistance: S,
}

/// Single wave in each direction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave<S> {
    impedance: S,
    delay: S,
    weights: [S; TERMS],
}

/// Wave with friction: impedance in Pa s/m3, delay in s, dissipation number.
pub(super) struct WaveData {
    pub(super) impedance: f64,
    pub(super) delay: f64,
    pub(super) dissipation: f64,
}

/// Number of states of one wave at one end.
const FILTERS: usize = 2 * TERMS;

impl<const M: usize> TravellingWaves<M> {
    pub(super) fn new(waves: [WaveData; M], end_compliance: f64, resistance: f64) -> Result<Self, LineError> {
        let greatest = waves.iter().map(|wave| wave.dissipation).fold(0.0, f64::max);
        let overdamped = LineError::Overdamped { dissipation: greatest, limit: GREATEST_DISSIPATION };
        let mut attenuated = [Wave { impedance: 0.0, delay: 0.0, weights: [0.0; TERMS] }; M];
        for (wave, data) in attenuated.iter_mut().zip(waves) {
            let Some(weights) = attenuation_weights(data.dissipation) else {
                return Err(overdamped);
            };
            *wave = Wave { impedance: data.impedance, delay: data.delay, weights };
        }
        // In phase and at low frequency, a wave supplies energy like a resistance -Z l^2/(1 + l), l
        // = sum a_k/b_k, and never more than that over 1 + (wT)^2 (comparisons/recompute_lines.py):
        // a greater resistance with the shortest lag compensates for all waves.
        let half_resistance = resistance / 2.0;
        let needed = attenuated.iter().map(|wave| {
            let lag = wave.lagging(&[1.0; TERMS]);
            wave.impedance * lag * lag / (1.0 + lag)
        });
        let needed: f64 = needed.sum();
        if needed > half_resistance {
            return Err(LineError::MixedByFriction { needed, half_resistance });
        }
        Ok(TravellingWaves { waves: attenuated, end_compliance, half_resistance })
    }
}

phea_dynamics::parameters! { TravellingWaves<M> { waves, end_compliance, half_resistance } }
phea_dynamics::parameters! { Wave { impedance, delay, weights } }

impl<const M: usize, S: Copy> TravellingWaves<M, S> {
    /// Number of states.
    pub fn states(&self) -> usize {
        1 + 2 * M * FILTERS
    }

    /// Typical magnitude of each state for a typical pressure in Pa and flow in m3/s.
    pub fn scales(&self, pressure: f64, flow: f64) -> Vec<f64> {
        let filters = [[flow; TERMS], [pressure; TERMS]].concat();
        [vec![pressure], filters.repeat(2 * M)].concat()
    }

    /// Travel time of each wave, s.
    pub fn delays(&self) -> Vec<S> {
        self.waves.iter().chain(&self.waves).map(|wave| wave.delay).collect()
    }

    /// Contribution of the line to the compliance of the chamber: its end volume there, m3/Pa.
    pub fn chamber_compliance(&self) -> S {
        self.end_compliance
    }

    /// Pressure at the valve port, Pa.
    #[inline]
    pub fn port_pressure<T: Copy>(&self, state: &[T]) -> T {
        state[0]
    }
}

impl<const M: usize, S: Scalar> TravellingWaves<M, S> {
    /// Ratio Z_i (1 + l_i) of pressure to flow of a slow wave in one direction, for each wave, Pa
    /// s/m3.
    pub fn slow_impedances(&self) -> [S; M] {
        self.waves.each_ref().map(|wave| wave.impedance * wave.slow([S::from(1.0); TERMS]))
    }

    /// Half resistance R_0/2, Pa s/m3.
    pub fn half_resistance(&self) -> S {
        self.half_resistance
    }

    /// Indices of the states X_ik with their weights a_ik for each wave sent, in order.
    pub fn smearing(&self) -> Vec<Vec<(usize, S)>> {
        let first = |end: usize, wave: usize| 1 + (end * M + wave) * FILTERS + TERMS;
        let of = |end: usize, (number, wave): (usize, &Wave<S>)| {
            wave.weights.iter().enumerate().map(|(k, weight)| (first(end, number) + k, *weight)).collect()
        };
        [0, 1]
            .into_iter()
            .flat_map(|end| self.waves.iter().enumerate().map(move |wave| of(end, wave)))
            .collect()
    }

    /// State and arriving waves of a steady flow in m3/s into a chamber at this pressure in Pa.
    ///
    /// The pressure divides between the waves as between capacities in series, by T_i/Z_i.
    pub fn steady_state(&self, chamber_pressure: S, flow: S) -> (Vec<S>, Vec<S>) {
        let zero = S::from(0.0);
        let middle = chamber_pressure + self.half_resistance * flow;
        let elastance = self.waves.iter().fold(zero, |sum, wave| sum + wave.impedance / wave.delay);
        let fraction = |wave: &Wave<S>| middle * wave.impedance / wave.delay / elastance;
        let slow = |wave: &Wave<S>| wave.impedance * wave.slow([flow; TERMS]);
        let towards = |sign: S| self.waves.iter().map(move |wave| fraction(wave) + sign * slow(wave));
        let (forward, backward) = (towards(S::from(1.0)), towards(S::from(-1.0)));
        let waves: Vec<S> = forward.clone().chain(backward.clone()).collect();
        let mut state = vec![middle + self.half_resistance * flow];
        // a wave that leaves one end arrives unchanged at the other
        for (entering, leaving) in [(flow, forward.collect::<Vec<S>>()), (-flow, backward.collect())] {
            for wave in leaving {
                state.extend([entering; TERMS]);
                state.extend([wave; TERMS]);
            }
        }
        (state, waves)
    }

    /// Rates of all states; returns the flow into the chamber in m3/s.
    #[inline]
    pub fn rates<T: Scalar + From<S>>(
        &self,
        flow_from_valve: T,
        chamber_pressure: T,
        state: &[T],
        arriving: &[T],
        rates: &mut [T],
    ) -> T {
        let (towards_chamber, towards_valve) = arriving.split_at(M);
        let (port_pressure, filters) = (state[0], &state[1..]);
        let (at_valve, at_chamber) = filters.split_at(M * FILTERS);
        let (first, rest) = rates.split_at_mut(1);
        let (rates_at_valve, rates_at_chamber) = rest.split_at_mut(M * FILTERS);
        let into_line = self.end_flow(port_pressure, towards_valve, at_valve);
        let from_chamber = self.end_flow(chamber_pressure, towards_chamber, at_chamber);
        self.filter_rates(into_line, towards_valve, at_valve, rates_at_valve);
        self.filter_rates(from_chamber, towards_chamber, at_chamber, rates_at_chamber);
        first[0] = (flow_from_valve - into_line) / <T as From<S>>::from(self.end_compliance);
        -from_chamber
    }

    /// Waves sent into each delay, Pa.
    #[inline]
    pub fn outgoing<T: Scalar + From<S>>(
        &self,
        chamber_pressure: T,
        state: &[T],
        arriving: &[T],
        waves: &mut [T],
    ) {
        let (towards_chamber, towards_valve) = arriving.split_at(M);
        let (port_pressure, filters) = (state[0], &state[1..]);
        let (at_valve, at_chamber) = filters.split_at(M * FILTERS);
        let (from_valve, from_chamber) = waves.split_at_mut(M);
        self.sent(port_pressure, towards_valve, at_valve, from_valve);
        self.sent(chamber_pressure, towards_chamber, at_chamber, from_chamber);
    }

    /// Flow into the line at one end, m3/s.
    fn end_flow<T: Scalar + From<S>>(&self, pressure: T, arriving: &[T], filters: &[T]) -> T {
        let mut left = pressure - <T as From<S>>::from(self.half_resistance) * filters[0];
        let mut impedance = <T as From<f64>>::from(0.0);
        for (wave, (arriving, filters)) in self.waves.iter().zip(arriving.iter().zip(filters.chunks(FILTERS)))
        {
            let own = <T as From<S>>::from(wave.impedance);
            left = left - *arriving - own * wave.lagging(filters);
            impedance = impedance + own;
        }
        left / impedance
    }

    fn filter_rates<T: Scalar + From<S>>(&self, flow: T, arriving: &[T], filters: &[T], rates: &mut [T]) {
        let ends = arriving.iter().zip(filters.chunks(FILTERS).zip(rates.chunks_mut(FILTERS)));
        for (wave, (arriving, (filters, rates))) in self.waves.iter().zip(ends) {
            let leaving = wave.leaving(flow, *arriving, filters);
            let (flows, pressures) = filters.split_at(TERMS);
            let (flow_rates, pressure_rates) = rates.split_at_mut(TERMS);
            let per_delay = <T as From<f64>>::from(1.0) / <T as From<S>>::from(wave.delay);
            for (k, corner) in CORNERS.into_iter().enumerate() {
                let corner = <T as From<f64>>::from(corner) * per_delay;
                flow_rates[k] = corner * (flow - flows[k]);
                pressure_rates[k] = corner * (leaving - pressures[k]);
            }
        }
    }

    fn sent<T: Scalar + From<S>>(&self, pressure: T, arriving: &[T], filters: &[T], waves: &mut [T]) {
        let flow = self.end_flow(pressure, arriving, filters);
        let ends = arriving.iter().zip(filters.chunks(FILTERS).zip(waves));
        for (wave, (arriving, (filters, sent))) in self.waves.iter().zip(ends) {
            let leaving = wave.leaving(flow, *arriving, filters);
            *sent = leaving;
            for (weight, filtered) in wave.weights.iter().zip(&filters[TERMS..]) {
                *sent = *sent + <T as From<S>>::from(*weight) * (*filtered - leaving);
            }
        }
    }
}

impl<S: Scalar> Wave<S> {
    /// Wave h_i, Pa.
    fn leaving<T: Scalar + From<S>>(&self, flow: T, arriving: T, filters: &[T]) -> T {
        let impedance = <T as From<S>>::from(self.impedance);
        arriving + <T as From<f64>>::from(2.0) * impedance * (flow + self.lagging(filters))
    }

    /// Sum_k (a_k/b_k) Y_k, m3/s.
    fn lagging<T: Scalar + From<S>>(&self, filters: &[T]) -> T {
        let mut sum = <T as From<f64>>::from(0.0);
        for (weight, (corner, lagging)) in self.weights.iter().zip(CORNERS.into_iter().zip(filters)) {
            sum = sum + <T as From<S>>::from(*weight) * <T as From<f64>>::from(1.0 / corner) * *lagging;
        }
        sum
    }

    /// Sum q + sum_k (a_k/b_k) Y_k of a steady flow.
    fn slow(&self, flow: [S; TERMS]) -> S {
        flow[0] + self.lagging(&flow)
    }
}
