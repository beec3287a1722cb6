//! The commands on a project: requests, and the answers that a shell prints and writes.

mod alternatives;
mod alternatives_tasks;
mod answers;
mod campaign;
mod check;
mod export;
mod friction;
mod identification;
mod identify;
mod impossible;
mod line_test;
mod linearize;
mod motor;
mod output_names;
mod refusal;
mod response;
mod schema;
mod simulate;
mod unprinted;
mod verify;

pub use crate::error::{CommandError, TaskResultError};
pub use alternatives::AlternativesRequest;
pub use alternatives_tasks::AlternativesTasks;
pub use campaign::{CampaignChunks, CampaignRequest, CampaignRuns, campaign_watched};
pub use friction::{FrictionRequest, friction_watched};
pub use identification::{
    IdentificationRequest, IdentifiedPart, IdentifyOptionError, IdentifyOptions, OptionSpelling,
    identification_watched,
};
pub use identify::{IdentifyRequest, identify_watched};
pub use line_test::{LineRequest, line_watched};
pub use output_names::OutputNames;
pub use phea_engineering::identify_error::IdentifyError;
pub use phea_engineering::response::ResponseSettings;
pub use phea_hydraulics::servovalve::LeakageModel;
pub use refusal::{error_json, failure_json, files_json, refusal_json, stopped_text};
pub use response::{ResponseRequest, response_watched};
pub use schema::{ANSWERS_SCHEMA_FILE, SCHEMA_FILE, answers_schema, schema};
pub use simulate::{FrequencyOptions, SimulateRequest};

use std::borrow::Cow;

use phea_dynamics::watch::{Stopped, rising, within};
use phea_engineering::alternatives::AlternativesOptions as RequestedOfAlternatives;
use phea_engineering::design::{design_and_repair, design_project};
use phea_engineering::line_choice::{LoopInQuestion, with_chosen_lines};
use phea_engineering::line_test::line_runs;
use phea_engineering::linearize::SweepRequest;
use phea_engineering::option::OptionError;
use phea_engineering::robust::{RobustProblem, robust_problem};
use phea_engineering::setup::Setup;
use phea_engineering::shaping::{RequestedChange, Shaped, shape};
use phea_engineering::simulate::compare_projects;
use phea_engineering::sizing::{Candidate, Question, SizingError, size, sizing_problem};
use phea_engineering::specification::crossed_limits;
use phea_engineering::trial::{Agreement, Trial};

use crate::answer::{Answer, Body};
use crate::bench;
use crate::design;
use crate::document::Document;
use crate::export::ExportKind;
use crate::identify::in_use;
use crate::project::Loaded;
use crate::quantity::{self, LENGTH, VOLTAGE_PER_FORCE};
use crate::report::{self, report_next_to};
use crate::shaping;
use crate::sizing;
use crate::source::{Destination, HeldFiles, Source};
use alternatives::alternatives_answer;
use check::check;
use export::export_answer;
use linearize::{linearize_answer, swept_answer};
use simulate::simulate_answer;
use unprinted::Unprinted;
use verify::verify_answer;

/// A request on a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Request {
    /// Every derived quantity.
    Check,
    /// The hose, for a gain or a length as text, if given.
    Size {
        /// K_p, such as `2.7e-4`.
        gain: Option<String>,
        /// Length of each line, such as `1.5 m`.
        length: Option<String>,
    },
    /// Linear models.
    Linearize {
        /// A range of one number of the project, over which they are followed too.
        sweep: Option<SweepRequest>,
    },
    /// The audit of the given controller.
    Verify {
        /// True if the verdict is to be proven.
        proof: bool,
        /// True if the controller is to be tested in nonlinear simulation.
        on_machine: bool,
    },
    /// Shaping by hand, elements changed in order.
    Shape {
        /// The transfer function that is shaped: controller or prefilter.
        shaped: Shaped,
        /// The changes.
        changes: Vec<RequestedChange>,
    },
    /// A controller that satisfies the specifications.
    Design {
        /// Seed of the search, instead of the project's.
        seed: Option<u32>,
        /// True if every stage is requested as files, and not only the designed project.
        stages: bool,
        /// True if the design continues when the machine contradicts it.
        repair: bool,
    },
    /// The nonlinear model through every scenario, or its frequency response.
    Simulate(SimulateRequest),
    /// Identical scenarios of this project and others, compared side by side.
    Compare,
    /// The project and each of its alternatives: sized, designed, audited and driven.
    Alternatives(AlternativesRequest),
    /// The nonlinear model with drawn numbers, many times.
    Campaign(CampaignRequest),
    /// Static tests of the servovalve.
    Bench,
    /// The controller, as it was verified, as source for its computer.
    Export {
        /// Language of the files.
        kind: ExportKind,
    },
    /// The page with every chapter.
    Report {
        /// True if every figure is requested as a file too.
        files: bool,
        /// True if the report has a chapter on the alternatives of the project, with a design for
        /// each.
        alternatives: bool,
    },
}

