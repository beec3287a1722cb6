//! Structures of a search, with the results of each.

use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{
    BINDING_DB, ControllerChoice, NamedStructure, Objective, PrefilterChoice, SearchedStructure,
    StructureEnding,
};
use phea_qft::loop_shaping::Structure;
use phea_qft::verification::SpecificationMargin;

use super::{DesignError, DesignRun, ManualLaw, ManualPart, NominalMargins, ProjectDesign, SearchedLimit};
use crate::audit::{nominal_margins, steps_of_members};
use crate::project::{STRUCTURES, StructureChoice, word_of};
use crate::robust::RobustProblem;
use crate::simulate::ReachedStep;

/// A structure with its results.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachedStructure {
    /// Name; `None` for a structure of growing order or a given one.
    pub name: Option<NamedStructure>,
    /// Parts of a law that was found for a PID, if its T_d would not be positive.
    pub no_pid: Option<ManualLaw>,
    /// Factors of the structure.
    pub structure: Structure,
    /// Number of poles.
    pub order: usize,
    /// End of its search.
    pub ending: StructureEnding,
    /// True if the design has this structure.
    pub is_chosen: bool,
    /// Least margin to the limits of the search at its plants and frequencies; absent if no
    /// controller makes the plants stable.
    pub least: Option<SpecificationMargin>,
    /// Limit of that margin, if it leaves the loop no room.
    pub binding: Option<SearchedLimit>,
    /// Lowest frequency at which a zero was searched, rad/s, if a zero ended there.
    pub slowest_zero_rad_per_s: Option<f64>,
    /// Margins of the nominal loop.
    pub nominal: Option<NominalMargins>,
    /// High-frequency gain lim s^r G(s) for the relative degree r, dB.
    pub high_frequency_gain_db: Option<f64>,
    /// Number of poles minus number of zeros.
    pub relative_degree: i32,
    /// Quantity by which structures are compared, dB, smaller is better: the largest gain from the
    /// noise of the sensor to the command of the nominal loop, or the objective.
    pub compared_db: Option<f64>,
    /// Worst linear steps of the family, if a step is required: for the design those of its audit,
    /// for others those of members spread over the family; absent if no prefilter was fitted.
    pub steps: Option<ReachedStep>,
    /// True if the structure was simulated on the nonlinear rig, and a run misses a requirement in
    /// time.
    pub misses_on_rig: bool,
}

/// Word of a structure in a project; empty for one without a name.
pub fn structure_key(name: Option<NamedStructure>) -> &'static str {
    name.map_or("", |name| word_of(&STRUCTURES, &StructureChoice::Named(name)))
}

/// The structures of a design.
pub(super) fn reached(
    run: &DesignRun,
    project_design: &ProjectDesign,
) -> Result<Vec<ReachedStructure>, DesignError> {
    let each = run.outcome.searched().iter().map(|searched| reached_by(run, project_design, searched));
    Ok(each.collect::<Result<Vec<ReachedStructure>, LinearError>>()?)
}

/// Structures of an earlier design, with the results of its structure since it was led by its
/// steps; `least` is the least margin of its samples.
pub(super) fn led(
    run: &DesignRun,
    before: &ProjectDesign,
    led: &ProjectDesign,
    least: Option<SpecificationMargin>,
) -> Result<Vec<ReachedStructure>, DesignError> {
    let design = &led.design;
    let own = SearchedStructure {
        name: design.name,
        structure: design.structure.clone(),
        prefilter: design.prefilter.clone(),
        free_numbers: design.free_numbers.clone(),
        ending: if led.is_met() { StructureEnding::Met } else { StructureEnding::Missed },
        law: Some(design.law.clone()),
        least,
        binding: vec![],
        reached_db: noise_gain_db(run, led),
    };
    let own = reached_by(run, led, &own)?;
    let mut all: Vec<ReachedStructure> = before.structures.clone();
    for searched in all.iter_mut().filter(|one| one.is_chosen) {
        searched.misses_on_rig = before.misses_on_rig();
        searched.is_chosen = false;
    }
    match all.iter_mut().find(|one| one.structure == own.structure) {
        Some(known) => *known = own,
        None => all.push(own),
    }
    Ok(all)
}

fn reached_by(
    run: &DesignRun,
    project_design: &ProjectDesign,
    searched: &SearchedStructure,
) -> Result<ReachedStructure, LinearError> {
    let law = searched.law.as_ref().filter(|_| searched.least.is_some());
    let around = match law {
        Some(law) => {
            let compensation = Compensation::new(law, run.problem.sensor.clone())?;
            Some(RobustProblem { compensation, ..run.aimed.clone() })
        }
        None => None,
    };
    let nominal = around.as_ref().and_then(nominal_margins);
    let high_frequency_gain_db = match law {
        Some(law) => {
            let gain = law.feedback.transfer_function()?.gain();
            Some(decibels(gain.abs()))
        }
        None => None,
    };
    let is_chosen = searched.structure == project_design.design.structure;
    let audited = if is_chosen { audited_least(project_design) } else { None };
    let least = searched.least.clone().map(|sampled| audited.unwrap_or(sampled));
    let own = run.aimed.specifications.len() - run.aimed.design_limits.len();
    let limit_of = |margin: &SpecificationMargin| {
        let limit =
            margin.specification.checked_sub(own).and_then(|limit| run.aimed.design_limits.get(limit));
        limit.map_or(SearchedLimit::Specification(margin.specification), |kind| SearchedLimit::Design(*kind))
    };
    let leaves_no_room = |margin: &&SpecificationMargin| match project_design.options.objective {
        Objective::BestWorstMargin => true,
        Objective::LeastHighFrequencyGain | Objective::LeastBandwidth => {
            margin.margin_db <= project_design.options.reserve_db + BINDING_DB
        }
    };
    let has_prefilter = law.is_some_and(|law| !law.prefilter.stages.is_empty());
    let is_fitted =
        has_prefilter || !matches!(project_design.options.prefilter, PrefilterChoice::Grow { .. });
    let steps = match (project_design.designed.view.in_time.first(), &around) {
        (Some(finding), _) if is_chosen => finding.reached(),
        (Some(finding), Some(around)) if is_fitted => steps_of_members(around, &finding.requirement),
        _ => None,
    };
    Ok(ReachedStructure {
        steps,
        misses_on_rig: false,
        name: searched.name,
        no_pid: law.filter(|_| searched.name == Some(NamedStructure::Pid)).and_then(no_pid),
        order: searched.structure.order()?,
        relative_degree: searched.structure.relative_degree()?,
        is_chosen,
        slowest_zero_rad_per_s: searched.structure.slowest_zero_touched(&searched.free_numbers),
        structure: searched.structure.clone(),
        ending: searched.ending,
        binding: least.as_ref().filter(leaves_no_room).map(limit_of),
        least,
        nominal,
        high_frequency_gain_db,
        compared_db: searched.reached_db,
    })
}

