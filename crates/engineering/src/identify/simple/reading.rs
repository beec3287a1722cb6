/// A number that was read off a curve, with its 95 % interval where there is one. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveReading {
    /// The number.
    pub value: f64,
    /// Ends of its interval.
    pub interval: Option<[f64; 2]>,
}

impl CurveReading {
    pub(in crate::identify) fn of(value: f64, deviation: f64) -> CurveReading {
        let half = 1.96 * deviation;
        CurveReading { value, interval: half.is_finite().then_some([value - half, value + half]) }
    }

    pub(in crate::identify) fn deviation(&self) -> f64 {
        self.interval.map_or(f64::INFINITY, |[low, high]| (high - low) / 3.92)
    }

    pub(in crate::identify) fn times(&self, factor: f64) -> CurveReading {
        CurveReading::of(self.value * factor, self.deviation() * factor.abs())
    }

    pub(in crate::identify) fn plus(&self, offset: f64) -> CurveReading {
        CurveReading::of(self.value + offset, self.deviation())
    }

    /// The difference of two that err independently.
    pub(in crate::identify) fn minus(&self, other: &CurveReading) -> CurveReading {
        let square = |one: &CurveReading| one.deviation() * one.deviation();
        CurveReading::of(self.value - other.value, (square(self) + square(other)).sqrt())
    }

    /// Mean of several that err independently.
    pub(in crate::identify) fn mean(all: &[CurveReading]) -> Option<CurveReading> {
        let count = all.len() as f64;
        let sum: f64 = all.iter().map(|one| one.value).sum();
        let squares: f64 = all.iter().map(|one| one.deviation() * one.deviation()).sum();
        (!all.is_empty()).then(|| CurveReading::of(sum / count, squares.sqrt() / count))
    }

    /// The quotient of two that err independently.
    pub(in crate::identify) fn over(&self, other: &CurveReading) -> CurveReading {
        let value = self.value / other.value;
        let [first, second] = [self, other].map(|one| one.deviation() / one.value);
        CurveReading::of(value, value.abs() * (first * first + second * second).sqrt())
    }
}
