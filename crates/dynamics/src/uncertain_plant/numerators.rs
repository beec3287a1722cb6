//! Paths to the signals that a controller reads in addition to the output.

/// Numerators of the paths to a rate, highest power first, over the denominator of the command's
/// path to the output.
#[derive(Clone, Debug, PartialEq)]
pub struct RateNumerators<S> {
    /// Numerator from the command, before its dead time.
    pub command: Vec<S>,
    /// Numerator from the disturbance.
    pub disturbance: Vec<S>,
    /// Numerators to the inner signal that a sampled controller feeds back, from command and
    /// disturbance; `None` if it feeds back none.
    pub inner: Option<[Vec<S>; 2]>,
}

/// Numbers of coefficients of these numerators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RateLengths {
    paths: [usize; 2],
    inner: Option<[usize; 2]>,
}

impl<S> RateNumerators<S> {
    pub(super) fn lengths(&self) -> RateLengths {
        RateLengths {
            paths: [self.command.len(), self.disturbance.len()],
            inner: self.inner.as_ref().map(|inner| inner.each_ref().map(Vec::len)),
        }
    }

    /// All coefficients in one sequence.
    pub(super) fn flat(self) -> impl Iterator<Item = S> {
        let inner = self.inner.into_iter().flatten().flatten();
        self.command.into_iter().chain(self.disturbance).chain(inner)
    }

    /// Numerators of these lengths from coefficients in that order.
    pub(super) fn sorted(
        RateLengths { paths, inner }: RateLengths,
        flat: &mut impl Iterator<Item = S>,
    ) -> RateNumerators<S> {
        let mut take = |count: usize| flat.by_ref().take(count).collect();
        let [command, disturbance] = paths.map(&mut take);
        RateNumerators { command, disturbance, inner: inner.map(|inner| inner.map(take)) }
    }
}
