//! Designs from which searches by steps begin.

use phea_dynamics::portable;
use phea_qft::design::{Design, NamedStructure, SearchedStructure, StructureEnding};
use phea_qft::loop_shaping::Structure;

use super::SearchStarts;
use super::led::LedDesign;
use crate::design::deployable::limit_value;
use crate::design::{DesignError, DesignLimitKind, DesignRun, ProjectDesign};

/// Number of structures from which searches begin.
const STARTS: usize = 4;
/// Largest miss of its limits, dB, for which a structure takes its turn in the order of free
/// numbers.
const NEARLY_DB: f64 = 0.3;
/// Largest ratio of the worst run to its requirement for which a search first covers the
/// neighbourhood of a design.
const NEAR: f64 = 1.6;
/// Ratio of the gain of a faster loop to that of a design, and fraction of the required settling
/// time in which its prefilter settles.
const MORE_GAIN: f64 = 2.0;
const PREFILTER_FRACTION: f64 = 0.6;
/// Greatest gain of the prefilter of a pure gain, if the design does not limit it.
const UNLIMITED_GAIN: f64 = 10.0;

/// Reach of a search from its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SearchReach {
    /// Each zero, pole and gain within a ratio, so that the contribution of the rig to the steps is
    /// known well.
    Near,
    /// The whole range of the structure.
    Anywhere,
}

impl LedDesign<'_> {
    /// The design, and the nearest structures as they were found, including its own structure if
    /// steps have led it since, the simplest first, with its prefilter if they have none; or the
    /// structures after those.
    pub(super) fn starts(
        &self,
        project_design: &ProjectDesign,
        searched: &[SearchedStructure],
    ) -> Vec<(Design, SearchReach)> {
        let design = &project_design.design;
        let least =
            |one: &SearchedStructure| one.least.as_ref().map_or(f64::NEG_INFINITY, |least| least.margin_db);
        let is_other = |one: &SearchedStructure| {
            let is_own = one.structure == design.structure && one.free_numbers == design.free_numbers;
            one.least.is_some() && !is_own
        };
        let others: Vec<&SearchedStructure> = searched.iter().filter(|one| is_other(one)).collect();
        let others = in_order(others, |one| (least(one), one.structure.dimension()));
        let nearest = STARTS - 1;
        let (skipped, most) = match self.aimed.from {
            SearchStarts::Nearest => (0, nearest),
            SearchStarts::Others => (nearest, STARTS),
        };
        let others =
            others.into_iter().skip(skipped).take(most).map(|searched| begun_from(searched, project_design));
        let others = others.map(|start| (start, SearchReach::Anywhere));
        let starts: Vec<(Design, SearchReach)> = match self.aimed.from {
            SearchStarts::Others => others.collect(),
            SearchStarts::Nearest => self.own_starts(project_design).chain(others).collect(),
        };
        let keeps = |one: &Design| {
            self.aimed.added.is_empty() || one.structure.integrators() >= design.structure.integrators()
        };
        starts.into_iter().filter(|(one, _)| !one.free_numbers.is_empty() && keeps(one)).collect()
    }

    /// The design. Before it, its neighbourhood, if its runs on the nonlinear rig miss by little;
    /// after it, if they miss, a faster loop with a slower prefilter: the loop suppresses the
    /// contribution of the rig to a step, and the prefilter shapes the rest.
    fn own_starts(
        &self,
        project_design: &ProjectDesign,
    ) -> impl Iterator<Item = (Design, SearchReach)> + use<> {
        let design = with_free_gain(project_design.design.clone(), project_design);
        let has_missed = !self.aimed.added.is_empty();
        let beside =
            (has_missed && project_design.worst_run() <= NEAR).then(|| (design.clone(), SearchReach::Near));
        let settling_s = self.required.settling_time_s.filter(|_| has_missed);
        let faster = settling_s.zip(design.prefilter.as_ref()).and_then(|(time_s, prefilter)| {
            let band = 0.01 * self.required.band_percent;
            let rad_per_s = -portable::ln(band) / (PREFILTER_FRACTION * time_s);
            let structures = [&design.structure, prefilter];
            let free_numbers = faster_behind_prefilter(structures, &design.free_numbers, rad_per_s)?;
            Some((Design { free_numbers, ..design.clone() }, SearchReach::Anywhere))
        });
        beside.into_iter().chain(std::iter::once((design, SearchReach::Anywhere))).chain(faster)
    }

    /// Structures shorter than that of a design that satisfy the limits over frequency, or miss
    /// only those on the path to its step, the simplest first.
    pub(super) fn simpler(
        &self,
        project_design: &ProjectDesign,
        run: &DesignRun,
    ) -> Result<Vec<Design>, DesignError> {
        let own = project_design.design.structure.order()?;
        let given = run.aimed.specifications.len() - run.aimed.design_limits.len();
        let leads = |specification: &usize| {
            let limit = specification.checked_sub(given);
            limit.and_then(|limit| run.aimed.design_limits.get(limit)).is_some_and(|kind| kind.is_led_to())
        };
        let mut shorter: Vec<(usize, &SearchedStructure)> = Vec::new();
        for searched in run.outcome.searched() {
            let order = searched.structure.order()?;
            let is_near = match searched.ending {
                StructureEnding::Met => true,
                StructureEnding::Missed => searched.binding.iter().any(leads),
                StructureEnding::NotEarned
                | StructureEnding::NotConverged
                | StructureEnding::NotStabilised => false,
            };
            if order < own && is_near && !searched.free_numbers.is_empty() {
                shorter.push((order, searched));
            }
        }
        shorter.sort_by_key(|(order, searched)| (*order, searched.structure.dimension()));
        Ok(shorter.into_iter().map(|(_, searched)| begun_from(searched, project_design)).collect())
    }
}

