//! What recordings gave in place of what a project declares, for programs.

use phea_engineering::identify::COVERAGE;

use super::Answer;
use super::words::words;
use crate::project::{FromRecordings, UnchangedReason};

/// Values identified from the recordings of a project, which replace those of its file.
#[derive(Answer)]
pub(crate) struct RecordedAnswer {
    /// SHA-256 of the bytes of the project file.
    project_file_sha256: String,
    /// Recordings in the order of the project.
    files: Vec<RecordedFileAnswer>,
    /// Identified values.
    values: Vec<IdentifiedValueAnswer>,
    /// Values that remain as declared.
    unchanged: Vec<UnchangedValueAnswer>,
    /// Pressure drop from supply to tank at which the tare flow was recorded.
    tare_pressure_pa: f64,
    /// Pressure drop from supply to tank at which the tare flow is declared.
    declared_tare_pressure_pa: f64,
    /// Remaining uncertainty as directions of the family, if in use.
    #[answer(optional)]
    family: Option<RecordedFamilyAnswer>,
}

/// Recording by its bytes.
#[derive(Answer)]
struct RecordedFileAnswer {
    /// Path as in the project.
    file: String,
    /// SHA-256 of the bytes.
    sha256: String,
}

/// Value identified from recordings, in `unit`.
#[derive(Answer)]
struct IdentifiedValueAnswer {
    /// Key of the project file.
    path: String,
    /// Identified value.
    value: f64,
    /// SI unit of the values.
    unit: &'static str,
    /// Confidence interval of 95 %, from low to high.
    #[answer(interval)]
    confidence_95: [f64; 2],
    /// Value of the project file; null if it has none.
    declared: Option<f64>,
}

/// Value that remains as declared.
#[derive(Answer)]
struct UnchangedValueAnswer {
    /// Key of the project file.
    path: String,
    /// Reason for which it is not replaced.
    reason: UnchangedReason,
}

words! {
    /// Reason for which a declared value is not replaced by an identified one.
    UnchangedReason by unchanged_because [NotIdentifiable, MayVanish]
}

/// Remaining uncertainty of what was identified, as directions of the family.
#[derive(Answer)]
struct RecordedFamilyAnswer {
    /// Probability that the truth is in the family, from 0 to 1.
    coverage: f64,
    /// Standard deviations to either side of each direction.
    deviations: f64,
    /// Largest relative change of K_qU and K_c along each direction, from its middle to an end.
    effects: Vec<f64>,
    /// Number of directions that are omitted because their effect is small.
    left_out: usize,
    /// Largest relative change of K_qU or K_c from the omitted directions together.
    effect_left_out: f64,
}

/// The files, what is from them, what stays as declared, and the family.
pub(crate) fn body_in_use(recorded: &FromRecordings) -> RecordedAnswer {
    let files = recorded.files.iter();
    let values = recorded.numbers.iter();
    let unchanged = recorded.unchanged.iter();
    let [tare_pressure_pa, declared_tare_pressure_pa] = recorded.tare_pressures;
    RecordedAnswer {
        project_file_sha256: recorded.project_sha256.clone(),
        files: files
            .map(|file| RecordedFileAnswer { file: file.path.clone(), sha256: file.sha256.clone() })
            .collect(),
        values: values
            .map(|one| IdentifiedValueAnswer {
                path: one.path.clone(),
                value: one.value,
                unit: one.unit,
                confidence_95: one.interval,
                declared: one.declared,
            })
            .collect(),
        unchanged: unchanged
            .map(|one| UnchangedValueAnswer { path: one.path.clone(), reason: one.reason })
            .collect(),
        tare_pressure_pa,
        declared_tare_pressure_pa,
        family: recorded.family.as_ref().map(|family| RecordedFamilyAnswer {
            coverage: COVERAGE,
            deviations: family.deviations,
            effects: family.effects.clone(),
            left_out: family.left_out,
            effect_left_out: family.effect_left_out,
        }),
    }
}

/// Reason for which a number stays as declared.
pub(crate) fn unchanged_because(reason: UnchangedReason) -> &'static str {
    match reason {
        UnchangedReason::NotIdentifiable => "the recordings do not determine it",
        UnchangedReason::MayVanish => "the recordings cannot distinguish it from zero",
    }
}
