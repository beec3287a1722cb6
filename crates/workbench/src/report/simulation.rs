//! The chapter on the nonlinear machine: each scenario over time under each controller, and what is read off it beside what was wished,
//! published and measured.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, grouped, place, table, unbroken};
use super::driven::Driven;
use super::driving;
use crate::answer::significant;
use crate::document::{Mark, badge};
use crate::figure::Figure;
use crate::project::{Project, Scenario, Signal};
use crate::simulate::{
    ABSENT, Cause, Held, MEASURED, METRICS, Metrics, Named, ScenarioRun, SimulateError, Window, Wish,
    cause_words, cells_of, close_ups, coarse_sentence, headline, measured_cells, measured_together,
    occurrence_sentences, pictures, together,
};

/// Places of two metrics among all of them.
const OVERSHOOT: usize = 0;
const SETTLING: usize = 2;

/// The chapter.
pub(super) fn chapter(project: &Project, driven: &Driven) -> Chapter {
    let mut figures = Vec::new();
    let mut parts = Vec::new();
    for (index, declared) in project.scenarios.iter().enumerate() {
        let runs = driven.of_scenario(index);
        if runs.is_empty() {
            continue;
        }
        let drawn = drawn(&driven.drawn(index), index + 1, driven.wish.as_ref());
        parts.push(scenario(&runs, declared, driven.wish.as_ref(), &drawn));
        figures.extend(drawn);
    }
    let refused = driven.sides.iter().filter_map(|side| Some((side.name, side.runs.as_ref().err()?)));
    let body = html! {
        @for (name, error) in refused { (not_simulated(name, error, driven.sides.len())) }
        @if !parts.is_empty() {
            p { "The machine as a whole: spool with saturation, the flow of each edge, chambers that grow and shrink, friction as declared, load cell and load, under the controller as it is deployed. Peaks and settling times are those of the solution over each step of the integration, so that they do not depend on the rows of the table." }
        }
        @for part in &parts { (part) }
    };
    Chapter { anchor: "simulation", title: "Simulation of the nonlinear machine", body, figures }
}

/// The appendix: what happens inside the machine at each event, for each of several controllers.
pub(super) fn inside(project: &Project, driven: &Driven) -> Option<Chapter> {
    let scenarios = 0..project.scenarios.len();
    let several =
        scenarios.map(|index| (index, driven.of_scenario(index))).filter(|(_, runs)| runs.len() > 1);
    let figures: Vec<Figure> = several
        .flat_map(|(index, runs)| runs.into_iter().flat_map(move |named| close_ups(named, index + 1)))
        .collect();
    let body = html! {
        p { "What the figures of both controllers leave out: the spool beside the command, both chambers, and hydraulic beside measured force, between which lie the friction and the acceleration of the piston; in the order of Figure 6.17 of Ledezma (2019)." }
        @for figure in &figures { (place(figure)) }
    };
    let (anchor, title) = ("inside", "Inside the machine at each event");
    (!figures.is_empty()).then_some(Chapter { anchor, title, body, figures })
}

