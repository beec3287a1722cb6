//! Every step of the reference that the report has of one controller, compared with its requirement
//! in time: the scenarios, the machines of the trial, the linear steps over the family, and the
//! runs of the campaign.

use std::collections::BTreeSet;

use phea_dynamics::time_response::{StepBaseline, step_metrics};

use super::side::Side;
use crate::answer::significant;
use crate::audit::{TimeOutcome, WorstStep};
use crate::plant_names::{plant_text, plant_words};
use crate::simulate::{Metrics, ReachedStep, StepLimits, TimeRequirement, Unmeasured, cause_words, concerns};
use crate::trial::{Trial, TrialRun, have_one_name, run_name};

/// Property of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepProperty {
    /// Overshoot, percent of the step.
    Overshoot,
    /// Settling time, s; infinite if the step does not settle.
    Settling,
    /// Rise time from 10 to 90 percent, s; infinite if the step does not rise that far.
    Rise,
}

impl StepProperty {
    /// Every property.
    pub(super) const ALL: [StepProperty; 3] =
        [StepProperty::Overshoot, StepProperty::Settling, StepProperty::Rise];
}

/// Origin of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StepOrigin {
    Scenario,
    Machine,
    Family,
    Campaign,
}

/// The property of one step.
struct OneStep {
    origin: StepOrigin,
    value: f64,
    place: String,
}

/// A property of all steps.
pub(super) struct AllSteps {
    property: StepProperty,
    most: f64,
    steps: Vec<OneStep>,
    /// Number of plants of the family whose linear steps were computed; the worst one is among the
    /// steps.
    plants: usize,
}

/// Words for a step that does not settle, and for one that does not rise to 90 percent.
pub(super) const NEVER_SETTLED: &str = "not settled";
pub(super) const NEVER_RISEN: &str = "not risen to 90 %";
/// Tolerance relative to the required value: printed numbers have three digits.
const ROUNDED: f64 = 1e-6;
/// Deviation of a linear step that counts as none, percent.
const ACCURACY_PERCENT: f64 = 0.01;

/// Every step of a controller that a requirement is about; `None` if the property is not required
/// or no step has it.
pub(super) fn steps(side: &Side<'_>, required: &TimeRequirement, property: StepProperty) -> Option<AllSteps> {
    let requirement = &required.step_limits;
    let most = match property {
        StepProperty::Overshoot => requirement.overshoot_percent?,
        StepProperty::Settling => requirement.settling_time_s?,
        StepProperty::Rise => requirement.rise_time_s?,
    };
    let mut steps: Vec<OneStep> = Vec::new();
    for run in side.runs.into_iter().flatten() {
        let of = |(window, metrics)| {
            let value = of_window(metrics, requirement, property)?;
            let place = format!("{}, {}", run.name, cause_words(window, run.record.units));
            Some(OneStep { origin: StepOrigin::Scenario, value, place })
        };
        let windows = run.windows.iter().map(|(window, metrics)| (window, metrics));
        steps.extend(windows.filter(|(window, _)| concerns(required, window)).filter_map(of));
    }
    // a requirement with its own step applies to no other
    let is_about = |run: &TrialRun| {
        let mut numbers = run.requirements.iter().map(|held| held.number);
        !required.steps.are_stated() || numbers.any(|number| number == required.number)
    };
    // the worst of the corners and of the plants inside the box are among the runs already
    let is_corner = |trial: &Trial, run: &TrialRun| trial.corners.iter().any(|one| have_one_name(one, run));
    let runs = side.trial.iter().flat_map(|trial| {
        let own = trial.runs.iter().filter(|run| !is_corner(trial, run)).map(|run| (run, run_name(run)));
        own.chain(trial.corners.iter().map(|run| (run, corner_words(run))))
    });
    let runs = runs.filter(|(run, _)| is_about(run));
    steps.extend(runs.filter_map(|(run, place)| {
        let reached = held(run, required).map(|reached| match property {
            StepProperty::Overshoot => reached.overshoot_percent,
            StepProperty::Settling => reached.settling_time_s,
            StepProperty::Rise => reached.rise_time_s,
        });
        let value = reached.or_else(|| of_machine(run, requirement, property))?;
        Some(OneStep { origin: StepOrigin::Machine, value, place })
    }));
    let (linear, plants) = of_family(side, required.number, property);
    steps.extend(linear);
    let campaign = side.campaign.iter().filter(|step| concerns(required, &step.window));
    steps.extend(campaign.filter_map(|step| {
        let value = match property {
            StepProperty::Overshoot => step.overshoot_percent?,
            StepProperty::Settling if step.band_percent == requirement.band_percent => step.settling_time_s,
            StepProperty::Settling => return None,
            StepProperty::Rise => step.rise_time_s,
        };
        Some(OneStep { origin: StepOrigin::Campaign, value, place: format!("campaign, run {}", step.run) })
    }));
    (!steps.is_empty()).then_some(AllSteps { property, most, steps, plants })
}

