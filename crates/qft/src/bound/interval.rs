//! Unions of gain intervals.

/// A union of disjoint open intervals of gains, in increasing order; the last may end at infinity. The gains themselves, not
/// dB.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GainIntervals(Vec<[f64; 2]>);

impl GainIntervals {
    /// The union of these intervals; empty ones are dropped, overlapping and touching ones joined.
    ///
    /// # Example
    /// ```
    /// use phea_qft::bound::GainIntervals;
    /// let union = GainIntervals::union_of(vec![[3.0, 4.0], [1.0, 2.0], [1.5, 3.0], [6.0, 5.0]]);
    /// assert_eq!(union.intervals(), [[1.0, 4.0]]);
    /// assert!(union.contains(2.0) && !union.contains(4.0));
    /// ```
    pub fn union_of(mut intervals: Vec<[f64; 2]>) -> GainIntervals {
        intervals.retain(|[low, high]| low < high);
        intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut union: Vec<[f64; 2]> = Vec::with_capacity(intervals.len());
        for [low, high] in intervals {
            match union.last_mut() {
                Some(last) if low <= last[1] => last[1] = last[1].max(high),
                _ => union.push([low, high]),
            }
        }
        GainIntervals(union)
    }

    /// The intervals.
    pub fn intervals(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Whether no gain is forbidden.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether this gain lies within an interval.
    pub fn contains(&self, gain: f64) -> bool {
        self.0.iter().any(|&[low, high]| low < gain && gain < high)
    }

    /// What is in one of two unions.
    pub fn union(&self, other: &GainIntervals) -> GainIntervals {
        GainIntervals::union_of(self.0.iter().chain(&other.0).copied().collect())
    }
}
