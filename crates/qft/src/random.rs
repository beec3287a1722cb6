//! Random numbers from a seed.

/// The next number of SplitMix64, its upper 53 bits as a share in [0, 1).
///
/// Source: Steele, Lea and Flood (2014).
pub(crate) fn share(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::share;

    /// The first numbers of SplitMix64 from seed 1234567, as its reference implementation prints them.
    #[test]
    fn the_generator_is_the_published_one() {
        // ORIGIN: paper, Steele, Lea and Flood (2014): outputs of the reference implementation for seed 1234567
        let expected: [u64; 3] =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        let mut state = 1_234_567;
        for number in expected {
            assert_eq!(share(&mut state), (number >> 11) as f64 / 9_007_199_254_740_992.0);
        }
    }
}