/// Parts of a law that is not a PID of positive terms, such as a PI with a lag; `None` for one that
/// is.
fn no_pid(law: &Controller) -> Option<ManualLaw> {
    let law = ManualLaw::new(&law.feedback, Some(NamedStructure::Pid)).ok()?;
    let is_pid = |part: &ManualPart| matches!(part, ManualPart::ProportionalIntegralDerivative { .. });
    (!law.parts.iter().any(is_pid)).then_some(law)
}

/// Least margin to any limit by which a design is judged, found by its audit.
fn audited_least(project_design: &ProjectDesign) -> Option<SpecificationMargin> {
    let of_project = project_design.designed.view.audit.specifications.iter().map(|finding| (true, finding));
    let of_design = project_design.limit_findings.iter().map(|(kind, finding)| (!kind.is_led_to(), finding));
    let judged = of_project.chain(of_design).filter(|(is_judged, _)| *is_judged);
    let margins = judged.filter_map(|(_, finding)| finding.worst.as_ref());
    margins.min_by(|one, other| one.margin_db.total_cmp(&other.margin_db)).cloned()
}

/// Largest gain from the noise of the sensor to the command of the nominal loop, dB, by which
/// structures are compared for the least gain at high frequency.
///
/// ```text
/// 20 log10 max |G/(1 + L)|         over the frequencies of the search
/// ```
fn noise_gain_db(run: &DesignRun, project_design: &ProjectDesign) -> Option<f64> {
    if project_design.options.objective != Objective::LeastHighFrequencyGain {
        return None;
    }
    let frequencies = run.outcome.samples()?.frequencies_rad_per_s();
    noise_gain_around(&project_design.designed.problem, &frequencies)
}

/// True if a design reduces the compared quantity by enough to replace one with fewer poles.
pub(super) fn earns_its_poles(
    run: &DesignRun,
    longer: &ProjectDesign,
    shorter: &ProjectDesign,
) -> Result<bool, LinearError> {
    let ControllerChoice::Any { earned_per_pole_db, .. } = longer.options.controller else {
        return Ok(false);
    };
    let [own, other] = [longer, shorter].map(|one| one.design.structure.order());
    let further = own?.saturating_sub(other?).max(1) as f64;
    let gained_db =
        noise_gain_db(run, shorter).zip(noise_gain_db(run, longer)).map(|(one, other)| one - other);
    Ok(gained_db.is_some_and(|gained_db| gained_db >= earned_per_pole_db * further))
}

/// Largest such gain for the loop of a problem, dB, over these frequencies, rad/s.
pub(super) fn noise_gain_around(around: &RobustProblem, frequencies_rad_per_s: &[f64]) -> Option<f64> {
    let nominal = around.nominal().ok()??;
    let gain = |frequency: &f64| {
        let response = around.response(&nominal, *frequency)?;
        let open_loop = response.plant * response.sensor * response.controller;
        Some(portable::magnitude(response.controller / (1.0 + open_loop)))
    };
    frequencies_rad_per_s.iter().filter_map(gain).reduce(f64::max).map(decibels)
}

impl ProjectDesign {
    /// Records that a shorter structure was designed, and that a run of it on the nonlinear rig
    /// misses a requirement.
    pub(super) fn note_missed_on_rig(&mut self, shorter: &ProjectDesign) {
        let Some(own) = shorter.structures.iter().find(|one| one.is_chosen) else { return };
        let missed = ReachedStructure { is_chosen: false, misses_on_rig: true, ..own.clone() };
        let known = self.structures.iter_mut().find(|one| !one.is_chosen && one.structure == own.structure);
        if let Some(known) = known {
            *known = missed;
        }
    }

    /// The design with the structures that were searched only for less strict limits.
    pub(super) fn with_shorter(mut self, searched: Vec<ReachedStructure>) -> ProjectDesign {
        let is_same = |one: &ReachedStructure, other: &ReachedStructure| one.structure == other.structure;
        let mut all: Vec<ReachedStructure> = Vec::new();
        for one in searched {
            let own = self.structures.iter().find(|own| is_same(own, &one)).cloned();
            let one = own.unwrap_or(ReachedStructure { is_chosen: false, ..one });
            if !all.iter().any(|known| is_same(known, &one)) {
                all.push(one);
            }
        }
        self.structures = all;
        self
    }
}
