//! Runs of a campaign that are still to be simulated, and their distribution over threads.

use std::collections::BTreeSet;
use std::ops::Range;

/// Runs that no thread has taken yet.
pub(super) struct RemainingRuns {
    pub(super) runs: Range<u64>,
    /// Runs among them whose rows already exist.
    pub(super) known: BTreeSet<u64>,
    /// Number of idle threads.
    pub(super) idle: usize,
}

impl RemainingRuns {
    /// Number of remaining runs.
    pub(super) fn left(&mut self) -> u64 {
        while self.known.first() == Some(&self.runs.start) && self.runs.start < self.runs.end {
            self.known.pop_first();
            self.runs.start += 1;
        }
        (self.runs.end - self.runs.start).saturating_sub(self.known.len() as u64)
    }

    /// Next run for a thread that simulates this number of runs; sets `works` if it takes one. The
    /// last runs are left to idle threads: a further lane costs little, but a separate thread is
    /// quicker.
    pub(super) fn take(&mut self, driving: usize, works: &mut bool) -> Option<u64> {
        let left = self.left();
        if left == 0 || (driving > 0 && left <= self.idle as u64) {
            return None;
        }
        if !std::mem::replace(works, true) {
            self.idle = self.idle.saturating_sub(1);
        }
        let run = self.runs.start;
        self.runs.start += 1;
        Some(run)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn supply(runs: u64, idle: usize) -> RemainingRuns {
        RemainingRuns { runs: 0..runs, known: BTreeSet::new(), idle }
    }

    /// Every thread simulates one run if there are as many runs as threads, though the first could
    /// take all into its lanes.
    #[test]
    fn every_thread_drives_before_lanes_are_filled() {
        let (mut supply, mut works) = (supply(6, 3), [false; 3]);
        let taken: Vec<Option<u64>> = (0..4).map(|lane| supply.take(lane, &mut works[0])).collect();
        assert_eq!(taken, [Some(0), Some(1), Some(2), Some(3)]);
        assert_eq!((supply.take(0, &mut works[1]), supply.take(1, &mut works[1])), (Some(4), None));
        assert_eq!((supply.take(0, &mut works[2]), supply.take(1, &mut works[2])), (Some(5), None));
        assert_eq!((supply.left(), supply.idle), (0, 0));
    }

    #[test]
    fn runs_whose_rows_are_there_are_passed_over() {
        let mut supply = supply(5, 1);
        supply.known = BTreeSet::from([0, 2, 4]);
        let mut works = false;
        assert_eq!(supply.left(), 2);
        let taken: Vec<u64> = std::iter::from_fn(|| supply.take(0, &mut works)).collect();
        assert_eq!(taken, [1, 3]);
    }
}
