//! Loop of the servo with uncertain gain and pole, its plants on the edges of a grid, few
//! frequencies.
//!
//! ```text
//! P = k a/(s (s + a)),  k, a in [1, 10];      G = g (s + z)/((s + p1)(s + p2)),  x = ln (g, z, p1, p2)
//! |T| <= 1.2;   max |T| - min |T| <= upper - lower, dB, up to 15 rad/s
//! ```

use num_complex::Complex64;
use phea_dynamics::watch::unwatched;
use phea_qft::loop_shaping::{
    Aim, DescentStatus, Judgement, MarginRow, SearchOptions, SearchProblem, SearchResult, SearchStatus,
    Slopes, search,
};

use super::formula::differences;

/// Number of values of k and of a; of frequencies of |T|, and of its spread.
const POINTS: usize = 7;
const FREQUENCIES: [usize; 2] = [61, 41];
/// Number of the worst plants whose margins are given for each frequency.
const PLANTS_GIVEN: usize = 3;

#[derive(Clone)]
struct Servo {
    bounds: [[f64; 2]; 4],
    plants: Vec<[f64; 2]>,
    closed: Vec<f64>,
    /// Frequency, rad/s, and the allowed spread there, dB.
    tracked: Vec<[f64; 2]>,
}

/// Logarithmic grid of `count` points from 10^low to 10^high.
fn decades(low: f64, high: f64, count: usize) -> Vec<f64> {
    let fraction = |i: usize| i as f64 / (count - 1) as f64;
    (0..count).map(|i| 10_f64.powf(low + fraction(i) * (high - low))).collect()
}

fn db(z: Complex64) -> f64 {
    10.0 * z.norm_sqr().log10()
}

fn allowed_spread(frequency: f64) -> f64 {
    let s = Complex64::new(0.0, frequency);
    let upper = 0.6584 * (s + 30.0) / (s * s + 4.0 * s + 19.752);
    let lower = 120.0 / (s * s * s + 17.0 * s * s + 82.0 * s + 120.0);
    db(upper) - db(lower)
}

impl Servo {
    fn new() -> Servo {
        let points = decades(0.0, 1.0, POINTS);
        let is_end = |value: f64| value == points[0] || value == points[POINTS - 1];
        let pairs = points.iter().flat_map(|&k| points.iter().map(move |&a| [k, a]));
        let plants = pairs.filter(|&[k, a]| is_end(k) || is_end(a)).collect();
        let tracked = decades(-1.0, 15_f64.log10(), FREQUENCIES[1]);
        Servo {
            bounds: [[1e3, 1e8], [0.1, 1e3], [1.0, 1e4], [1.0, 1e4]].map(|range| range.map(f64::ln)),
            plants,
            closed: decades(-1.0, 4.0, FREQUENCIES[0]),
            tracked: tracked.into_iter().map(|frequency| [frequency, allowed_spread(frequency)]).collect(),
        }
    }

    /// Magnitude |T| of a plant, dB.
    fn closed_db(x: &[f64], [k, a]: [f64; 2], frequency: f64) -> f64 {
        let s = Complex64::new(0.0, frequency);
        let [g, z, p, q] = [x[0].exp(), x[1].exp(), x[2].exp(), x[3].exp()];
        let open = k * a * g * (s + z) / (s * (s + a) * (s + p) * (s + q));
        db(open / (1.0 + open))
    }

    /// Degree to which the worst plant violates the Routh conditions for s^4 + c3 s^3 + c2 s^2 + c1
    /// s + c0, relative to their terms.
    fn instability(&self, x: &[f64]) -> f64 {
        let [g, z, p, q] = [x[0].exp(), x[1].exp(), x[2].exp(), x[3].exp()];
        let missed = |&[k, a]: &[f64; 2]| {
            let [c3, c2, c1, c0] = [a + p + q, a * (p + q) + p * q, a * p * q + k * a * g, k * a * g * z];
            (c1 * c1 + c3 * c3 * c0 - c3 * c2 * c1) / (c1 * c1 + c3 * c3 * c0)
        };
        self.plants.iter().map(missed).fold(0.0, f64::max)
    }