impl Request {
    /// Name of the command.
    pub fn name(&self) -> &'static str {
        match self {
            Request::Check => "check",
            Request::Size { .. } => "size",
            Request::Linearize { .. } => "linearize",
            Request::Verify { .. } => "verify",
            Request::Shape { .. } => "shape",
            Request::Design { .. } => "design",
            Request::Simulate(_) => "simulate",
            Request::Compare => "compare",
            Request::Alternatives(_) => "alternatives",
            Request::Campaign(_) => "campaign",
            Request::Bench => "bench",
            Request::Export { .. } => "export",
            Request::Report { .. } => "report",
        }
    }
}

pub use phea_dynamics::watch::{Progress, Watch};

/// Fraction of the progress spent on identifying the valve from recordings, if it is identified.
const IDENTIFYING: f64 = 0.3;

/// Answers a request on a project; `catalogues` are the user's files and folders.
///
/// # Errors
/// Errors of [`answer_into`], except those of writing.
pub fn answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &Request,
) -> Result<Answer, CommandError> {
    let held = HeldFiles::default();
    let mut answer = answer_into(source, loaded, catalogues, request, Some(&held), &mut |_| true)?;
    answer.files.splice(0..0, held.into_files());
    Ok(answer)
}

/// Answers a request and reports progress. The tables of simulated scenarios are written to the
/// destination, if there is one, while they are computed; all other files are in the answer.
///
/// # Errors
/// [`CommandError`] if the project lacks something that the command needs, something in it cannot
/// be computed, or a table cannot be written; [`CommandError::Stopped`].
pub fn answer_into(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &Request,
    destination: Option<&dyn Destination>,
    watch: Watch<'_>,
) -> Result<Answer, CommandError> {
    // these three requests treat the valve in their own way: the bench tests the declared valve,
    // whose recordings may not exist yet
    let mut rising = rising(watch);
    let identified = motor::refuse(loaded, request).and_then(|()| match request {
        Request::Bench | Request::Compare | Request::Campaign(_) => Ok(None),
        _ => with_recordings(source, loaded, &mut within(&mut rising, [0.0, IDENTIFYING])),
    });
    let answer = identified.and_then(|identified| {
        let from = if identified.is_some() { IDENTIFYING } else { 0.0 };
        let chosen = with_lines(source, identified.as_ref().unwrap_or(loaded), request);
        let loaded = chosen.as_ref();
        let mut rest = within(&mut rising, [from, 1.0]);
        answer_as_read(source, loaded, catalogues, request, destination, &mut rest)
    });
    answer.map_err(|error| error.into_refusal(source, loaded))
}

/// The robust problem of a project, with the valve identified from its recordings if the project
/// requires that.
///
/// # Errors
/// [`CommandError`] for a project that is no such problem.
pub fn robust_problem_of(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<RobustProblem, CommandError> {
    let problem = with_recordings(source, loaded, watch).and_then(|identified| {
        let loaded = identified.as_ref().unwrap_or(loaded);
        let chosen = with_chosen_lines(source, loaded, LoopInQuestion::Given);
        let project = &chosen.as_ref().unwrap_or(loaded).project;
        Ok(robust_problem(source, &Setup::new(project)?)?)
    });
    problem.map_err(|error| error.into_refusal(source, loaded))
}

/// The project, with the valve identified from its recordings if the project requires that.
fn with_recordings(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Loaded>, CommandError> {
    Ok(in_use(source, loaded, watch)?)
}

/// The project with a model for each line without a stated one. Sizing finds a line and the bench
/// tests it: both leave it open.
fn with_lines<'a>(source: &dyn Source, loaded: &'a Loaded, request: &Request) -> Cow<'a, Loaded> {
    let question = match request {
        Request::Size { .. } | Request::Bench => return Cow::Borrowed(loaded),
        Request::Design { .. } | Request::Report { .. } | Request::Alternatives(_) => {
            LoopInQuestion::Designed
        }
        _ => LoopInQuestion::Given,
    };
    with_chosen_lines(source, loaded, question).map_or(Cow::Borrowed(loaded), Cow::Owned)
}