/// Order in which searches begin, by the least margin in dB and the number of free numbers of each
/// structure: those that miss nothing by more than [`NEARLY_DB`], the fewest numbers first, then
/// the others by their margins, the largest first.
fn in_order<One>(mut others: Vec<One>, of: impl Fn(&One) -> (f64, usize)) -> Vec<One> {
    others.sort_by(|one, other| of(other).0.total_cmp(&of(one).0));
    let near = others.iter().take_while(|one| of(one).0 >= -NEARLY_DB).count();
    if let Some(near) = others.get_mut(..near) {
        near.sort_by_key(|one| of(one).1);
    }
    others
}

/// A structure as it was found, with the prefilter of a design if it has none; for a pure gain,
/// with the gain of the design at its crossover, since the limits on the path to a step drive it as
/// high as stability permits.
fn begun_from(searched: &SearchedStructure, project_design: &ProjectDesign) -> Design {
    let design = &project_design.design;
    let mut free_numbers = searched.free_numbers.clone();
    let prefilter = match &searched.prefilter {
        Some(prefilter) => Some(prefilter.clone()),
        None => {
            let own = design.free_numbers.get(design.structure.dimension()..);
            free_numbers.extend_from_slice(own.unwrap_or_default());
            design.prefilter.clone()
        }
    };
    if searched.name == Some(NamedStructure::Proportional)
        && let (Some(own), Some(gain)) = (free_numbers.first_mut(), gain_at_crossover(project_design))
    {
        let [least, greatest] = searched.structure.gain;
        *own = portable::ln(gain.clamp(least, greatest));
    }
    let structure = searched.structure.clone();
    with_free_gain(
        Design { structure, prefilter, free_numbers, name: searched.name, ..design.clone() },
        project_design,
    )
}

/// Magnitude |G| of a design at the first crossover of its nominal loop.
fn gain_at_crossover(project_design: &ProjectDesign) -> Option<f64> {
    let crossover = project_design.designed.figures.nominal.as_ref()?.crossovers.first_rad_per_s?;
    let law = project_design.design.law.feedback.transfer_function().ok()?;
    Some(portable::magnitude(law.at_frequency(crossover)))
}

