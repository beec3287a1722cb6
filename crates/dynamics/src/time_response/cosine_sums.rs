use crate::portable::{cos, sin};

/// Single term of a sum of cosines.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cosine {
    pub(super) frequency_rad_per_s: f64,
    pub(super) weight: f64,
}

/// Number of terms advanced in parallel.
const LANES: usize = 8;
/// Steps after which the recurrence restarts: its rounding grows with their square.
const STEPS: usize = 32;

/// Parallel terms: the cosine and sine at the beginning of a block of steps, those of one step and
/// of a block.
struct CosineLanes {
    cosine: [f64; LANES],
    sine: [f64; LANES],
    step: [[f64; LANES]; 2],
    block: [[f64; LANES]; 2],
    /// Factor 4 sin^2(w h/2) of one step.
    bend: [f64; LANES],
}

/// Sums of c cos(w t) over the terms, at t = h, 2 h, ..., `count` h.
///
/// ```text
/// u(k + 1) = u(k) + d(k + 1),     d(k + 1) = d(k) - 4 sin^2(w h/2) u(k)           u(k) = c cos(w k h)
/// e^(j w (t + 32 h)) = e^(j w t) e^(j w 32 h)                                      begins anew
/// ```
pub(super) fn sums_of_cosines(terms: &[Cosine], step_s: f64, count: usize) -> Vec<f64> {
    let mut sums = vec![0.0; count];
    for terms in terms.chunks(LANES) {
        let mut lanes = CosineLanes::new(terms, step_s);
        for block in sums.chunks_mut(STEPS) {
            lanes.add_to(block);
            lanes.turn();
        }
    }
    sums
}

impl CosineLanes {
    /// Terms at time zero; unused lanes have zero weight.
    fn new(terms: &[Cosine], step_s: f64) -> CosineLanes {
        let mut all = [Cosine::default(); LANES];
        all[..terms.len()].copy_from_slice(terms);
        let turn = |steps: f64| {
            let angle = |term: &Cosine| term.frequency_rad_per_s * steps * step_s;
            [all.each_ref().map(|term| cos(angle(term))), all.each_ref().map(|term| sin(angle(term)))]
        };
        let half = turn(0.5)[1];
        CosineLanes {
            cosine: all.map(|term| term.weight),
            sine: [0.0; LANES],
            step: turn(1.0),
            block: turn(STEPS as f64),
            bend: half.map(|sine| 4.0 * sine * sine),
        }
    }

    /// Adds the terms one step later, two steps later, and so on.
    fn add_to(&self, sums: &mut [f64]) {
        let mut value = self.cosine;
        // c cos(w t) - c cos(w (t - h))
        let mut change: [f64; LANES] = std::array::from_fn(|lane| {
            self.cosine[lane] * (1.0 - self.step[0][lane]) - self.sine[lane] * self.step[1][lane]
        });
        for sum in sums {
            for lane in 0..LANES {
                change[lane] -= self.bend[lane] * value[lane];
                value[lane] += change[lane];
            }
            let pairs = [value[0] + value[4], value[1] + value[5], value[2] + value[6], value[3] + value[7]];
            *sum += (pairs[0] + pairs[2]) + (pairs[1] + pairs[3]);
        }
    }

    /// Advances the terms by a block of steps.
    fn turn(&mut self) {
        for lane in 0..LANES {
            let [cosine, sine] = [self.cosine[lane], self.sine[lane]];
            let [by_cosine, by_sine] = [self.block[0][lane], self.block[1][lane]];
            self.cosine[lane] = cosine * by_cosine - sine * by_sine;
            self.sine[lane] = sine * by_cosine + cosine * by_sine;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums equal those of separate cosines, over more steps than the recurrence takes without a
    /// restart, and more terms than are parallel; some turn by nearly nothing, by half a turn and
    /// by more than a whole one in a step.
    #[test]
    fn sums_are_those_of_cosines_of_their_own() {
        let step_s = 1e-3;
        let frequencies =
            [0.0, 1e-6, 0.1, 3.0, 40.0, 500.0, 3141.0, std::f64::consts::PI / step_s, 6283.0, 2e4];
        let terms = frequencies.map(|frequency_rad_per_s| Cosine {
            frequency_rad_per_s,
            weight: cos(7.0 * frequency_rad_per_s),
        });
        let sums = sums_of_cosines(&terms, step_s, 1000);
        assert_eq!(sums.len(), 1000);
        for (index, found) in sums.into_iter().enumerate() {
            let time = (index + 1) as f64 * step_s;
            // ORIGIN: analytic
            let expected: f64 =
                terms.iter().map(|term| term.weight * cos(term.frequency_rad_per_s * time)).sum();
            assert!((found - expected).abs() < 1e-12, "{found} {expected} at {time} s");
        }
    }
}
