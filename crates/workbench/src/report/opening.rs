//! The first page: the specifications, the verdicts on the given and the designed controller, the
//! main numbers, force over time, the loop in its Nichols chart, and the next steps.

mod next;
mod side;
mod steps;
mod verdicts;

use phea_qft::verification::Verdict;

use super::campaign::CampaignStep;
use super::chapter::Chapter;
use super::driven::{DESIGNED, GIVEN, MachineChapter};
use super::judged::Judged;
use super::{Facts, NOMINAL_LOOP};
use crate::answer::Answer;
use crate::design::explanation_words;
use crate::document::{Document, StatusMark};
use crate::figure::Figure;
use crate::setup::Setup;
use crate::simulate::at_a_glance;
use crate::trial::Agreement;
use next::next_steps;
use side::{Side, sides};

/// The content of the page.
pub(super) struct Contents<'a> {
    pub(super) setup: &'a Setup<'a>,
    pub(super) judged: Option<&'a Judged>,
    pub(super) driven: Option<&'a MachineChapter>,
    /// Facts on the rig and its load, shown as cards.
    pub(super) facts: &'a Facts,
    /// Facts on simulations and campaigns, shown as wider cards.
    pub(super) results: &'a Facts,
    /// The steps of the reference in the campaign, under the given controller.
    pub(super) campaign: &'a [CampaignStep],
    /// True if a hose was required and none fits.
    pub(super) no_hose_fits: bool,
}

/// Controllers compared with the requirements, and the next steps.
#[derive(Answer, Clone, Debug, Default, PartialEq)]
pub struct DecisionAnswer {
    /// Controller that the project gives, if it gives one.
    #[answer(optional)]
    pub given: Option<DecidedAnswer>,
    /// Designed controller, if a design was requested.
    #[answer(optional)]
    pub designed: Option<DecidedAnswer>,
    /// Next steps, a sentence each.
    pub next: Vec<String>,
}

/// Results of one controller.
#[derive(Answer, Clone, Debug, Default, PartialEq)]
pub struct DecidedAnswer {
    /// Verdict over the family, if an audit was requested.
    #[answer(optional)]
    pub verdict: Option<Verdict>,
    /// Verdict on each specification in the order of the file, if there are any.
    #[answer(optional)]
    pub specifications: Option<Vec<Verdict>>,
    /// True if the verdict is proven for every plant and every frequency; left out if no proof was
    /// attempted.
    #[answer(optional)]
    pub proven: Option<bool>,
    /// Agreement of the nonlinear machine with the verdict, if it was simulated.
    #[answer(optional)]
    pub machine: Option<Agreement>,
    /// True if every step on the machine satisfies the requirements in time, if there are any.
    #[answer(optional)]
    pub requirements_satisfied: Option<bool>,
}

/// The page as the first chapter, and its content for programs.
pub(super) fn opening(contents: &Contents<'_>, nichols: Option<Figure>) -> (Chapter, DecisionAnswer) {
    let sides = sides(contents.judged, contents.driven, contents.campaign);
    let next = next_steps(contents, &sides);
    let mut figures: Vec<Figure> = contents.driven.and_then(over_time).into_iter().collect();
    figures.extend(nichols);
    let mut out = Document::default();
    out.cards(carded(contents.facts), false);
    out.cards(carded(contents.results), true);
    out.requests(verdicts::table(contents, &sides));
    out.callouts(StatusMark::Bad, hindrances(contents));
    let mut steps = Document::default();
    steps.steps("What to do next", next.clone());
    let mut pair = Document::default();
    let count = figures.len();
    pair.figures(figures);
    match count {
        0 => out.append(steps),
        // placed next to a figure that has no partner
        1 => {
            pair.append(steps);
            out.side_by_side(pair);
        }
        _ => {
            out.side_by_side(pair);
            out.append(steps);
        }
    }
    let decided =
        |name: &str| sides.iter().find(|side| side.name == name).map(|side| decided(contents, side));
    let decision = DecisionAnswer { given: decided(GIVEN), designed: decided(DESIGNED), next };
    (Chapter::of("decision", "What was required, and the result", out), decision)
}

/// The first scenario that is drawn, of both controllers.
fn over_time(driven: &MachineChapter) -> Option<Figure> {
    let first = driven.drawn(0);
    at_a_glance("opening_force", &first, driven.requirement_of(0))
}

fn decided(contents: &Contents<'_>, side: &Side<'_>) -> DecidedAnswer {
    let findings = side.view.map(|view| view.audit.specifications.as_slice()).unwrap_or_default();
    let required = contents.driven.and_then(|driven| driven.required.as_ref());
    let verdicts: Vec<Verdict> = findings.iter().map(|finding| finding.verdict).collect();
    DecidedAnswer {
        verdict: side.view.map(|view| view.verdict()),
        specifications: Some(verdicts).filter(|all| !all.is_empty()),
        proven: side.is_proven(),
        machine: side.trial.map(|trial| trial.agreement()),
        requirements_satisfied: required.and_then(|required| side.satisfies(required)),
    }
}

/// Obstacles to any controller, stated first.
fn hindrances(contents: &Contents<'_>) -> Vec<String> {
    let found = contents.judged.and_then(Judged::found);
    let explained = found.into_iter().flat_map(|view| view.explanations.iter().map(move |one| (view, one)));
    let explained = explained.filter(|(_, explanation)| explanation.is_impossible);
    explained.map(|(view, explanation)| explanation_words(view, explanation)).take(2).collect()
}

/// The facts that are shown on cards.
fn carded(facts: &Facts) -> Vec<(String, String)> {
    let shown = facts.iter().filter(|(name, _)| *name != NOMINAL_LOOP);
    shown.map(|(name, words)| (name.to_string(), words.clone())).collect()
}
