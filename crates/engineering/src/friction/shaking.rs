//! Rows in which a force of several frequencies shakes the piston on its bristles.

mod sines;

use phea_hydraulics::friction::{MultisineForce, TRENDS};

use super::FrictionRecording;
use sines::{fitted, sines, white_noise};

/// Rows of a recording whose force is a sum of sines.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakenRows {
    /// Index of the recording.
    pub recording: usize,
    /// Initial estimate of the force.
    pub force: MultisineForce,
    /// Cosine and sine coefficients of the position for each frequency, m.
    responses: Vec<[f64; 2]>,
    /// Noise of force, N, and position, m.
    pub(super) noise: [f64; 2],
}

/// Fewest rows with sufficient information.
const FEWEST_ROWS: usize = 100;

/// Shaken rows of the recording; `None` if its force is not a sum of sines.
pub(super) fn shaken_rows(recording: &FrictionRecording, index: usize) -> Option<ShakenRows> {
    let rows = recording.forces.len();
    if rows < FEWEST_ROWS {
        return None;
    }
    let signals = [&recording.forces, &recording.positions];
    let noise = signals.map(|values| white_noise(values));
    let in_noise = |index: usize| signals[index].iter().map(|value| value / noise[index]).collect();
    let angles = sines([&in_noise(0), &in_noise(1)])?;
    let frequencies = angles.iter().map(|angle| angle / recording.time_step).collect();
    let sizes = fitted(&recording.forces, &angles)?;
    let position = fitted(&recording.positions, &angles)?;
    let responses = position.get(TRENDS..)?.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let duration = (rows as f64 - 1.0) * recording.time_step;
    let force = MultisineForce { rows, frequencies, duration, sizes };
    Some(ShakenRows { recording: index, force, responses, noise })
}

impl ShakenRows {
    /// Velocity, m/s, and displacement from the mean, m, at the first row, without noise.
    pub(super) fn beginning(&self) -> [f64; 2] {
        let all = self.force.frequencies.iter().zip(&self.responses);
        all.fold([0.0; 2], |[v, x], (omega, [cosine, sine])| [v + omega * sine, x + cosine])
    }

    /// Root mean square of the position, without its mean, drift and noise, m.
    pub(super) fn swing(&self) -> f64 {
        self.responses.iter().map(|[cosine, sine]| (cosine * cosine + sine * sine) / 2.0).sum::<f64>().sqrt()
    }

    /// Stiffness, N/m, and damping, N s/m, of a spring and a damper with this response.
    ///
    /// ```text
    /// F_k = (sigma_0 - M omega_k^2 + j omega_k c) X_k        least squares over all k
    /// ```
    pub(super) fn spring_and_damper(&self, mass: f64) -> [f64; 2] {
        let forces = self.force.sizes.get(TRENDS..).unwrap_or_default().chunks_exact(2);
        let all = self.force.frequencies.iter().zip(forces.zip(&self.responses));
        let (mut stiffness, mut damping) = ([0.0; 2], [0.0; 2]);
        for (omega, (force, [cosine, sine])) in all {
            // a cos + b sin is the real part of (a - j b) e^(j omega t)
            let [a, b] = [force[0], force[1]];
            let square = cosine * cosine + sine * sine;
            stiffness[0] += a * cosine + b * sine + mass * omega * omega * square;
            stiffness[1] += square;
            damping[0] += omega * (a * sine - b * cosine);
            damping[1] += omega * omega * square;
        }
        [stiffness, damping].map(|[product, square]| if square > 0.0 { product / square } else { 0.0 })
    }
}
