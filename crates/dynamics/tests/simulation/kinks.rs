//! Rates with a kink, as those of friction have one at a standstill.

use phea_dynamics::scalar::Scalar;

use super::laws::{Law, Lawful, course, last, run};

/// x' = 1,  y' = |x - p|
#[derive(Clone)]
struct Bent(f64);

impl Law for Bent {
    const STATES: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::from(1.0);
        rates[1] = (y[0] - T::from(self.0)).abs();
    }
}

/// y(1) = (p^2 + (1 - p)^2)/2 at a thousand p. Steps that are refused and shortened do not end
/// where their error is blind; what is left are first attempts that begin so that it is.
#[test]
fn a_kink_is_met_to_the_tolerance_wherever_it_lies() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut refused = 0;
        let mut errors: Vec<f64> = (0..1000)
            .map(|index| {
                let place = 0.2 + 7e-4 * f64::from(index);
                let law = Lawful(Bent(place), 1.0);
                let result = run(&law, &[0.0; 2], &course(1.0, 1.0, vec![]), tolerance);
                refused += result.outcome.work.rejected;
                let exact = 0.5 * (place * place + (1.0 - place) * (1.0 - place));
                (last(&result, 1) - exact).abs() / tolerance
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors[900] < 3.0, "{tolerance:e}: {:?}", &errors[900..]);
        assert!(refused > 1000, "the kink is met by attempts: {refused}");
    }
}
