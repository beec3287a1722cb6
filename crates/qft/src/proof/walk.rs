//! The prover: halves boxes until every leaf is proven, in ordinary floating-point arithmetic. The
//! checker must confirm the result.

use std::cell::Cell;

use phea_dynamics::watch::{Progress, Stopped, Watch};

use super::certificate::{FrequencyPanel, LEAF};
use super::claimed::Claimed;
use super::direction::{LeafOutcome, leaf, most_varied};
use super::patch::Patch;
use super::points::PanelRange;

/// Result of a claim over a band.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum WalkOutcome {
    /// Panels that prove the claim.
    Shown(Vec<FrequencyPanel>),
    /// The claim is refuted at this point: |V| is greater than |U| by this ratio.
    Wrong { at: Fractions, ratio: f64 },
    /// Too many leaves; this box is not proven.
    Open(ProofRegion),
    /// Too many control points.
    TooLarge,
}

/// A frequency, and a plant by its variables.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fractions {
    pub(crate) frequency_rad_per_s: f64,
    pub(crate) variables: Vec<f64>,
}

/// A part of the box and of the band.
#[derive(Clone, Debug, PartialEq)]
pub struct ProofRegion {
    /// Index of the box.
    pub of_box: usize,
    /// Ends of the band, rad/s.
    pub band_rad_per_s: [f64; 2],
    /// The range of each variable, within 0 to 1.
    pub variables: Vec<[f64; 2]>,
}

/// Effort of a walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProofEffort<'a> {
    /// Largest number of leaves of a panel.
    pub(crate) leaves: usize,
    /// Largest number of halvings on the way to a leaf.
    pub(crate) depth: usize,
    /// Reserve for the rounding of the checker, as a fraction of |V|^2.
    pub(crate) room: f64,
    /// Common budget of all walks of one claim.
    pub(crate) budget: &'a ProofBudget,
}

/// The cost of one claim, in control points: the time is proportional to them.
#[derive(Debug)]
pub(crate) struct ProofBudget {
    whole: u64,
    left: Cell<u64>,
}

impl ProofBudget {
    pub(crate) fn new(points: u64) -> ProofBudget {
        ProofBudget { whole: points, left: Cell::new(points) }
    }

    /// Resets the budget for another claim.
    pub(crate) fn renew(&self) {
        self.left.set(self.whole);
    }

    pub(crate) fn is_spent(&self) -> bool {
        self.left.get() == 0
    }

    fn spend(&self, points: usize) {
        self.left.set(self.left.get().saturating_sub(points as u64));
    }

    fn report_progress(&self, watch: Watch<'_>) -> Result<(), Stopped> {
        let spent = 1.0 - self.left.get() as f64 / self.whole.max(1) as f64;
        if watch(Progress { stage: PROVING, fraction: spent }) { Ok(()) } else { Err(Stopped) }
    }
}

/// A box to be processed: its control points, and its range on each axis of its panel.
struct QueuedBox {
    patch: Patch<f64>,
    sides: Vec<[f64; 2]>,
    depth: usize,
}

const PROVING: &str = "proving";
/// Number of boxes after which the watch is consulted.
const LOOK: usize = 64;

/// Searches for a tree that proves |V| <= |U| over one panel, and returns it if it is found.
pub(crate) fn walk(
    claimed: &Claimed<f64>,
    variables: usize,
    range: PanelRange,
    effort: ProofEffort<'_>,
    watch: Watch<'_>,
) -> Result<WalkOutcome, Stopped> {
    let Some(whole) = Patch::over(claimed, variables, range) else { return Ok(WalkOutcome::TooLarge) };
    let sides = vec![[0.0, 1.0]; whole.axes()];
    let mut waiting = vec![QueuedBox { patch: whole, sides, depth: 0 }];
    let (mut tree, mut leaves, mut looked) = (vec![], 0, 0);
    while let Some(QueuedBox { patch, sides, depth }) = waiting.pop() {
        effort.budget.spend(patch.size());
        looked += 1;
        if looked % LOOK == 0 {
            effort.budget.report_progress(watch)?;
        }
        match look(&patch, effort.room) {
            LeafOutcome::Shown(direction) => {
                tree.push(LEAF);
                tree.extend(direction.iter().flat_map(|part| part.to_be_bytes()));
                leaves += 1;
            }
            LeafOutcome::Wrong { corner, ratio } => {
                return Ok(WalkOutcome::Wrong { at: at(range, &sides, corner), ratio });
            }
            LeafOutcome::Halve(axis)
                if leaves + waiting.len() < effort.leaves
                    && depth < effort.depth
                    && !effort.budget.is_spent() =>
            {
                tree.push(axis as u8);
                let [lower, upper] = patch.halves(axis);
                let [low_sides, high_sides] = halved(&sides, axis);
                waiting.push(QueuedBox { patch: upper, sides: high_sides, depth: depth + 1 });
                waiting.push(QueuedBox { patch: lower, sides: low_sides, depth: depth + 1 });
            }
            LeafOutcome::Halve(_) => return Ok(WalkOutcome::Open(region(range, &sides))),
        }
    }
    Ok(WalkOutcome::Shown(vec![FrequencyPanel { from: range.from, to: range.to, late: range.late, tree }]))
}

/// The outcome for a patch. If exactly known images would prove it, it is halved so that the images
/// are known better.
fn look(patch: &Patch<f64>, room: f64) -> LeafOutcome {
    let found = leaf(&patch.points(), room);
    let (LeafOutcome::Halve(_), Some((points, image))) = (found, patch.with_known_images()) else {
        return found;
    };
    match leaf(&points, room) {
        LeafOutcome::Halve(_) => found,
        LeafOutcome::Shown(_) | LeafOutcome::Wrong { .. } => LeafOutcome::Halve(most_varied(image)),
    }
}

fn halved(sides: &[[f64; 2]], axis: usize) -> [Vec<[f64; 2]>; 2] {
    let [mut lower, mut upper] = [sides.to_vec(), sides.to_vec()];
    let middle = 0.5 * (sides[axis][0] + sides[axis][1]);
    lower[axis][1] = middle;
    upper[axis][0] = middle;
    [lower, upper]
}

/// The frequency at this fraction of a panel.
fn frequency(range: PanelRange, fraction: f64) -> f64 {
    match range.to.is_finite() {
        true => range.from + fraction * (range.to - range.from),
        false => range.from / fraction,
    }
}

fn at(range: PanelRange, sides: &[[f64; 2]], corner: u64) -> Fractions {
    let fractions = sides
        .iter()
        .enumerate()
        .map(|(axis, [low, high])| if corner >> axis & 1 == 1 { *high } else { *low });
    let fractions: Vec<f64> = fractions.collect();
    let (own, variables) =
        fractions.split_first().map_or((0.0, vec![]), |(own, others)| (*own, others.to_vec()));
    Fractions { frequency_rad_per_s: frequency(range, own), variables }
}

fn region(range: PanelRange, sides: &[[f64; 2]]) -> ProofRegion {
    let (own, others) =
        sides.split_first().map_or(([0.0, 1.0], vec![]), |(own, others)| (*own, others.to_vec()));
    let [one, other] = own.map(|fraction| frequency(range, fraction));
    ProofRegion { of_box: 0, band_rad_per_s: [one.min(other), one.max(other)], variables: others }
}
