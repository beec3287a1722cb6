use phea_dynamics::scalar::Scalar;

use super::{LineContent, Segments, TransmissionLine, TwoWaveLine};

/// Dynamics of a line between its valve port and its chamber, as part of a machine: states, and
/// waves that are sent and arrive later.
///
/// The inputs are the flow from the valve and the chamber pressure; the outputs are the port
/// pressure and the flow into the chamber. The line adds [`DynamicLine::chamber_compliance`] to the
/// chamber. So no part of it is an algebraic loop. Units: Pa, m3/s, s.
///
/// # Example
/// A steady flow remains steady:
/// ```
/// use phea_hydraulics::line::{Conduit, DynamicLine, END_SHARE, TransmissionLine};
/// let conduit = Conduit {
///     length: 1.5, bore: 12.7e-3, density: 870.0, kinematic_viscosity: 46e-6, effective_bulk_modulus: 2.609e8,
/// };
/// let line = DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&conduit, END_SHARE)?);
/// let (state, waves) = line.steady_state(35e5, 1e-4);
/// let mut rates = vec![f64::NAN; line.states()];
/// let flow = line.rates(1e-4, 35e5, &state, &waves, &mut rates);
/// assert!((flow / 1e-4 - 1.0).abs() < 1e-9 && rates.iter().all(|rate: &f64| rate.abs() < 1e2));
/// let drop = line.port_pressure(&state, 35e5) - 35e5;
/// assert!((drop / (conduit.steady_resistance() * 1e-4) - 1.0).abs() < 1e-9);
/// let mut sent = vec![f64::NAN; line.delays().len()];
/// line.outgoing(35e5, &state, &waves, &mut sent);
/// assert!(sent.iter().zip(&waves).all(|(sent, wave)| (sent / wave - 1.0).abs() < 1e-12));
/// # Ok::<(), phea_hydraulics::line::LineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DynamicLine<S = f64> {
    /// Capacities, and inertances between them; lumped without segments.
    Segments(Segments<S>),
    /// One wave each way.
    TransmissionLine(TransmissionLine<S>),
    /// Two waves each way.
    TwoWave(TwoWaveLine<S>),
}

phea_dynamics::parameters! {
    DynamicLine = DynamicLine::Segments(line)
        | DynamicLine::TransmissionLine(line)
        | DynamicLine::TwoWave(line)
}

impl<S: Copy> DynamicLine<S> {
    /// Number of states.
    pub fn states(&self) -> usize {
        match self {
            DynamicLine::Segments(line) => line.states(),
            DynamicLine::TransmissionLine(line) => line.states(),
            DynamicLine::TwoWave(line) => line.states(),
        }
    }

    /// Typical magnitude of each state for a typical pressure in Pa and flow in m3/s.
    pub fn scales(&self, pressure: f64, flow: f64) -> Vec<f64> {
        match self {
            DynamicLine::Segments(line) => line.scales(pressure, flow),
            DynamicLine::TransmissionLine(line) => line.scales(pressure, flow),
            DynamicLine::TwoWave(line) => line.scales(pressure, flow),
        }
    }

    /// Travel time of each wave, s; one wave sent and one arriving for each.
    pub fn delays(&self) -> Vec<S> {
        match self {
            DynamicLine::Segments(_) => Vec::new(),
            DynamicLine::TransmissionLine(line) => line.delays(),
            DynamicLine::TwoWave(line) => line.delays(),
        }
    }
}

impl<S: Scalar> DynamicLine<S> {
    /// Ratio of pressure to flow of each slow wave in one direction, and half of the steady
    /// resistance, Pa s/m3; `None` without waves.
    pub fn of_waves(&self) -> Option<(Vec<S>, S)> {
        match self {
            DynamicLine::Segments(_) => None,
            DynamicLine::TransmissionLine(line) => {
                Some((line.slow_impedances().to_vec(), line.half_resistance()))
            }
            DynamicLine::TwoWave(line) => Some((line.slow_impedances().to_vec(), line.half_resistance())),
        }
    }

    /// Indices and fractions of the states X that smear each wave sent, in order; empty without
    /// waves.
    ///
    /// ```text
    /// sent = (1 - sum a) h + sum a X                             of TravellingWaves
    /// ```
    pub fn smearing(&self) -> Vec<Vec<(usize, S)>> {
        match self {
            DynamicLine::Segments(_) => Vec::new(),
            DynamicLine::TransmissionLine(line) => line.smearing(),
            DynamicLine::TwoWave(line) => line.smearing(),
        }
    }

    /// Contribution of the line to the compliance of the chamber, m3/Pa.
    pub fn chamber_compliance(&self) -> S {
        match self {
            DynamicLine::Segments(line) => line.chamber_compliance(),
            DynamicLine::TransmissionLine(line) => line.chamber_compliance(),
            DynamicLine::TwoWave(line) => line.chamber_compliance(),
        }
    }

    /// State and arriving waves of a steady flow in m3/s into a chamber at this pressure in Pa.
    pub fn steady_state(&self, chamber_pressure: S, flow: S) -> (Vec<S>, Vec<S>) {
        match self {
            DynamicLine::Segments(line) => (line.steady_state(chamber_pressure, flow), Vec::new()),
            DynamicLine::TransmissionLine(line) => line.steady_state(chamber_pressure, flow),
            DynamicLine::TwoWave(line) => line.steady_state(chamber_pressure, flow),
        }
    }

    /// Pressure at the valve port, Pa.
    #[inline]
    pub fn port_pressure<T: Scalar + From<S>>(&self, state: &[T], chamber_pressure: T) -> T {
        match self {
            DynamicLine::Segments(line) => line.port_pressure(state, chamber_pressure),
            DynamicLine::TransmissionLine(line) => line.port_pressure(state),
            DynamicLine::TwoWave(line) => line.port_pressure(state),
        }
    }

    /// Rates of all states; returns the flow into the chamber in m3/s. The slices have the lengths
    /// [`DynamicLine::states`] and [`DynamicLine::delays`].
    #[inline]
    pub fn rates<T: Scalar + From<S>>(
        &self,
        flow_from_valve: T,
        chamber_pressure: T,
        state: &[T],
        arriving: &[T],
        rates: &mut [T],
    ) -> T {
        match self {
            DynamicLine::Segments(line) => line.rates(flow_from_valve, chamber_pressure, state, rates),
            DynamicLine::TransmissionLine(line) => {
                line.rates(flow_from_valve, chamber_pressure, state, arriving, rates)
            }
            DynamicLine::TwoWave(line) => {
                line.rates(flow_from_valve, chamber_pressure, state, arriving, rates)
            }
        }
    }

    /// Content of the line; `None` with waves, since much of their content is in transit and not
    /// part of its states.
    pub(crate) fn content<T: Scalar + From<S>>(
        &self,
        chamber_pressure: T,
        state: &[T],
    ) -> Option<LineContent<T>> {
        match self {
            DynamicLine::Segments(line) => Some(line.content(chamber_pressure, state)),
            DynamicLine::TransmissionLine(_) | DynamicLine::TwoWave(_) => None,
        }
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
        match self {
            DynamicLine::Segments(_) => {}
            DynamicLine::TransmissionLine(line) => line.outgoing(chamber_pressure, state, arriving, waves),
            DynamicLine::TwoWave(line) => line.outgoing(chamber_pressure, state, arriving, waves),
        }
    }
}
