//! Ringing of a force: shows, after trajectories have separated, if a solver has damped an
//! oscillation.
//!
//! ```text
//! R_k^2 = mean over window k of (F - mean of F over the 10 ms around)^2          windows of 0.1 s
//! ```
//!
//! The phase of a ringing that grew from almost zero carries no information, but its strength does,
//! as far as it is known: an onset may be in the window before or after, and if CVODE's own runs
//! (at 1e-11, at 1e-11 with random kicks, and at 1e-9) differ by more than these fractions in the
//! largest of R_(k-1), R_k, R_(k+1), the strength depends on quantities smaller than any tolerance.
//! A rig on which phea differs from them is run by CVODE at 1e-13 too: CVODE's own error may have
//! grown into a ringing, with phea being right.
//!
//! ```text
//! known       largest of R_(k-1), R_k, R_(k+1)  >=  0.7 smallest of CVODE's R_k
//!             R_k  <=  1.3 largest of CVODE's R_(k-1), R_k, R_(k+1)
//! unknown     largest of R_(k-1), R_k, R_(k+1)  >=  0.7 P        where all of CVODE's R_k are P or more: it must ring
//! ```
//!
//! of each window with rows after trajectories have separated; P, a thousandth of the peak, is the
//! smallest that counts as ringing.

/// Time over which the slow part of a force is averaged, s.
const SLOW_S: f64 = 10e-3;
const WINDOW_S: f64 = 0.1;
/// Limits relative to the smallest and to the largest ringing of CVODE's runs.
const LEAST: f64 = 0.7;
const MOST: f64 = 1.3;
/// Fraction of the peak above which a force counts as rough.
const FLOOR: f64 = 1e-3;

/// The ringing of a run compared with that of CVODE.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Roughness {
    /// Windows in which CVODE rings, and those among them in which its strength is known.
    pub(crate) windows: usize,
    pub(crate) known: usize,
    /// Smallest ratio to CVODE's smallest ringing, or to the threshold of ringing; 1 if CVODE rings
    /// in no window.
    pub(crate) least: f64,
    /// Largest ratio to CVODE's largest ringing, if that is known; 1 if neither rings.
    pub(crate) most: f64,
}

impl Roughness {
    /// Compares a run's force with those of CVODE, on rows `step_s` apart that separate after
    /// `rows` of them; `None` if they do not separate.
    pub(crate) fn compared(
        force: &[f64],
        references: &[&[f64]],
        rows: usize,
        peak: f64,
        step_s: f64,
    ) -> Option<Roughness> {
        let first = (rows < force.len()).then(|| rows / rows_of(WINDOW_S, step_s))?;
        let ours = rough(force, step_s);
        let theirs: Vec<Vec<f64>> = references.iter().map(|reference| rough(reference, step_s)).collect();
        let floor = FLOOR * peak;
        let mut found = Roughness { windows: 0, known: 0, least: 1.0, most: 1.0 };
        for (window, &rough) in ours.iter().enumerate().skip(first) {
            let here = theirs.iter().map(|one| one.get(window).copied().unwrap_or_default());
            let least = here.fold(f64::INFINITY, f64::min);
            let near = theirs.iter().map(|one| most_near(one, window).max(floor));
            let [lowest, highest] =
                near.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], one| [low.min(one), high.max(one)]);
            let known = lowest >= LEAST * highest;
            if least >= floor {
                found.windows += 1;
                found.known += usize::from(known);
                let required = if known { least } else { floor };
                found.least = found.least.min(most_near(&ours, window) / required);
            }
            if known {
                found.most = found.most.max(rough / highest);
            }
        }
        Some(found)
    }

    /// Difference from CVODE's ringing, if there is one.
    pub(crate) fn fault(&self) -> Option<String> {
        if self.least < LEAST {
            Some(format!("rings with {:.2} of the least that CVODE finds: calmed", self.least))
        } else if self.most > MOST {
            Some(format!("rings with {:.2} of the most that CVODE finds", self.most))
        } else {
            None
        }
    }
}

/// Largest root mean square of the fast part of a force, over all its windows.
pub(crate) fn roughest(force: &[f64], step_s: f64) -> f64 {
    rough(force, step_s).into_iter().fold(0.0, f64::max)
}

/// True if the roughness is large enough to count.
pub(crate) fn is_rough(roughness: f64, peak: f64) -> bool {
    roughness >= FLOOR * peak
}

/// The largest of a window and its neighbours.
fn most_near(rough: &[f64], window: usize) -> f64 {
    let around = window.saturating_sub(1)..(window + 2).min(rough.len());
    rough[around].iter().copied().fold(0.0, f64::max)
}

/// Root mean square of the fast part, window by window.
fn rough(force: &[f64], step_s: f64) -> Vec<f64> {
    let half = rows_of(SLOW_S, step_s) / 2;
    let mut sums = vec![0.0];
    for value in force {
        sums.push(sums[sums.len() - 1] + value);
    }
    let fast: Vec<f64> = (0..force.len())
        .map(|row| {
            let (from, to) = (row.saturating_sub(half), (row + half + 1).min(force.len()));
            force[row] - (sums[to] - sums[from]) / (to - from) as f64
        })
        .collect();
    let mean_square = |rows: &[f64]| rows.iter().map(|value| value * value).sum::<f64>() / rows.len() as f64;
    fast.chunks_exact(rows_of(WINDOW_S, step_s)).map(|rows| mean_square(rows).sqrt()).collect()
}

fn rows_of(time_s: f64, step_s: f64) -> usize {
    (time_s / step_s).round() as usize
}