    /// The plants with the least values at a frequency, the least first.
    fn least(values: &[f64]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        order.truncate(PLANTS_GIVEN);
        order
    }

    /// Samples with their margins and rates: |T| by frequency and plant, then the spread by
    /// frequency and pair of plants.
    fn margins(&self, x: &[f64]) -> Vec<(usize, f64, f64)> {
        let count = self.plants.len();
        let closed_db = |frequency: f64| -> Vec<f64> {
            self.plants.iter().map(|&plant| Servo::closed_db(x, plant, frequency)).collect()
        };
        let negated = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
        let mut found = vec![];
        for (index, &frequency) in self.closed.iter().enumerate() {
            let closed = closed_db(frequency);
            let tops = Servo::least(&negated(&closed)).into_iter();
            found.extend(tops.map(|top| (index * count + top, 20.0 * 1.2_f64.log10() - closed[top], 1.0)));
        }
        let first = self.closed.len() * count;
        for (index, &[frequency, allowed]) in self.tracked.iter().enumerate() {
            let closed = closed_db(frequency);
            for top in Servo::least(&negated(&closed)) {
                found.extend(Servo::least(&closed).into_iter().map(|bottom| {
                    let sample = first + (index * count + top) * count + bottom;
                    (sample, allowed - closed[top] + closed[bottom], 2.0)
                }));
            }
        }
        found
    }

    fn margin(&self, x: &[f64], sample: usize) -> f64 {
        let count = self.plants.len();
        let closed = |plant: usize, frequency: f64| Servo::closed_db(x, self.plants[plant], frequency);
        match sample.checked_sub(self.closed.len() * count) {
            None => 20.0 * 1.2_f64.log10() - closed(sample % count, self.closed[sample / count]),
            Some(pair) => {
                let [frequency, allowed] = self.tracked[pair / (count * count)];
                allowed - closed(pair / count % count, frequency) + closed(pair % count, frequency)
            }
        }
    }
}

impl SearchProblem for Servo {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let margins = self.margins(x);
        let worst_margin_db =
            margins.iter().map(|(_, margin, rate)| margin / rate).fold(f64::INFINITY, f64::min);
        let instability = self.instability(x);
        Judgement {
            objective_db: 20.0 * x[0].exp().log10(),
            worst_margin_db,
            stable: instability == 0.0,
            instability,
        }
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let row = |(sample, margin_db, rate): (usize, f64, f64)| {
            let slopes =
                differences(|x| [self.margin(x, sample)], x).into_iter().map(|[slope]| slope).collect();
            MarginRow { sample, margin_db, rate, slopes }
        };
        Slopes {
            objective_db: 20.0 * x[0].exp().log10(),
            objective_slopes: vec![20.0 * std::f64::consts::LOG10_E, 0.0, 0.0, 0.0],
            margins: self.margins(x).into_iter().map(row).collect(),
        }
    }
}

fn searched(seed: u64) -> SearchResult {
    let mut options = SearchOptions::new(Aim::Objective, seed);
    options.descent.reserve_db = 0.0;
    search(&mut Servo::new(), vec![], &options, &mut unwatched).unwrap().unwrap()
}

/// The least high-frequency gain with two real poles; the poles then coincide, a ridge by symmetry.
#[test]
fn least_gain_is_found_from_three_seeds() {
    // ORIGIN: recomputed with SciPy's SLSQP on the same plants and frequencies; 130.14 dB on dense
    // ones
    let (on_this_grid, dense) = (130.057990791047, 130.14);
    for seed in 1..=3 {
        let found = searched(seed);
        assert_eq!(found.status, SearchStatus::Ended(DescentStatus::Converged));
        let gain = found.judgement.objective_db;
        assert!((gain - on_this_grid).abs() < 2e-3 && (gain - dense).abs() < 0.2, "{seed} {found:?}");
        assert!(found.judgement.worst_margin_db > -1e-4, "{found:?}");
        assert!((found.x[2] - found.x[3]).abs() < 0.02, "{:?}", found.x);
        let last = found.ends.last().unwrap().judgement;
        assert!(found.ends.len() > 1 && last.objective_db - gain < 1e-3, "{:?}", found.ends);
        assert!(found.work.subproblems < 200, "{:?}", found.work);
    }
}
