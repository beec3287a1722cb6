//! The chapter on the linear loop with the given controller: step response, metrics, margins.

use phea_dynamics::frequency::Margins;
use phea_dynamics::time_response::{Settling, StepMetrics};
use phea_engineering::linear_loop::{LinearLoop, LoopStability, StepView};
use phea_engineering::setup::Setup;

use super::chapter::Chapter;
use crate::answer::significant;
use crate::document::{Document, StatusMark, Table};
use crate::figure::{Figure, SettlingBand, Words};
use crate::over_time::ForceStep;
use crate::quantity::{DisplayUnit, Units};

/// Height of the drawn step if the project's scenarios give none, N.
const REFERENCE: f64 = 1000.0;

pub(super) fn chapter(
    setup: &Setup<'_>,
    linear_loop: Option<&LinearLoop>,
    reference_n: Option<f64>,
) -> Chapter {
    let (anchor, title) = ("response", "Step response of the linear loop");
    let mut out = Document::default();
    let Some(linear_loop) = linear_loop else {
        out.explanation("The project gives no controller. What a designed one does stands in the chapter on the design; `phea report` of the `designed.toml` beside this page shows the step of its linear loop here.");
        return Chapter::of(anchor, title, out);
    };
    out.explanation("The nominal plant in a loop with the given controller and prefilter. One linear plant: this proves nothing for the others, or for the nonlinear simulation.");
    if setup.project.has_waves() {
        out.explanation("Its lines are lumped. The audit judges the loop with waves in them: its margins are those to rely on.");
    }
    out.left_out(setup);
    match &linear_loop.step {
        Ok(view) => {
            out.figures([figure(view, reference_n.unwrap_or(REFERENCE), setup.project.units)]);
            out.table(metrics(view));
        }
        Err(reason) => out.verdict(StatusMark::Bad, format!("No step response: {reason}"), vec![]),
    }
    out.heading("Margins");
    let (mark, stable) = match &linear_loop.stability {
        LoopStability::Stable => (Some(StatusMark::Good), "stable".to_string()),
        LoopStability::Unstable => (Some(StatusMark::Bad), "unstable".to_string()),
        LoopStability::Unknown(reason) => (None, format!("not judged here: {reason}")),
    };
    out.marked([(mark, format!("The closed loop is {stable}."))]);
    out.explanation("Near a lightly damped resonance the loop crosses a gain of one several times: each margin is the smallest of all crossings, and a negative phase margin there is no instability by itself.");
    out.table(margins(&linear_loop.margins));
    Chapter::of(anchor, title, out)
}

fn figure(view: &StepView, reference: f64, units: Units) -> Figure {
    let sized = |values: &[f64]| values.iter().map(|value| value * reference).collect::<Vec<f64>>();
    let band = view.metrics.settling_band_percent;
    let words = |time_s| format!("t_s({} %) = {} s", significant(band, 2), significant(time_s, 3));
    let shown = ForceStep {
        times_s: &view.times_s,
        reference: &vec![reference; view.times_s.len()],
        force: &sized(&view.response),
        filtered_reference: &sized(&view.filtered_reference),
        command: &sized(&view.command_v_per_n),
        units,
        settling_band: Some(SettlingBand { level: reference, percent: band }),
        settled: view.metrics.settling.time_s().map(|time_s| (time_s, words(time_s))),
    };
    let caption = format!(
        "A step of {}: {}, prefiltered reference and command.",
        units.force.text(reference, 3),
        units.motion.words().force
    );
    shown.chart().draw(&Words::new("step", "Step response", caption))
}

/// A settling time in words, with its band.
pub(super) fn settling_words(metrics: &StepMetrics) -> String {
    let band = significant(metrics.settling_band_percent, 2);
    match metrics.settling {
        Settling::Settled { time_s, .. } => format!("{} s (band {band} %)", significant(time_s, 3)),
        _ => format!("not settled within the time shown (band {band} %)"),
    }
}

fn metrics(view: &StepView) -> Table {
    let metrics = &view.metrics;
    let rise = metrics
        .rise_time_10_90_s
        .map_or("not reached".to_string(), |time| format!("{} s", significant(time, 3)));
    let rows = [
        ["overshoot".to_string(), format!("{} %", significant(metrics.overshoot_percent, 3))],
        ["settling time".to_string(), settling_words(metrics)],
        ["rise time, 10 to 90 %".to_string(), rise],
        [
            "peak".to_string(),
            format!(
                "{} of the reference at {} s",
                significant(metrics.peak_value, 4),
                significant(metrics.peak_time_s, 3)
            ),
        ],
    ];
    Table::new(["metric", "value"]).with(rows)
}

fn margins(margins: &Margins) -> Table {
    let at = |frequency: f64| format!("at {} rad/s", significant(frequency, 4));
    let gain = margins.gain_increase().map_or("infinite".to_string(), |margin| {
        format!("{} dB {}", significant(margin.db(), 3), at(margin.frequency_rad_per_s))
    });
    let reduction = margins.gain_decrease().map(|margin| {
        let text = format!("{} dB {}", significant(margin.db(), 3), at(margin.frequency_rad_per_s));
        ["gain reduction".to_string(), text]
    });
    let phase = margins.critical_phase().map_or("infinite".to_string(), |margin| {
        // Beyond a resonance it can be a phase lead that the loop does not tolerate; a bare minus
        // sign would suggest instability.
        let direction = if margin.phase_deg < 0.0 { "lead" } else { "lag" };
        let size = significant(margin.phase_deg.abs(), 3);
        format!("{size}° of {direction} {}", at(margin.frequency_rad_per_s))
    });
    let delay = margins.critical_delay().map_or("infinite".to_string(), |margin| {
        format!(
            "{} ms {}",
            DisplayUnit::MILLISECOND.number(margin.delay_s, 3),
            at(margin.frequency_rad_per_s)
        )
    });
    let modulus = &margins.modulus_margin;
    let rows = [
        ["gain margin".to_string(), gain],
        ["phase margin".to_string(), phase],
        [
            "modulus margin, least |1 + L|".to_string(),
            format!("{} {}", significant(modulus.distance, 3), at(modulus.frequency_rad_per_s)),
        ],
        ["delay margin".to_string(), delay],
    ];
    let [gain, others @ ..] = rows;
    Table::new(["margin", "value"]).with(std::iter::once(gain).chain(reduction).chain(others))
}
