//! Random numbers from a seed.

use crate::portable;

/// Next number of SplitMix64, its upper 53 bits as a fraction in [0, 1).
///
/// Source: Steele, Lea and Flood (2014).
///
/// # Example
/// ```
/// let mut state = 7;
/// let first = phea_dynamics::random::uniform(&mut state);
/// assert!((0.0..1.0).contains(&first) && phea_dynamics::random::uniform(&mut state) != first);
/// ```
pub fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(INCREMENT);
    (mixed(*state) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Initial state of the random numbers of the experiment with this index: it depends on seed and
/// index only, not on other experiments.
///
/// # Example
/// ```
/// use phea_dynamics::random::{uniform, stream};
/// let first = |seed, index| uniform(&mut stream(seed, index));
/// assert_eq!(first(1, 7), first(1, 7));
/// assert!(first(1, 7) != first(1, 8) && first(1, 7) != first(2, 7));
/// ```
pub fn stream(seed: u64, index: u64) -> u64 {
    mixed(mixed(seed.wrapping_add(INCREMENT)) ^ mixed(index.wrapping_add(INCREMENT)).wrapping_add(INCREMENT))
}

const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

/// Every bit of the result depends on every bit of the number, and different numbers give different
/// results.
fn mixed(number: u64) -> u64 {
    let mut z = number;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Next number of a normal distribution with mean zero and standard deviation one.
///
/// ```text
/// n = sqrt(-2 ln(1 - s_1)) cos(2 pi s_2)           s_1, s_2 uniform in [0, 1)
/// ```
///
/// Source: Box and Muller (1958).
pub fn normal(state: &mut u64) -> f64 {
    let (first, second) = (uniform(state), uniform(state));
    (-2.0 * portable::log1p(-first)).sqrt() * portable::cos(2.0 * std::f64::consts::PI * second)
}

#[cfg(test)]
mod tests {
    use super::{normal, uniform};

    #[test]
    fn normal_numbers_have_the_moments_of_their_distribution() {
        let (mut state, count) = (5, 100_000);
        let numbers: Vec<f64> = (0..count).map(|_| normal(&mut state)).collect();
        let mean = |power: i32| {
            let sum: f64 = numbers.iter().map(|n| (0..power).fold(1.0, |product, _| product * n)).sum();
            sum / f64::from(count)
        };
        // five standard errors of each mean
        let error = 5.0 / f64::from(count).sqrt();
        assert!(mean(1).abs() < error && (mean(2) - 1.0).abs() < 1.5 * error);
        assert!(mean(3).abs() < 4.0 * error && (mean(4) - 3.0).abs() < 10.0 * error);
    }

    /// The first numbers of SplitMix64 from seed 1234567, as printed by its reference
    /// implementation.
    #[test]
    fn the_generator_is_the_published_one() {
        // ORIGIN: paper, Steele, Lea and Flood (2014): outputs of the reference implementation for
        // seed 1234567
        let expected: [u64; 3] =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        let mut state = 1_234_567;
        for number in expected {
            assert_eq!(uniform(&mut state), (number >> 11) as f64 / 9_007_199_254_740_992.0);
        }
    }
}
