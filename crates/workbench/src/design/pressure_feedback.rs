//! The pressure feedback that a design found before its loop.

use phea_engineering::design::{MissingPlants, PressureFeedbackDesign, ProjectDesign};

use crate::answer::significant;
use crate::document::Document;
use crate::error::design_error_words;
use crate::quantity::{ANGULAR_FREQUENCY, VOLTAGE_PER_PRESSURE, display};

/// The feedback with its gain in performance; empty if it was not free.
pub(crate) fn document(view: &ProjectDesign) -> Document {
    view.pressure_feedback.as_ref().map(pressure_feedback_document).unwrap_or_default()
}

/// A feedback that was found before the loop, with its gain in performance, for people.
pub fn pressure_feedback_document(found: &PressureFeedbackDesign) -> Document {
    let mut out = Document::default();
    out.heading("Pressure feedback, found before the loop");
    let factor = significant(found.loop_gain_factor, 3);
    let plants = match found.plants {
        1 => "the one plant".to_string(),
        count => format!("{count} plants"),
    };
    let missing = found.missing_with_waves.as_ref().map(missing);
    if !found.is_used {
        let none = format!(
            "none: the best would raise the gain that a proportional loop may have around {plants} to {factor} times, too little for a second measured signal"
        );
        out.sentences([none].into_iter().chain(missing));
        return out;
    }
    let corner = found.declared.high_pass.map_or(String::new(), |corner| {
        format!(" behind a high pass of {}", display(corner, &ANGULAR_FREQUENCY, 4))
    });
    let gain = display(found.declared.gain, &VOLTAGE_PER_PRESSURE, 4);
    let [without, with] =
        found.limited_at_rad_per_s.map(|frequency| display(frequency, &ANGULAR_FREQUENCY, 3));
    let mut sentences = vec![
        format!("{gain}{corner}"),
        format!(
            "with it a proportional loop around {plants} may have {factor} times the gain: it is limited at {with}, where that without is limited at {without}"
        ),
    ];
    if let Some([without, with]) = found.least_damping_ratio {
        sentences.push(format!(
            "the least damping ratio of an oscillation of these plants within a factor of two of that frequency is {}, without it {}",
            significant(with, 3),
            significant(without, 3)
        ));
    }
    sentences
        .push("at rest nothing passes the high pass: gain and stiffness are those of the rig".to_string());
    sentences.extend(missing);
    out.sentences(sentences);
    out
}

/// Plants that were left out, with the reason.
fn missing(plants: &MissingPlants) -> String {
    let MissingPlants { count, of, reason } = plants;
    let reason = design_error_words(reason);
    format!("it was found without {count} of {of} plants with waves in their lines: {reason}")
}
