//! Unions of gain intervals.

use phea_dynamics::order::sort_by_number;

/// A union of disjoint open intervals of gains, in increasing order; the last may end at infinity.
/// Gains are ratios, not dB.
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
        sort_by_number(&mut intervals, |interval| interval[0]);
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

    /// True if no gain is forbidden.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True if every gain is forbidden.
    ///
    /// # Example
    /// ```
    /// use phea_qft::bound::GainIntervals;
    /// let low = GainIntervals::union_of(vec![[0.0, 2.0]]);
    /// let high = GainIntervals::union_of(vec![[1.0, f64::INFINITY]]);
    /// assert!(low.union(&high).is_everything() && !low.is_everything());
    /// ```
    pub fn is_everything(&self) -> bool {
        self.0 == [[0.0, f64::INFINITY]]
    }

    /// True if an interval contains this gain.
    pub fn contains(&self, gain: f64) -> bool {
        self.around(gain).is_some()
    }

    /// The interval that contains this gain.
    ///
    /// # Example
    /// ```
    /// use phea_qft::bound::GainIntervals;
    /// let forbidden = GainIntervals::union_of(vec![[1.0, 4.0], [6.0, 8.0]]);
    /// assert_eq!(forbidden.around(3.0), Some([1.0, 4.0])); // 1 and 4 are the nearest allowed gains
    /// assert_eq!(forbidden.around(4.0), None);
    /// ```
    pub fn around(&self, gain: f64) -> Option<[f64; 2]> {
        self.0.iter().copied().find(|&[low, high]| low < gain && gain < high)
    }

    /// The union of two unions.
    pub fn union(&self, other: &GainIntervals) -> GainIntervals {
        GainIntervals::union_of(self.0.iter().chain(&other.0).copied().collect())
    }

    /// Adds an interval.
    pub(super) fn insert(&mut self, [low, high]: [f64; 2]) {
        if self.covers([low, high]) {
            return;
        }
        let (mut low, mut high) = (low, high);
        self.0.retain(|other| {
            let apart = other[1] < low || high < other[0];
            if !apart {
                low = low.min(other[0]);
                high = high.max(other[1]);
            }
            apart
        });
        let place = self.0.partition_point(|other| other[0] < low);
        self.0.insert(place, [low, high]);
    }

    /// True if the union contains all of this interval; always true of an interval without width.
    pub(super) fn covers(&self, [low, high]: [f64; 2]) -> bool {
        !matches!(low.partial_cmp(&high), Some(std::cmp::Ordering::Less))
            || self.0.iter().any(|other| other[0] <= low && high <= other[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_added_one_by_one_give_the_same_union_in_any_order() {
        let all =
            [[5.0, 6.0], [1.0, 2.0], [2.5, 3.0], [2.0, 2.5], [9.0, f64::INFINITY], [7.0, 7.0], [0.0, 0.5]];
        let at_once = GainIntervals::union_of(all.to_vec());
        for turn in 0..all.len() {
            let mut union = GainIntervals::default();
            all.iter().cycle().skip(turn).take(all.len()).for_each(|&interval| union.insert(interval));
            assert_eq!(union, at_once);
        }
        assert_eq!(at_once.intervals(), [[0.0, 0.5], [1.0, 3.0], [5.0, 6.0], [9.0, f64::INFINITY]]);
    }
}