fn answer_as_read(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &Request,
    destination: Option<&dyn Destination>,
    watch: Watch<'_>,
) -> Result<Answer, CommandError> {
    let answer = match request {
        Request::Compare => return compare_watched(source, std::slice::from_ref(loaded), false, watch),
        Request::Campaign(requested) => {
            return campaign_watched(source, loaded, catalogues, requested, (None, destination), watch);
        }
        Request::Check => check(source, loaded, catalogues),
        Request::Size { gain, length } => {
            let question = question(gain.as_deref(), length.as_deref())?;
            size_answer(source, loaded, catalogues, question)
        }
        Request::Linearize { sweep: None } => linearize_answer(loaded),
        Request::Linearize { sweep: Some(requested) } => swept_answer(source, loaded, catalogues, requested),
        Request::Verify { proof, on_machine } => verify_answer(source, loaded, *proof, *on_machine, watch),
        Request::Shape { shaped, changes } => {
            let shaping = shape(source, loaded, *shaped, changes, watch).map_err(shaping::with_text)?;
            let (document, body) = (shaping::document(&shaping), shaping::body(&shaping).into_object());
            Ok(Unprinted { document, body, files: shaping::files(&shaping), affirmative: true })
        }
        Request::Design { seed, stages, repair } => {
            design_answer(source, loaded, *seed, *stages, *repair, watch)
        }
        Request::Simulate(requested) => simulate_answer(source, loaded, requested, destination, watch),
        Request::Alternatives(requested) => alternatives_answer(source, loaded, catalogues, requested, watch),
        Request::Bench => bench_answer(loaded, watch),
        Request::Export { kind } => export_answer(source, loaded, *kind, watch),
        Request::Report { files, alternatives } => {
            report_answer(source, loaded, catalogues, *files, *alternatives, watch)
        }
    }?;
    Ok(answer.print(request.name(), std::slice::from_ref(loaded)))
}

fn question(gain: Option<&str>, length: Option<&str>) -> Result<Question, CommandError> {
    Ok(match (gain, length) {
        (Some(text), _) => Question::Gain(positive("gain", text, text, &VOLTAGE_PER_FORCE)?),
        (None, Some(text)) => Question::Length(positive("length", text, text, &LENGTH)?),
        (None, None) => Question::Both,
    })
}

/// A positive number in SI, parsed from a part of the text of an option, with or without a unit.
fn positive(
    option: &'static str,
    text: &str,
    part: &str,
    dimension: &quantity::Dimension,
) -> Result<f64, OptionError> {
    let refuse = |message: String| OptionError { option, text: text.to_string(), message };
    let bare = part.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let value = match bare {
        Some(value) => value,
        None => quantity::parse(part, dimension).map_err(|error| refuse(error_words(&error, dimension)))?,
    };
    if value > 0.0 { Ok(value) } else { Err(refuse("must be positive".to_string())) }
}

/// The error of a quantity, and the expected dimension.
fn error_words(error: &quantity::QuantityError, dimension: &quantity::Dimension) -> String {
    let help = error.help.as_ref().map_or(String::new(), |help| format!("; {help}"));
    format!("{error}; write {}, such as {}{help}", dimension.name, dimension.examples)
}

fn size_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    question: Question,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let catalogue = crate::catalogue::load(source, catalogues).map_err(CommandError::Refused)?;
    let problem = sizing_problem(&setup, &catalogue)?;
    let sizing = size(&problem, question);
    let units = &loaded.project.units;
    let mut document = sizing::document(&sizing, vec![], units);
    let body = sizing::body(&sizing, units).into_object();
    let files = sizing::files(&sizing);
    let affirmative = sizing.best().is_some_and(Candidate::accepted);
    document.later(move || report::of_sizing(&problem, &sizing));
    Ok(Unprinted { document, body, files, affirmative })
}

