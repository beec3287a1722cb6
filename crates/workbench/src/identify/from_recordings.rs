//! The valve of a project as identified from its recordings, in place of the declared one.
//!
//! ```text
//! project, recordings -> coefficients, family -> settings of the project -> the project, read again
//! ```
//!
//! Identified numbers pass through the reader like any other number of the project, so that every
//! condition between values is checked, and no later code has to handle two rigs.

use phea_dynamics::watch::Watch;

use super::misfit::declared_misfit;
use super::{
    COEFFICIENT_NAMES, Identification, JointRegion, JointRegionError, Known, RecordedFiles, SMALLEST_EFFECT,
    Search, identify, joint_region, recordings,
};
use crate::estimate::Estimate;
use crate::identify_error::IdentifyError;
use crate::project::{
    self, FromRecordings, HashedFile, IdentifiedFamily, IdentifiedNumber, IdentifiedUse, LEAKAGE_MODELS,
    Loaded, Origin, Project, RecordedTest, UncertaintyDirection, UnchangedNumber, UnchangedReason, sha256,
    word_of,
};
use crate::source::{Memory, Source};

/// Reason why the valve of a project is not taken from its recordings.
#[derive(Debug, thiserror::Error)]
pub enum ValveInUseError {
    /// Nothing was identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// The search for a valve stopped early.
    #[error(
        "the recordings lead to no valve: the search did not converge, so that they cannot take the place of [valve]; `phea identify` gives the details, and `--set identify.use=\"nothing\"` keeps the declared valve"
    )]
    NotConverged,
    /// Coefficients of the plant without an estimate.
    #[error(
        "the recordings do not determine {}, so that they cannot take the place of [valve]; `phea identify` gives the details, and `--set identify.use=\"nothing\"` keeps the declared valve",
        quoted(.0)
    )]
    NotDetermined(Vec<&'static str>),
    /// Directions from recordings and from the project.
    #[error(
        "`identify.use = \"valve_and_uncertainty\"` gives the directions of the family, and the project has tables [[uncertainty_direction]] too: remove one of the two"
    )]
    DirectionsTwice,
    /// The identified valve has no joint region.
    #[error(transparent)]
    Region(#[from] JointRegionError),
    /// A setting for an identified number.
    #[error(
        "a setting states `{0}`, which the recordings give: add `--set identify.use=\"nothing\"` to state it"
    )]
    StatedBySetting(String),
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The recordings that a project declares, each with its path as a source takes it.
pub fn recorded_files(project: &Project) -> Vec<RecordedTest> {
    let declared = project.identify.iter().flat_map(|identify| &identify.recordings);
    declared.map(|one| RecordedTest { file: project.path_of(&one.file), ..one.clone() }).collect()
}