/// Free numbers of a controller and its prefilter with a larger gain, and with the first pole of
/// the prefilter at this frequency, rad/s; `None` if the gain or that pole is not free.
fn faster_behind_prefilter(
    [own, prefilter]: [&Structure; 2],
    free_numbers: &[f64],
    rad_per_s: f64,
) -> Option<Vec<f64>> {
    let [least, greatest] = own.gain;
    if least >= greatest {
        return None;
    }
    let mut faster = free_numbers.to_vec();
    let gain = faster.first_mut()?;
    *gain = portable::ln((MORE_GAIN * portable::exp(*gain)).clamp(least, greatest));
    let pole = prefilter.free_pole()?;
    let &[least, greatest] = prefilter.bounds().get(pole)?;
    *faster.get_mut(own.dimension() + pole)? = portable::ln(rad_per_s).clamp(least, greatest);
    Some(faster)
}

/// A pure gain with a prefilter whose gain is free, since it leaves |T(0)| < 1 and the search over
/// frequency holds that gain near 1; any other structure unchanged.
fn with_free_gain(mut start: Design, project_design: &ProjectDesign) -> Design {
    let place = start.structure.dimension().min(start.free_numbers.len());
    if let Some(prefilter) = &mut start.prefilter
        && start.name == Some(NamedStructure::Proportional)
    {
        let [least, greatest] = prefilter.gain;
        let most =
            limit_value(&project_design.limits, DesignLimitKind::PrefilterGain).unwrap_or(UNLIMITED_GAIN);
        prefilter.gain = [least.min(1.0), greatest.max(most)];
        // a number that is not free has no place
        if least == greatest {
            start.free_numbers.insert(place, portable::ln(least));
        }
    }
    start
}

#[cfg(test)]
mod tests {
    use phea_dynamics::controller::Element;
    use phea_dynamics::portable::ln;
    use phea_qft::loop_shaping::{Structure, StructureFactor};

    use super::{faster_behind_prefilter, in_order};

    /// Twice the gain of a PI, within its range, and the pole of the prefilter at the required
    /// frequency; the zero is unchanged.
    // ORIGIN: written by hand
    #[test]
    fn a_faster_loop_has_a_slower_prefilter() {
        let corner = [1.0, 100.0];
        let zero = StructureFactor::RealZero { frequency: corner };
        let parts = vec![StructureFactor::Fixed(Element::Integrator), zero];
        let own = Structure { sign: 1.0, gain: [0.1, 5.0], parts };
        let pole = StructureFactor::RealPole { frequency: corner };
        let prefilter = |parts| Structure { sign: 1.0, gain: [1.0, 1.0], parts };
        let of = |gain: f64, rad_per_s: f64| {
            let numbers = [gain, 20.0, 90.0].map(ln);
            faster_behind_prefilter([&own, &prefilter(vec![pole.clone()])], &numbers, rad_per_s)
        };
        assert_eq!(of(2.0, 16.0), Some([4.0, 20.0, 16.0].map(ln).to_vec()));
        assert_eq!(of(3.0, 0.5), Some([5.0, 20.0, 1.0].map(ln).to_vec()));
        assert_eq!(faster_behind_prefilter([&own, &prefilter(vec![])], &[0.0, 0.0], 16.0), None);
        let fixed = Structure { gain: [2.0, 2.0], ..own.clone() };
        assert_eq!(
            faster_behind_prefilter([&fixed, &prefilter(vec![pole.clone()])], &[0.0, 0.0], 16.0),
            None
        );
    }

    /// Within 0.3 dB the simplest structures come first, and of two equally simple ones that with
    /// the larger margin; beyond, the nearest, however simple.
    // ORIGIN: written by hand, margins in dB and numbers
    #[test]
    fn the_simplest_that_nearly_meet_come_first_then_the_nearest() {
        let given = vec![(-4.0, 1), (1.2, 6), (-0.31, 2), (-0.29, 3), (0.0, 5), (-2.0, 4), (0.4, 3)];
        let expected = vec![(0.4, 3), (-0.29, 3), (0.0, 5), (1.2, 6), (-0.31, 2), (-2.0, 4), (-4.0, 1)];
        assert_eq!(in_order(given, |one| *one), expected);
    }
}