/// A corner of the box, or a plant inside it, by its parameters.
fn corner_words(run: &TrialRun) -> String {
    match &run.plant {
        Some(plant) => format!("nonlinear simulation at {}", plant_words(plant)),
        None => run_name(run),
    }
}

/// Values that the steps of a completed run reach for a requirement; `None` if they were not
/// compared with it.
fn held<'r>(run: &'r TrialRun, required: &TimeRequirement) -> Option<&'r ReachedStep> {
    let held = run.requirements.iter().find(|held| held.number == required.number)?;
    Some(&held.reached).filter(|reached| reached.overshoot_percent.is_finite())
}

fn of_window(metrics: &Metrics, requirement: &StepLimits, property: StepProperty) -> Option<f64> {
    let overshoot = metrics.overshoot_percent.ok()?;
    match property {
        StepProperty::Overshoot => Some(overshoot),
        StepProperty::Rise => Some(metrics.rise_time_s.unwrap_or(f64::INFINITY)),
        StepProperty::Settling if metrics.settling_band_percent != requirement.band_percent => None,
        StepProperty::Settling => match metrics.settling_time_s {
            Ok(time_s) => Some(time_s),
            Err(Unmeasured::NotSettled) => Some(f64::INFINITY),
            Err(_) => None,
        },
    }
}

fn of_machine(run: &TrialRun, requirement: &StepLimits, property: StepProperty) -> Option<f64> {
    let response = &run.machine_response;
    let metrics =
        step_metrics(&response.times_s, &response.values, StepBaseline::unit(), requirement.band_percent)
            .ok()?;
    Some(match property {
        // overshoot of the solution itself, where it is known
        StepProperty::Overshoot => {
            let known = run.machine.as_ref().and_then(|step| step.overshoot_percent);
            known.unwrap_or(metrics.overshoot_percent)
        }
        StepProperty::Settling => metrics.settling.time_s().unwrap_or(f64::INFINITY),
        StepProperty::Rise => metrics.rise_time_10_90_s.unwrap_or(f64::INFINITY),
    })
}

/// The worst linear step of the family, and the number of steps.
fn of_family(side: &Side<'_>, number: usize, property: StepProperty) -> (Option<OneStep>, usize) {
    let Some(view) = side.view else { return (None, 0) };
    let own = view.in_time.iter().find(|finding| finding.requirement.number == number);
    let Some(TimeOutcome::Searched { plants, overshoot, settling, rise }) =
        own.map(|finding| &finding.outcome)
    else {
        return (None, 0);
    };
    let worst = match property {
        StepProperty::Overshoot => overshoot,
        StepProperty::Settling => settling,
        StepProperty::Rise => rise,
    };
    let one = |worst: &WorstStep| {
        let plant = match view.names.headings().len() {
            0 => String::new(),
            1 | 2 => format!(", {}", plant_text(&view.names, &worst.plant)),
            _ => String::new(),
        };
        OneStep { origin: StepOrigin::Family, value: worst.value, place: format!("linear loop{plant}") }
    };
    (worst.as_ref().map(one), *plants)
}

