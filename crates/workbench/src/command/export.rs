//! `export`: the controller as it was verified, as source for its computer.

use phea_dynamics::watch::Watch;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::deployed::deployed;
use phea_engineering::setup::Setup;
use phea_machine::Deployed;
use phea_qft::verification::{Evidence, Verdict};

use super::CommandError;
use super::unprinted::Unprinted;
use super::verify::audited;
use crate::answer::{Answer, Body, VERSION};
use crate::audit::evidence_sentence;
use crate::caveat;
use crate::document::{Cell, Document, Table, capital};
use crate::export::ros2::update_rate;
use crate::export::{Contract, ExportKind, ExportedController, ExportedPlant, identifier, test_vectors};
use crate::plant_values::FamilyValues;
use crate::project::{InputSignal, Loaded, Project};
use crate::quantity::DisplayUnit;
use crate::source::Source;
use crate::verdict_words::verdict_words;

/// Answer of `export`.
#[derive(Answer)]
pub(super) struct ExportAnswer {
    /// Language of the files.
    kind: &'static str,
    /// Identifier with which the names of files, types and functions begin.
    name: String,
    /// Verdict of the audit that is run first.
    verdict: Verdict,
    /// Evidence behind the verdict.
    evidence: Evidence,
    /// Sample time.
    sample_time_s: f64,
    /// Time from a sample to its command, as it was verified.
    delay_s: f64,
    /// Number of test vectors.
    test_vectors: usize,
    /// Effects that the verdict does not cover, in sentences.
    not_covered: Vec<String>,
    /// The files.
    exported: Vec<ExportedFileAnswer>,
}

/// A file of the controller.
#[derive(Answer)]
struct ExportedFileAnswer {
    /// Name.
    file: String,
    /// Size.
    bytes: usize,
}

/// Effects that no audit of a linear loop covers.
fn not_covered(view: &ProjectAudit, deployed: &Deployed) -> Vec<String> {
    let sentences = caveat::sentences(&view.caveats, &view.units);
    let mut sentences: Vec<String> =
        sentences.iter().map(|sentence| format!("{}.", capital(sentence))).collect();
    sentences.push("The rounding of each operation of the computer is not part of the verdict.".to_string());
    if deployed.controller.command_limit().is_finite() {
        sentences
            .push("The limit of the command and its anti-windup act outside of the linear loop.".to_string());
    }
    if deployed.feed_forward != 0.0 {
        sentences
            .push("The signal that is fed forward is assumed to be that of the velocity sensor.".to_string());
    }
    sentences
}

/// Magnitude of the forces of the test vectors, N: the range of the converter, or the largest step
/// of the reference in a scenario, or 1.
fn force_of(project: &Project, deployed: &Deployed) -> f64 {
    let range = deployed.measurement_converter.map(|converter| converter.range());
    let within = range.map(|[minimum, maximum]| 0.5 * maximum.abs().max(minimum.abs()));
    let steps =
        project.scenarios.iter().flat_map(|scenario| &scenario.reference).map(|signal| match signal {
            InputSignal::Step { value, .. } => value.abs(),
            _ => 0.0,
        });
    within.unwrap_or_else(|| steps.fold(0.0, f64::max)).max(1.0)
}

/// Names of the parameters of a family, and its plants that have polynomials.
fn plants(family: &FamilyValues) -> (Vec<String>, Vec<ExportedPlant>) {
    let names = family.parameters().into_iter().map(str::to_string).collect();
    let members = family.members().into_iter();
    let plants =
        members.filter_map(|values| Some(ExportedPlant { factors: family.member(&values)?, values }));
    (names, plants.collect())
}

/// The files of the controller, after an audit.
pub(super) fn export_answer(
    source: &dyn Source,
    loaded: &Loaded,
    kind: ExportKind,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let deployed = deployed(&setup)?;
    let name = identifier(&loaded.project.title).ok_or(CommandError::NoIdentifier)?;
    let (problem, view) = audited(source, &setup, watch)?;
    let verdict = view.verdict();
    let contract = Contract {
        title: loaded.project.title.clone(),
        version: VERSION,
        project_sha256: loaded.sha256.clone(),
        settings: loaded.settings.clone(),
        verdict: format!("{}. {}", verdict_words(verdict), evidence_sentence(&view)),
        delay_s: setup.timing.delay_s,
        motion: loaded.project.actuator.as_ref().map(|_| loaded.project.motion()),
        not_covered: not_covered(&view, &deployed),
    };
    let vectors = test_vectors(&deployed, force_of(&loaded.project, &deployed));
    let (parameters, plants) = plants(&FamilyValues::of(&problem));
    let exported = ExportedController { name, deployed, contract, vectors, parameters, plants };
    if kind == ExportKind::Ros2 && update_rate(&exported).is_none() {
        return Err(CommandError::UpdateRate);
    }
    let files = kind.files(&exported);
    let listed = files.iter();
    let listed = listed.map(|file| ExportedFileAnswer { file: file.name.clone(), bytes: file.bytes.len() });
    let answer = ExportAnswer {
        kind: kind.name(),
        verdict,
        evidence: view.evidence(),
        sample_time_s: exported.deployed.controller.sample_time_s(),
        delay_s: exported.contract.delay_s,
        test_vectors: exported.vectors.len(),
        not_covered: exported.contract.not_covered.clone(),
        exported: listed.collect(),
        name: exported.name,
    };
    let document = document(&answer, &exported.contract);
    let affirmative = verdict == Verdict::Met;
    Ok(Unprinted { document, body: answer.into_object(), files, affirmative })
}

fn document(answer: &ExportAnswer, contract: &Contract) -> Document {
    let mut document = Document::default();
    document.line(format!("Verdict: {}", contract.verdict));
    let milliseconds = |time_s| DisplayUnit::MILLISECOND.text(time_s, 4);
    let acts = match answer.delay_s == 0.0 {
        true => "without delay".to_string(),
        false => format!("{} after its sample", milliseconds(answer.delay_s)),
    };
    document.line(format!(
        "{} runs every {}, and the verdict assumes that its command acts {acts}; {} test vectors",
        answer.name,
        milliseconds(answer.sample_time_s),
        answer.test_vectors,
    ));
    document.sentences(answer.not_covered.iter().cloned());
    let mut table = Table::new(["file", "bytes"]);
    for file in &answer.exported {
        table.row([Cell::from(file.file.clone()), Cell::count(file.bytes)]);
    }
    document.table(table);
    document
}
