//! A scale factor by which division is exact.

/// The greatest power of two not above a positive number; division by it is exact.
pub(super) fn power_of_two(value: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(value.max(f64::MIN_POSITIVE).to_bits() & EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::power_of_two;

    #[test]
    fn powers_of_two_lie_at_or_below() {
        for (value, power) in [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (0.3, 0.25), (1e3, 512.0)] {
            assert_eq!(power_of_two(value), power);
        }
        assert_eq!(power_of_two(0.0), f64::MIN_POSITIVE);
    }
}