/// The project with the valve identified from its recordings, if `identify.use` requires that;
/// `None` if it does not, or if the valve has already been identified.
///
/// The hash is that of the bytes of the project followed by those of each recording, so that
/// another recording is another project.
///
/// # Errors
/// [`ValveInUseError`] if files are rejected, if the recordings do not determine a coefficient on
/// which the plant depends, and if their result contradicts the project.
pub fn in_use(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Loaded>, ValveInUseError> {
    let takes = loaded.project.identify.as_ref().map(|identify| identify.takes).unwrap_or_default();
    if takes == IdentifiedUse::Nothing || loaded.recorded.is_some() {
        return Ok(None);
    }
    let files = recorded_files(&loaded.project);
    let known = Known::of(&loaded.project);
    let (held, hashes, sha256) = held(source, loaded, &files);
    let read: &dyn Source = if hashes.len() == files.len() { &held } else { source };
    let RecordedFiles { recordings, .. } = recordings(read, &files, &known).map_err(IdentifyError::Files)?;
    let found = identify(recordings, &known, Search::default(), watch)?;
    determined(&found)?;
    let region = match takes {
        IdentifiedUse::ValveAndUncertainty => Some(region(&found, &loaded.project)?),
        IdentifiedUse::Valve | IdentifiedUse::Nothing => None,
    };
    let (numbers, unchanged) = numbers(&found, &loaded.project);
    let mut settings = settings(&found, &numbers, region.as_ref());
    settings.extend(without(&found, &loaded.project));
    let stated = loaded.project.design.as_ref().and_then(|design| design.reserve);
    settings.extend(region.as_ref().filter(|_| stated.is_none()).map(reserve));
    let family = region.map(|region| IdentifiedFamily {
        effects: region.effects,
        left_out: region.left_out,
        effect_left_out: region.effect_left_out,
        deviations: region.deviations,
    });
    let project_sha256 = loaded.sha256.clone();
    let drop = found.tested.tare_reference_drop;
    let declared = loaded.project.actuator.as_ref();
    let tare_pressures = [drop, declared.map_or(drop, |one| one.valve.tare_drop(&one.supply))];
    let files = hashes;
    let recorded =
        FromRecordings { project_sha256, files, numbers, unchanged, tare_pressures, family, settings };
    Ok(Some(Loaded { sha256, ..read_again(source, loaded, recorded)? }))
}

/// The files in memory, so that the bytes that are hashed are the bytes that are read; the hash of
/// each, and of the project followed by all of them.
fn held(source: &dyn Source, loaded: &Loaded, files: &[RecordedTest]) -> (Memory, Vec<HashedFile>, String) {
    let mut memory = Memory::default();
    let mut together = loaded.bytes.clone();
    let mut hashes = Vec::new();
    let named = loaded.project.identify.iter().flat_map(|identify| &identify.recordings);
    for (RecordedTest { file, .. }, named) in files.iter().zip(named) {
        // a file that cannot be read is reported by the reader of tables
        let Ok(bytes) = source.read(file) else { continue };
        hashes.push(HashedFile { path: named.file.clone(), sha256: sha256(&bytes) });
        together.extend_from_slice(&bytes);
        memory = memory.with(file, bytes);
    }
    (memory, hashes, sha256(&together))
}

/// A fit that did not converge, or that did not determine a coefficient of the plant, gives no
/// valve: the other coefficients were fitted together with the missing one.
fn determined(found: &Identification) -> Result<(), ValveInUseError> {
    if !found.has_converged() {
        return Err(ValveInUseError::NotConverged);
    }
    let plant = found.of_plant().filter_map(|index| {
        Some((COEFFICIENT_NAMES.get(index)?.0, found.estimates.get(index).copied().flatten()))
    });
    let open: Vec<&'static str> = plant
        .filter(|(name, estimate)| estimate.is_none() || found.at_bounds.contains(name))
        .map(|(name, _)| name)
        .collect();
    if open.is_empty() { Ok(()) } else { Err(ValveInUseError::NotDetermined(open)) }
}

fn region(found: &Identification, project: &Project) -> Result<JointRegion, ValveInUseError> {
    if !project.directions.is_empty() {
        return Err(ValveInUseError::DirectionsTwice);
    }
    Ok(joint_region(found, project, SMALLEST_EFFECT)?)
}

/// Numbers that replace declared ones, and numbers that remain as declared.
fn numbers(found: &Identification, project: &Project) -> (Vec<IdentifiedNumber>, Vec<UnchangedNumber>) {
    let (mut numbers, mut unchanged) = (Vec::new(), Vec::new());
    let of = |index: usize| Some((*COEFFICIENT_NAMES.get(index)?, *found.estimates.get(index)?));
    for ((name, unit), estimate) in found.in_model().filter_map(of) {
        let path = found.path(name);
        match estimate {
            None => unchanged.push(UnchangedNumber { path, reason: UnchangedReason::NotIdentifiable }),
            Some(Estimate { interval: [low, _], .. }) if name == "hysteresis" && low == 0.0 => {
                unchanged.push(UnchangedNumber { path, reason: UnchangedReason::MayVanish });
            }
            Some(Estimate { value, interval }) => {
                let declared = project.number(&path);
                numbers.push(IdentifiedNumber { path, unit, value, interval, declared });
            }
        }
    }
    (numbers, unchanged)
}

/// Identified numbers as `path=value`.
fn settings(
    found: &Identification,
    numbers: &[IdentifiedNumber],
    region: Option<&JointRegion>,
) -> Vec<String> {
    let model = word_of(&LEAKAGE_MODELS, &found.tested.leakage_model);
    // edges may be declared as a list of four, inside which no name can be set
    let tables =
        ["valve.flow_coefficients", "valve.leakage_coefficients", "valve.leakage_shapes", "valve.lap"];
    let edge = |one: &IdentifiedNumber, table: &str| {
        let edge = one.path.strip_prefix(table)?.strip_prefix('.')?;
        Some(format!("{edge} = {:e}", one.value))
    };
    let mut settings: Vec<String> = tables
        .iter()
        .filter_map(|table| {
            let edges: Vec<String> = numbers.iter().filter_map(|one| edge(one, table)).collect();
            (!edges.is_empty()).then(|| format!("{table}={{ {} }}", edges.join(", ")))
        })
        .collect();
    let others = numbers.iter().filter(|one| tables.iter().all(|table| edge(one, table).is_none()));
    settings.extend(others.map(|one| format!("{}={:e}", one.path, one.value)));
    settings.push(format!("valve.leakage_model={model}"));
    settings.push(format!("valve.tare_pressure={:e}", found.tested.tare_reference_drop));
    let misfit = declared_misfit(found);
    settings.extend(misfit.map(|one| format!("valve.misfit={}", one.in_toml())));
    let directions: Vec<String> =
        region.iter().flat_map(|region| &region.directions).map(direction).collect();
    if !directions.is_empty() {
        settings.push(format!("uncertainty_direction=[{}]", directions.join(", ")));
    }
    settings
}

/// Settings that remove those declared terms of the valve that were absent from the identification.
fn without(found: &Identification, project: &Project) -> Vec<String> {
    let terms = found.tested.terms;
    let declares = |path: &str| project.number(path).is_some_and(|number| number != 0.0);
    let mut settings = Vec::new();
    if !terms.lap && (declares("valve.lap.positive") || declares("valve.lap.negative")) {
        settings.push("valve.lap={ positive = 0, negative = 0 }".to_string());
    }
    if !terms.saturation && declares("valve.saturation") {
        settings.push("valve.saturation=0".to_string());
    }
    if !terms.leakage_by_edge && project.number("valve.leakage_shapes.supply_to_a").is_some() {
        let shape = found.coefficients.leakage_shapes.supply_to_a;
        settings.push(format!("valve.leakage_shapes=[{shape:e}, {shape:e}, {shape:e}, {shape:e}]"));
    }
    settings
}

/// The design margin for the change that another recording of the same valve may cause: its plants
/// have other gains, and a closed loop changes by no more where a limit on it binds.
fn reserve(region: &JointRegion) -> String {
    format!("design.reserve={:e}", 1.0 + region.change_left_out)
}

/// A direction as an inline table.
fn direction(direction: &UncertaintyDirection) -> String {
    let UncertaintyDirection { name, deviations, points, changes } = direction;
    let changes: Vec<String> =
        changes.numbers.iter().map(|(path, change)| format!("\"{path}\" = {change:e}")).collect();
    let changes = changes.join(", ");
    format!(
        "{{ name = \"{name}\", deviations = {deviations:e}, points = {points}, changes = {{ {changes} }} }}"
    )
}

/// The project with the identified values; a setting of the user must not contradict them.
fn read_again(
    source: &dyn Source,
    loaded: &Loaded,
    recorded: FromRecordings,
) -> Result<Loaded, ValveInUseError> {
    let all: Vec<String> = recorded.settings.iter().chain(&loaded.settings).cloned().collect();
    let mut again = project::read(source, &loaded.path, &all, &loaded.catalogues)
        .map_err(|report| IdentifyError::Files(Box::new(report)))?;
    let other = recorded.numbers.iter().find(|one| again.project.number(&one.path) != Some(one.value));
    if let Some(one) = other {
        return Err(ValveInUseError::StatedBySetting(one.path.clone()));
    }
    for entry in &mut again.provenance {
        if recorded.numbers.iter().any(|one| one.path == entry.path) {
            entry.origin = Origin::Recordings;
        }
    }
    let settings = loaded.settings.clone();
    Ok(Loaded { settings, recorded: Some(recorded), ..again })
}