/// All controllers in one figure; of one alone, everything of it.
fn drawn(runs: &[Named<'_>], number: usize, wish: Option<&Wish>) -> Vec<Figure> {
    match runs {
        [alone] => pictures(alone.run, number),
        several => {
            let mut figures = together(several, number, wish);
            figures.extend(measured_together(several, number));
            figures
        }
    }
}

fn not_simulated(name: &str, error: &SimulateError, sides: usize) -> Markup {
    html! {
        div.callout.bad-edge {
            p { "Not simulated" @if sides > 1 { " with the " (name) " controller" } ": " (error) "." }
        }
    }
}

fn scenario(runs: &[Named<'_>], declared: &Scenario, wish: Option<&Wish>, figures: &[Figure]) -> Markup {
    let remarks = declared.reference.iter().filter_map(|step| step.published()?.remark.as_ref());
    let name = runs.first().map(|named| named.run.name.as_str()).unwrap_or_default();
    html! {
        h3 { (name) }
        @for named in runs { p { (of(named, runs)) (headline(named.run)) "." } }
        @for sentence in driving::sentences(declared) { p { (sentence) } }
        @for figure in figures { (place(figure)) }
        (metrics(runs, declared, wish))
        (measured(runs))
        @for remark in remarks { p { (remark) } }
        @for named in runs {
            @if let Some(sentence) = coarse_sentence(named.run) { p { (of(named, runs)) (sentence) "." } }
            @for sentence in occurrence_sentences(named.run) { p { (of(named, runs)) (sentence) "." } }
        }
    }
}

/// Whose run a sentence is about, where there are several.
fn of(named: &Named<'_>, runs: &[Named<'_>]) -> String {
    if runs.len() > 1 { format!("{}: ", capital(named.name)) } else { String::new() }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// What is read off each event: a row of each controller, beside what was published of it.
fn metrics(runs: &[Named<'_>], declared: &Scenario, wish: Option<&Wish>) -> Markup {
    let Some(first) = runs.first().map(|named| named.run) else { return html! {} };
    if first.windows.is_empty() {
        return html! {};
    }
    let told = told(runs.iter().flat_map(|named| &named.run.windows));
    let mut heads = vec!["event"];
    heads.extend(told.iter().map(|metric| METRICS[*metric]));
    let body = if runs.len() > 1 {
        let group = |(index, (window, _)): (usize, &(Window, Metrics))| {
            let row = |named: &Named<'_>| {
                let (_, metrics) = named.run.windows.get(index)?;
                Some(row(cell(named.name), &told, metrics, wish))
            };
            let mut rows: Vec<Vec<Markup>> = runs.iter().filter_map(row).collect();
            rows.extend(published_row(declared, window, &told));
            (cause_words(window), rows)
        };
        grouped(&heads, 1, &first.windows.iter().enumerate().map(group).collect::<Vec<_>>())
    } else {
        let rows = first.windows.iter().flat_map(|(window, metrics)| {
            let own = row(unbroken(&cause_words(window)), &told, metrics, wish);
            [Some(own), published_row(declared, window, &told)].into_iter().flatten()
        });
        table(&heads, 1, &rows.collect::<Vec<_>>())
    };
    html! {
        (body)
        p {
            "Settling is to " (first.settling_band_percent) " % of the step, or of the reference that a load motion disturbs; the steady-state error is reference less force, averaged over the last tenth of the window; the rise is from 10 to 90 % of the step."
            @if let Some(words) = wish.and_then(wished) { " Wished of every step: " (words) "; a disc with a tick keeps to it, a square with a cross does not." }
        }
    }
}

/// What was wished, in words.
fn wished(wish: &Wish) -> Option<String> {
    let words: Vec<String> = [wish.overshoot_words(), wish.settling_words()].into_iter().flatten().collect();
    (!words.is_empty()).then(|| words.join(", "))
}

/// A row of metrics, those that were wished something of with a mark.
fn row(name: Markup, told: &[usize], metrics: &Metrics, wish: Option<&Wish>) -> Vec<Markup> {
    let cells = cells_of(metrics);
    let held = |metric: usize| -> Option<Held> {
        match metric {
            OVERSHOOT => wish?.overshoot(metrics),
            SETTLING => wish?.settling(metrics),
            _ => None,
        }
    };
    let shown = |metric: &usize| {
        let text = cells[*metric].as_str();
        match held(*metric).and_then(|held| held.kept).map(Mark::of) {
            Some(mark) => badge(mark, text),
            None => cell(text),
        }
    };
    std::iter::once(name).chain(told.iter().map(shown)).collect()
}

fn published_row(declared: &Scenario, window: &Window, told: &[usize]) -> Option<Vec<Markup>> {
    let (source, cells) = published(declared, window)?;
    Some(std::iter::once(unbroken(source)).chain(told.iter().map(|metric| cell(&cells[*metric]))).collect())
}

/// The metrics that some of these windows can have.
pub(super) fn told<'a>(windows: impl Iterator<Item = &'a (Window, Metrics)>) -> Vec<usize> {
    let cells: Vec<[String; METRICS.len()]> = windows.map(|(_, metrics)| cells_of(metrics)).collect();
    (0..METRICS.len()).filter(|metric| cells.iter().any(|cells| cells[*metric] != ABSENT)).collect()
}

/// What was measured beside what each controller makes of the machine.
fn measured(runs: &[Named<'_>]) -> Markup {
    let several = runs.len() > 1;
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    let signals = runs.first().map_or(0, |named| named.run.measured.len());
    for index in 0..signals {
        for named in runs {
            let Some(overlay) = named.run.measured.get(index) else { continue };
            let mut row: Vec<Markup> = measured_cells(overlay).iter().map(cell).collect();
            if several {
                row.insert(2, cell(named.name));
            }
            rows.push(row);
        }
    }
    let mut heads = MEASURED.to_vec();
    if several {
        heads.insert(2, "simulated with");
    }
    html! {
        @if !rows.is_empty() {
            (table(&heads, if several { 3 } else { 2 }, &rows))
            p { "NRMSE is the root mean square of measured less simulated, over the range of what was measured." }
        }
    }
}

/// What was published of the step that begins this window, and where; `None` where that are no numbers.
fn published<'a>(declared: &'a Scenario, window: &Window) -> Option<(&'a str, [String; METRICS.len()])> {
    let begins = |step: &&Signal| matches!(step, Signal::Step { at, .. } if *at == window.start_s);
    let step = declared.reference.iter().find(begins)?;
    let published = step.published().filter(|_| matches!(window.cause, Cause::ReferenceStep { .. }))?;
    let overshoot = published.overshoot_percent.map(|percent| format!("{} %", significant(percent, 3)));
    let settling = published.settling_time.map(|time| format!("{} s", significant(time, 3)));
    if overshoot.is_none() && settling.is_none() {
        return None;
    }
    let cells = std::array::from_fn(|metric| {
        let known = match metric {
            OVERSHOOT => &overshoot,
            SETTLING => &settling,
            _ => &None,
        };
        known.clone().unwrap_or_else(|| ABSENT.to_string())
    });
    Some((published.source.as_deref().unwrap_or("published"), cells))
}

/// The worst of all steps of some runs beside a wish: `None` where there is none to judge.
pub(super) fn worst(
    runs: &[ScenarioRun],
    reached: impl Fn(&Metrics) -> Option<(f64, Held)>,
) -> Option<(Held, usize)> {
    let windows = runs.iter().flat_map(|run| &run.windows);
    let held: Vec<(f64, Held)> = windows.filter_map(|(_, metrics)| reached(metrics)).collect();
    let count = held.len();
    let worst = held.into_iter().max_by(|one, other| one.0.total_cmp(&other.0))?;
    Some((worst.1, count))
}