fn bench_answer(loaded: &Loaded, watch: Watch<'_>) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let runs = phea_engineering::bench::bench(&setup, &mut within(&mut *watch, [0.0, 0.5]))?;
    let lines = line_runs(&setup, &mut within(&mut *watch, [0.5, 0.75]))?;
    let of_friction = phea_engineering::bench::friction_runs(&setup, &mut within(watch, [0.75, 1.0]))?;
    let remarks = bench::remarks(&setup);
    let document = bench::document(loaded, &remarks, &runs, &of_friction, &lines);
    let files = bench::files(&runs, &of_friction).into_iter().chain(bench::line_files(&lines)).collect();
    let body = bench::body(remarks, &runs, &lines, &of_friction).into_object();
    Ok(Unprinted { document, body, files, affirmative: true })
}

fn design_answer(
    source: &dyn Source,
    loaded: &Loaded,
    seed: Option<u32>,
    stages: bool,
    repair: bool,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    if let Some(crossed) = crossed_limits(&loaded.project)? {
        return Err(crossed.into());
    }
    let mut designing = within(&mut *watch, [0.0, if stages { 0.9 } else { 1.0 }]);
    let mut view = match repair {
        true => design_and_repair(source, &setup, seed, &mut designing)?,
        false => design_project(source, &setup, seed, &mut designing)?,
    };
    drop(designing);
    let files = match stages {
        true => design::stage_files(loaded, &mut view, &mut within(watch, [0.9, 1.0]))?,
        false => design::files(loaded, &view),
    };
    let mut document = design::output(loaded, &view)?;
    let body = design::body(&view)?.into_object();
    let affirmative = view.is_met()
        && !view.is_stopped()
        && view.agreement() != Agreement::Contradicts
        && view.trial.as_ref().and_then(Trial::satisfies) != Some(false);
    document.later(move || report::of_design(&view));
    Ok(Unprinted { document, body, files, affirmative })
}

/// Compares identical scenarios of several projects, with `figures` as files, and reports progress.
/// The answer is yes if every run was completed.
///
/// # Errors
/// [`CommandError`] if a project cannot be simulated.
pub fn compare_watched(
    source: &dyn Source,
    projects: &[Loaded],
    figures: bool,
    watch: Watch<'_>,
) -> Result<Answer, CommandError> {
    motor::refuse_mixture(projects)?;
    let identified = projects
        .iter()
        .map(|loaded| {
            let loaded = with_recordings(source, loaded, watch)?.unwrap_or_else(|| loaded.clone());
            Ok(with_chosen_lines(source, &loaded, LoopInQuestion::Given).unwrap_or(loaded))
        })
        .collect::<Result<Vec<Loaded>, CommandError>>()?;
    let projects = identified.as_slice();
    let comparison = compare_projects(source, projects, watch).map_err(|(index, error)| {
        let path = projects.get(index).map(|loaded| loaded.path.clone()).unwrap_or_default();
        CommandError::Compare { path, error }
    })?;
    let answer = Unprinted {
        document: crate::simulate::comparison(&comparison, projects),
        body: crate::simulate::comparison_body(&comparison).into_object(),
        files: if figures { crate::simulate::comparison_files(&comparison) } else { vec![] },
        affirmative: comparison.projects.len() == projects.len() && comparison.is_complete(),
    };
    Ok(answer.print("compare", projects))
}

fn report_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    files: bool,
    alternatives: bool,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let problem = match loaded.project.sizing {
        None => None,
        Some(_) => {
            let catalogue = crate::catalogue::load(source, catalogues).map_err(CommandError::Refused)?;
            match sizing_problem(&setup, &catalogue) {
                Err(SizingError::Rig(error)) => return Err(error.into()),
                problem => Some(problem),
            }
        }
    };
    let judged = alternatives
        .then(|| {
            let watch = &mut within(&mut *watch, [0.0, 0.5]);
            alternatives::judged(source, loaded, catalogues, &RequestedOfAlternatives::default(), watch)
        })
        .transpose()?;
    if judged.as_ref().is_some_and(|judged| !judged.not_reached.is_empty()) {
        return Err(Stopped.into());
    }
    let watch = &mut within(watch, [if alternatives { 0.5 } else { 0.0 }, 1.0]);
    let report = report_next_to(source, loaded, (&setup, problem.as_ref()), judged.as_ref(), watch)?;
    let written = if files { report.files() } else { vec![report.page_file()] };
    let mut document = Document::default();
    report.summary.iter().for_each(|(name, value)| document.line(format!("{name}: {value}")));
    let body = report::body(report).into_object();
    Ok(Unprinted { document, body, files: written, affirmative: true })
}
