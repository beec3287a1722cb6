//! Decimal numbers times exact factors, rounded once.

/// Whole number of any size, in base 10⁹, lowest digit first.
#[derive(Clone, Debug)]
pub(crate) struct Whole(Vec<u64>);

const BASE: u64 = 1_000_000_000;

impl Whole {
    /// Number from decimal digits; other characters are skipped.
    pub(crate) fn from_digits(digits: &str) -> Whole {
        let mut whole = Whole(vec![0]);
        for digit in digits.chars().filter_map(|c| c.to_digit(10)) {
            whole.multiply(10);
            whole.add(u64::from(digit));
        }
        whole
    }

    fn add(&mut self, number: u64) {
        let mut carry = number;
        for limb in &mut self.0 {
            let sum = *limb + carry;
            *limb = sum % BASE;
            carry = sum / BASE;
        }
        if carry > 0 {
            self.0.push(carry);
        }
    }

    pub(crate) fn multiply(&mut self, factor: u64) {
        let mut carry: u128 = 0;
        for limb in &mut self.0 {
            let product = u128::from(*limb) * u128::from(factor) + carry;
            *limb = (product % u128::from(BASE)) as u64;
            carry = product / u128::from(BASE);
        }
        while carry > 0 {
            self.0.push((carry % u128::from(BASE)) as u64);
            carry /= u128::from(BASE);
        }
    }

    /// Divides in place; returns true if there is a remainder.
    fn divide(&mut self, divisor: u64) -> bool {
        let mut remainder: u128 = 0;
        for limb in self.0.iter_mut().rev() {
            let number = remainder * u128::from(BASE) + u128::from(*limb);
            *limb = (number / u128::from(divisor)) as u64;
            remainder = number % u128::from(divisor);
        }
        remainder > 0
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(|limb| *limb == 0)
    }

    fn to_digits(&self) -> String {
        self.0.iter().rev().map(|limb| format!("{limb:09}")).collect()
    }

    /// This number times 10^`ten` over the divisors, as the nearest f64: quotients are carried to
    /// forty digits, and the remainder decides a tie.
    pub(crate) fn to_f64(&self, ten: i64, divisors: &[u64]) -> f64 {
        if self.is_zero() {
            return 0.0;
        }
        let mut number = self.clone();
        let mut ten = ten;
        let mut inexact = false;
        for divisor in divisors.iter().filter(|divisor| **divisor > 1) {
            for _ in 0..40 {
                number.multiply(10);
            }
            ten -= 40;
            inexact |= number.divide(*divisor);
        }
        let digits = number.to_digits();
        let tail = if inexact { "1" } else { "" };
        if inexact {
            ten -= 1;
        }
        format!("{digits}{tail}e{ten}").parse().unwrap_or(f64::NAN)
    }
}