impl AllSteps {
    fn is_above(&self, step: &OneStep) -> bool {
        let accuracy = match (step.origin, self.property) {
            (StepOrigin::Family, StepProperty::Overshoot) => ACCURACY_PERCENT,
            _ => ROUNDED * self.most.max(1.0),
        };
        step.value > self.most + accuracy
    }

    /// True if all steps satisfy the requirement.
    pub(super) fn all_satisfied(&self) -> bool {
        !self.steps.iter().any(|step| self.is_above(step))
    }

    /// The worst value of all, with its unit.
    pub(super) fn worst_words(&self) -> String {
        let Some(worst) = self.worst() else { return String::new() };
        self.value_words(worst)
    }

    /// The value of a step in words; a simulated value is known over its window only.
    fn value_words(&self, step: &OneStep) -> String {
        let value = step.value;
        let within = if step.origin == StepOrigin::Family { "" } else { " within its window" };
        match self.property {
            StepProperty::Overshoot if value < 0.01 => "no overshoot".to_string(),
            StepProperty::Overshoot => format!("{} %", significant(value, 3)),
            StepProperty::Settling if value == f64::INFINITY => format!("{NEVER_SETTLED}{within}"),
            StepProperty::Rise if value == f64::INFINITY => format!("{NEVER_RISEN}{within}"),
            StepProperty::Settling | StepProperty::Rise => format!("{} s", significant(value, 3)),
        }
    }

    fn worst(&self) -> Option<&OneStep> {
        self.steps.iter().max_by(|one, other| one.value.total_cmp(&other.value))
    }

    /// The worst value with its place, and the number and kinds of steps above the requirement.
    pub(super) fn words(&self) -> String {
        let Some(worst) = self.worst() else { return String::new() };
        let value = self.value_words(worst);
        let mut words = vec![format!("{value} at worst ({})", worst.place)];
        let counts = [
            (StepOrigin::Scenario, "scenario steps"),
            (StepOrigin::Machine, "nonlinear trials"),
            (StepOrigin::Campaign, "completed campaign runs"),
        ];
        for (origin, what) in counts {
            let own = || self.steps.iter().filter(|step| step.origin == origin);
            let (count, above) = match origin {
                // a run has several steps, and misses the requirement in one of them
                StepOrigin::Campaign => {
                    let runs = |all: &mut dyn Iterator<Item = &OneStep>| -> usize {
                        all.map(|step| step.place.as_str()).collect::<BTreeSet<_>>().len()
                    };
                    (runs(&mut own()), runs(&mut own().filter(|step| self.is_above(step))))
                }
                _ => (own().count(), own().filter(|step| self.is_above(step)).count()),
            };
            if above > 0 && count > 1 {
                let percent = significant(100.0 * above as f64 / count as f64, 2);
                words.push(match origin {
                    StepOrigin::Campaign => format!("missed by {percent} % of {count} {what}"),
                    _ => format!("missed by {above} of {count} {what}"),
                });
            }
        }
        let family = |step: &&OneStep| step.origin == StepOrigin::Family && !std::ptr::eq(*step, worst);
        if self.steps.iter().filter(family).any(|step| self.is_above(step)) {
            words.push("missed by linear steps of the family".to_string());
        }
        words.join("; ")
    }

    /// The number of steps that are counted, and their kinds.
    pub(super) fn counted(&self) -> String {
        let origins = [
            (StepOrigin::Family, "linear"),
            (StepOrigin::Machine, "on the nonlinear rig and its plants"),
            (StepOrigin::Scenario, "of the scenarios"),
            (StepOrigin::Campaign, "of the campaign"),
        ];
        let count = |origin: StepOrigin| match origin {
            // the worst plant of the family represents all of its plants
            StepOrigin::Family => self.plants,
            _ => self.steps.iter().filter(|step| step.origin == origin).count(),
        };
        let counts = origins.map(|(origin, which)| (count(origin), which));
        let words = counts.iter().filter(|(count, _)| *count > 0);
        let words: Vec<String> = words.map(|(count, which)| format!("{count} {which}")).collect();
        match counts.iter().map(|(count, _)| count).sum::<usize>() {
            1 => "the step".to_string(),
            count => format!("all {count} steps ({})", words.join(", ")),
        }
    }
}
