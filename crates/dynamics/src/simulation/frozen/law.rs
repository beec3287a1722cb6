//! Loop from sample to sample.

use nalgebra::{DMatrix, DVector};

use super::{Frozen, FrozenMode};
use crate::controller::{ControllerInput, ControllerState, SampledController};
use crate::linear::working_eigenvalues;
use crate::portable;
use crate::simulation::propagator::first_function;

/// Sampled controller, linearised at a sample: memory z, command u, signals m of the plant.
///
/// ```text
/// z_(k+1) = F z_k + G m_k,     u_k = H z_k + J m_k,     u_k acts from k T + d on
/// ```
#[derive(Clone, Debug)]
pub struct SampledLaw {
    sample_time_s: f64,
    delay_s: f64,
    /// Matrix F.
    memory: DMatrix<f64>,
    /// Matrix G: a column for each signal.
    taken: DMatrix<f64>,
    /// Row H.
    command: DVector<f64>,
    /// Row J.
    direct: DVector<f64>,
    /// Rows of the signals over the states of the plant.
    signals: Vec<DVector<f64>>,
}

/// Displacement of a memory or a signal, relative to its magnitude or to one.
const DISPLACED: f64 = 1e-5;

impl SampledLaw {
    /// Controller whose command acts after a delay in s, before a sample at which it reads the
    /// filtered reference, the measurement and the inner signal. Its limit is omitted: a limit
    /// stops growth but does not make a loop stable.
    pub fn new(
        controller: &SampledController,
        delay_s: f64,
        memory: &ControllerState,
        read: [f64; 3],
    ) -> SampledLaw {
        let controller = &controller.unlimited();
        let memories = memory.memories();
        let count = memories.len();
        let mut law = SampledLaw {
            sample_time_s: controller.sample_time_s(),
            delay_s,
            memory: DMatrix::zeros(count, count),
            taken: DMatrix::zeros(count, read.len()),
            command: DVector::zeros(count),
            direct: DVector::zeros(read.len()),
            signals: Vec::new(),
        };
        let mut all = [memories.as_slice(), &read].concat();
        for place in 0..all.len() {
            let at = all[place];
            let by = DISPLACED * at.abs().max(1.0);
            let ends = [by, -by].map(|by| {
                all[place] = at + by;
                let (memories, read) = all.split_at(count);
                let mut moved = controller.resumed(memories).unwrap_or_else(|| controller.at_rest());
                let read =
                    ControllerInput { reference: read[0], measurement: read[1], inner: read[2], added: 0.0 };
                let command = controller.step_with(&mut moved, &read).command;
                (DVector::from_vec(moved.memories()), command)
            });
            all[place] = at;
            let [(one, command), (other, opposite)] = &ends;
            let next = (one - other) / (2.0 * by);
            let command = (command - opposite) / (2.0 * by);
            match place.checked_sub(count) {
                None => {
                    law.memory.set_column(place, &next);
                    law.command[place] = command;
                }
                Some(signal) => {
                    law.taken.set_column(signal, &next);
                    law.direct[signal] = command;
                }
            }
        }
        law
    }

    /// Law that reads these rows over the states of the plant, as [`Frozen::row`] returns them:
    /// filtered reference, measurement and inner signal.
    #[must_use]
    pub fn reading(mut self, rows: [Vec<f64>; 3]) -> SampledLaw {
        self.signals = rows.map(DVector::from_vec).to_vec();
        self
    }

    /// Law with a signal of the plant fed forward to the command, times a gain.
    #[must_use]
    pub fn fed(mut self, gain: f64, row: Vec<f64>) -> SampledLaw {
        let signals = self.signals.len();
        self.signals.push(DVector::from_vec(row));
        self.taken = self.taken.insert_column(signals, 0.0);
        self.direct = self.direct.push(gain);
        self
    }
}

/// Fraction of a sample by which a delay may differ from a whole number of samples and still count
/// as one.
const SAME: f64 = 1e-9;
/// Growth per sample below which it is the error of an eigenvalue of one.
const LEAST_GROWTH: f64 = 1e-6;

/// Plant over a time under a constant command: x + D x + g u.
struct HeldPlant {
    difference: DMatrix<f64>,
    driven: DVector<f64>,
}

impl HeldPlant {
    fn over(&self, x: &DVector<f64>, command: f64) -> DVector<f64> {
        x + &self.difference * x + &self.driven * command
    }
}

