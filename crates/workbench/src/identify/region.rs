//! Plant uncertainty that remains after identification: sentences, JSON, and a fragment of a
//! project file.

use std::collections::BTreeMap;

use phea_engineering::identify::{COVERAGE, Identification, JointRegion, JointRegionError};

use crate::answer::{Answer, Entries, OutputFile, significant};
use crate::document::{Cell, Document, Table};
use crate::project::UncertaintyDirection;
use crate::quantity::{DisplayUnit, print_bare};

/// The joint region of the coefficients, or the reason why there is none.
pub type FoundRegion = Result<JointRegion, JointRegionError>;

/// The chapter on the plant.
pub(crate) fn chapter(out: &mut Document, found: &Identification, region: &FoundRegion) {
    out.heading("What the recordings leave uncertain of the plant");
    let region = match region {
        Err(error) => return out.sentences([format!("No family is written: {error}.")]),
        Ok(region) => region,
    };
    out.sentences(sentences(found, region));
    if !region.directions.is_empty() {
        let rows =
            region.directions.iter().zip(&region.effects).map(|(direction, effect)| row(direction, *effect));
        out.table(Table::new(["direction", "moves K_qU and K_c by up to", "unit"]).with(rows));
    }
}

/// The sentences of the chapter.
fn sentences(found: &Identification, region: &JointRegion) -> Vec<String> {
    let half_width = significant(region.deviations, 3);
    let count = region.left_out + region.directions.len();
    let counted = match count {
        9 => "nine".to_string(),
        count => count.to_string(),
    };
    let mut all = vec![format!(
        "The {counted} coefficients that the plant depends on lie together in the family with {} %: each of their independent directions within {half_width} standard deviations.",
        significant(100.0 * COVERAGE, 2)
    )];
    let effect = significant(100.0 * region.effect_left_out, 2);
    all.push(match region.left_out {
        0 => "Every direction matters for K_qU and K_c.".to_string(),
        left_out if left_out == count => format!(
            "None of them matters: at their ends all of them together move K_qU and K_c by at most {effect} % at any operating point, so that the valve stays as identified."
        ),
        left_out => format!(
            "{left_out} of the {count} directions are left out: at their ends they move K_qU and K_c by at most {effect} % together at any operating point."
        ),
    });
    let states_accuracy = found.recordings.iter().any(|one| !one.accuracies.is_empty());
    let contents = match states_accuracy {
        true => {
            "This is the noise of the recordings and the stated `accuracy` of their columns. Errors of the other instruments, and what the valve's model leaves out, are not in it."
        }
        false => {
            "This is the noise of the recordings. What instruments measure wrongly all the time, and what the valve's model leaves out, is not in it."
        }
    };
    all.push(contents.to_string());
    all
}

fn row(direction: &UncertaintyDirection, effect: f64) -> [Cell; 3] {
    [Cell::Code(direction.name.clone()), Cell::number_in(effect, 2, DisplayUnit::PERCENT), Cell::unit("%")]
}

/// Family of valves that the recordings allow, as independent directions of the uncertainty.
#[derive(Answer)]
pub(super) struct JointRegionAnswer {
    /// Probability that the family contains the valve, from 0 to 1.
    coverage: f64,
    /// Standard deviations to either side of each direction; null without a region.
    deviations: Option<f64>,
    /// Directions of the family, the one with the greatest effect first.
    directions: Vec<RegionDirectionAnswer>,
    /// Number of directions that are omitted because their effect is small; null without a region.
    left_out: Option<usize>,
    /// Largest relative change of K_qU or K_c from the omitted directions together; null without a
    /// region.
    effect_left_out: Option<f64>,
    /// Reason for which there is no region.
    #[answer(optional)]
    reason: Option<String>,
}

/// Direction of the uncertainty of an identified valve.
#[derive(Answer)]
struct RegionDirectionAnswer {
    /// Name of the direction.
    name: String,
    /// Largest relative change of K_qU and K_c from the middle of the direction to an end.
    effect: f64,
    /// Change of each value of the project per standard deviation, in SI, by the path of its key.
    changes: Entries<f64>,
}

pub(super) fn joint_region_answer(region: &FoundRegion) -> JointRegionAnswer {
    let found = region.as_ref().ok();
    let directions = found.iter().flat_map(|region| region.directions.iter().zip(&region.effects));
    JointRegionAnswer {
        coverage: COVERAGE,
        deviations: found.map(|region| region.deviations),
        directions: directions.map(|(direction, effect)| region_direction(direction, *effect)).collect(),
        left_out: found.map(|region| region.left_out),
        effect_left_out: found.map(|region| region.effect_left_out),
        reason: region.as_ref().err().map(ToString::to_string),
    }
}

fn region_direction(direction: &UncertaintyDirection, effect: f64) -> RegionDirectionAnswer {
    let sorted: BTreeMap<String, f64> = direction.changes.numbers.iter().cloned().collect();
    RegionDirectionAnswer {
        name: direction.name.clone(),
        effect,
        changes: Entries(sorted.into_iter().collect()),
    }
}

/// The tables `[[uncertainty_direction]]` of a project.
pub(crate) fn file(found: &Identification, region: &JointRegion) -> OutputFile {
    let files: Vec<&str> = found.recordings.iter().map(|one| one.file.as_str()).collect();
    let mut text = format!(
        "# What {} leave uncertain of the valve, for the table [valve] of valve.toml.\n",
        files.join(", ")
    );
    for sentence in sentences(found, region) {
        text.push_str(&format!("# {sentence}\n"));
    }
    for (direction, effect) in region.directions.iter().zip(&region.effects) {
        text.push_str(&format!(
            "\n[[uncertainty_direction]]    # moves K_qU and K_c by up to {} %\nname = \"{}\"\ndeviations = {}\n\n[uncertainty_direction.changes]    # per standard deviation, SI\n",
            significant(100.0 * effect, 2),
            direction.name,
            rounded(direction.deviations, 4),
        ));
        for (path, change) in &direction.changes.numbers {
            text.push_str(&format!("\"{path}\" = {}\n", rounded(*change, 4)));
        }
    }
    OutputFile { name: "uncertainty.toml".to_string(), bytes: text.into_bytes() }
}

/// A number with this many significant digits as TOML writes it.
fn rounded(value: f64, digits: usize) -> String {
    print_bare(format!("{value:.*e}", digits - 1).parse().unwrap_or(value))
}
