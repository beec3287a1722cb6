//! Signals of a valve in the recorded tests, and their residuals.

use phea_hydraulics::servovalve::{StaticCoefficients, TestOutput};

use super::{Identification, SignalFit};

impl Identification {
    /// Outputs of a valve with these coefficients in a recorded test, row by row.
    pub fn outputs_of(&self, recording: usize, coefficients: &StaticCoefficients) -> Vec<TestOutput> {
        let of = |one: &super::Recording| self.tested.outputs(coefficients, one.circuit, &one.inputs);
        self.recordings.get(recording).map(of).unwrap_or_default()
    }

    /// Output of such a valve minus the recorded signal, SI; `None` if nothing was recorded.
    pub fn residuals(&self, signal: &SignalFit, coefficients: &StaticCoefficients) -> Vec<Option<f64>> {
        let recorded = self.recordings.get(signal.recording).and_then(|one| one.signal(signal.kind));
        let Some(recorded) = recorded else { return Vec::new() };
        let shown = self.outputs_of(signal.recording, coefficients);
        let one = |(output, value): (&TestOutput, &Option<f64>)| Some(signal.kind.shown(output) - (*value)?);
        shown.iter().zip(&recorded.values).map(one).collect()
    }

    /// Root mean square of these residuals.
    pub fn residual_rms_of(&self, signal: &SignalFit, coefficients: &StaticCoefficients) -> f64 {
        let residuals: Vec<f64> = self.residuals(signal, coefficients).into_iter().flatten().collect();
        let squares: f64 = residuals.iter().map(|residual| residual * residual).sum();
        (squares / residuals.len().max(1) as f64).sqrt()
    }
}