impl Frozen {
    /// Plant over a time, its first input held.
    ///
    /// ```text
    /// x(t + h) = x + h phi_1(h A) (A x + b u)
    /// ```
    fn held(&self, time_s: f64) -> HeldPlant {
        let first = first_function(&(&self.a * time_s)) * time_s;
        HeldPlant { difference: &first * &self.a, driven: &first * self.b.column(0) }
    }

    /// Least stable mode from sample to sample of this plant, whose first input is the command of a
    /// sampled controller; `None` if there is none.
    ///
    /// # Example
    /// An integrator under a proportional law of gain k, every 0.1 s with a delay of one sample:
    /// z^2 - z + k T = 0.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_dynamics::scalar::Scalar;
    /// use phea_dynamics::simulation::{Frozen, SampledLaw, System};
    /// struct Tank;
    /// impl System<f64> for Tank {
    ///     fn states(&self) -> usize {
    ///         1
    ///     }
    ///     fn inputs(&self) -> usize {
    ///         1
    ///     }
    ///     fn scales(&self) -> Vec<f64> {
    ///         vec![3.0]
    ///     }
    ///     fn rates<T: Scalar + From<f64>>(&self, _: &[T], inputs: &[T], rates: &mut [T]) {
    ///         rates[0] = inputs[0];
    ///     }
    /// }
    /// let feedback = Compensator::new(vec![Element::Gain(20.0)]);
    /// let controller = Controller { feedback, ..Controller::default() }.sampled(0.1)?;
    /// let frozen = Frozen::at(&Tank, &[0.0], &[0.0]);
    /// let rows = [vec![0.0], frozen.row(&[0.0], &[0.0], |state, _| state[0]), vec![0.0]];
    /// let law = SampledLaw::new(&controller, 0.1, &controller.at_rest(), [0.0; 3]).reading(rows);
    /// let growth = frozen.least_stable_sampled(&law).unwrap().growth_per_s;
    /// assert!((growth - 0.5 * 2.0_f64.ln() / 0.1).abs() < 1e-4);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn least_stable_sampled(&self, law: &SampledLaw) -> Option<FrozenMode> {
        let (plant, memories) = (self.a.nrows(), law.memory.nrows());
        let whole = (law.delay_s / law.sample_time_s + SAME).floor();
        let late_s = (law.delay_s - whole * law.sample_time_s).max(0.0);
        let is_late = late_s > SAME * law.sample_time_s;
        let whole = whole as usize;
        let pending = whole + usize::from(is_late);
        let before = is_late.then(|| self.held(late_s));
        let after = self.held(law.sample_time_s - if is_late { late_s } else { 0.0 });
        let order = plant + memories + pending;
        let mut map = DMatrix::zeros(order, order);
        for place in 0..order {
            let mut unit = DVector::zeros(order);
            unit[place] = 1.0;
            let (x, z) = (unit.rows(0, plant).into_owned(), unit.rows(plant, memories).into_owned());
            let waiting = unit.rows(plant + memories, pending).into_owned();
            let signals =
                DVector::from_iterator(law.signals.len(), law.signals.iter().map(|row| row.dot(&x)));
            let command = law.command.dot(&z) + law.direct.dot(&signals);
            let of = |ago: usize| ago.checked_sub(1).map_or(command, |place| waiting[place]);
            let first = before.as_ref().map_or_else(|| x.clone(), |held| held.over(&x, of(whole + 1)));
            let next = after.over(&first, of(whole));
            let memory = &law.memory * z + &law.taken * signals;
            map.view_mut((0, place), (plant, 1)).copy_from(&next);
            map.view_mut((plant, place), (memories, 1)).copy_from(&memory);
            for one in 0..pending {
                map[(plant + memories + one, place)] = of(one);
            }
        }
        let values = working_eigenvalues(map)?;
        let least = values.into_iter().map(|value| (portable::magnitude(value), value));
        let (magnitude, value) = least.max_by(|(one, _), (other, _)| one.total_cmp(other))?;
        let grown = portable::ln(magnitude);
        let grown = if grown.abs() > LEAST_GROWTH { grown } else { 0.0 };
        let frequency_rad_per_s = portable::argument(value).abs() / law.sample_time_s;
        Some(FrozenMode { growth_per_s: grown / law.sample_time_s, frequency_rad_per_s })
    }
}
