//! The model that was chosen for lines without a stated one, for people.

use crate::answer::{hindrance_words, significant};
use crate::document::Document;
use crate::project::{ChosenLines, Loaded, ReachedBy};
use crate::quantity::{DisplayUnit, MotionKind};
use phea_engineering::line_choice::LUMPED_FROM;

/// Text above the answer of every command; empty if no model was chosen.
pub(crate) fn chosen_above(loaded: &Loaded) -> Document {
    let mut out = Document::default();
    if let Some(sentence) = sentence(loaded) {
        out.line(sentence);
        out.gap();
    }
    out
}

/// The model with the basis of its choice, and the key that states another; `None` if none was
/// chosen.
pub(crate) fn sentence(loaded: &Loaded) -> Option<String> {
    let lines = loaded.lines.as_ref()?;
    Some(chosen_words(lines, loaded.project.motion()))
}

fn chosen_words(lines: &ChosenLines, motion: MotionKind) -> String {
    let quarter_wave = frequency(lines.quarter_wave_rad_per_s);
    let factor = significant(LUMPED_FROM, 2);
    let of_reach = match &lines.reach {
        None => format!("no loop and no requirement comes near their quarter wave at {quarter_wave}"),
        Some((reached, ReachedBy::HighestBandwidth)) if is_quarter_wave(*reached, lines) => format!(
            "a design may use the whole band up to their quarter wave at {quarter_wave}, which limits it (`design.highest_bandwidth`)"
        ),
        Some((reached, by)) => {
            let side = if is_near(lines) { "within" } else { "beyond" };
            format!(
                "their quarter wave at {quarter_wave} is {side} {factor} times the {} of {}",
                frequency(*reached),
                by_words(by)
            )
        }
    };
    let stated = |model: &str| format!("`line.model = \"{model}\"` states it otherwise");
    match (&lines.obstacle, lines.with_waves) {
        (Some(obstacle), _) => {
            let reason = hindrance_words(obstacle, motion);
            format!("Lines: lumped, although {of_reach}: no model with waves is computed ({reason}).")
        }
        (None, true) => format!("Lines: with waves, since {of_reach}; {}.", stated("lumped")),
        (None, false) => format!("Lines: lumped, since {of_reach}; {}.", stated("transmission_line")),
    }
}

/// True if a frequency is the quarter wave itself, which limits a design by default.
fn is_quarter_wave(reached: f64, lines: &ChosenLines) -> bool {
    (reached / lines.quarter_wave_rad_per_s - 1.0).abs() < SAME
}

/// Relative difference below which two frequencies count as equal.
const SAME: f64 = 1e-9;

fn is_near(lines: &ChosenLines) -> bool {
    lines.with_waves || lines.obstacle.is_some()
}

fn frequency(rad_per_s: f64) -> String {
    format!("{} rad/s ({})", significant(rad_per_s, 3), DisplayUnit::HERTZ.text(rad_per_s, 3))
}

fn by_words(by: &ReachedBy) -> String {
    match by {
        ReachedBy::Crossover => "the last crossing of |L| = 1 in the given loop".to_string(),
        ReachedBy::RequiredTime(number) => {
            format!("the bandwidth that the times of [[specification]] {number} require")
        }
        ReachedBy::DesignFrequency(number) => {
            format!("the highest design frequency of [[specification]] {number}")
        }
        ReachedBy::HighestBandwidth => {
            "the highest bandwidth of a design (`design.highest_bandwidth`)".to_string()
        }
        ReachedBy::UnlimitedBandwidth => {
            "the bandwidth that valve, lines and sampling leave to a design without `design.highest_bandwidth`".to_string()
        }
    }
}
