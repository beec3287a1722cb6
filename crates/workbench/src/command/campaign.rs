//! Campaigns as a command: all runs with their rows stored, or one run repeated.

use std::borrow::Cow;
use std::ops::Range;

use phea_engineering::campaign::{
    CampaignError, Effort, Plan, RequestedRuns, RowStore, Summary, lines_of_runs, stored_runs,
};
use phea_engineering::line_choice::{LoopInQuestion, with_chosen_lines};
use phea_engineering::setup::Setup;
use phea_engineering::simulate::{RunOutput, ScenarioRun, simulate_into};

use super::unprinted::Unprinted;
use super::{CommandError, Watch, with_recordings};
use crate::answer::{Answer, Body, TableFormat};
use crate::campaign;
use crate::caveat::misfits_in_runs;
use crate::project::{self, Loaded};
use crate::source::{Destination, Source};
use phea_dynamics::simulation::Attention;
use phea_dynamics::watch::Stopped;

/// A request on the campaign that a project declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CampaignRequest {
    /// Seed of all random numbers.
    pub seed: u32,
    /// Requested runs: all or one.
    pub runs: CampaignRuns,
    /// True if the table for other programs and the figures are requested as files.
    pub files: bool,
}

/// Selection of the runs of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CampaignRuns {
    /// The whole campaign, or a part of its runs.
    All(RequestedRuns),
    /// The run with this index, in full.
    One(u64),
}

/// Answers a campaign, its rows stored in the ledger, if there is one, from which an interrupted
/// campaign continues. The answer is yes if every run has its row, whatever its outcome. The table
/// over time of a single run goes to the destination, if there is one.
///
/// # Errors
/// [`CommandError`] if the project declares no campaign, or the ledger fails.
pub fn campaign_watched(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &CampaignRequest,
    (ledger, destination): (Option<&mut dyn RowStore>, Option<&dyn Destination>),
    watch: Watch<'_>,
) -> Result<Answer, CommandError> {
    let (loaded, plan) = planned(source, loaded, request.seed, watch)?;
    let loaded = loaded.as_ref();
    let wanted = match request.runs {
        CampaignRuns::All(wanted) => wanted,
        CampaignRuns::One(run) => {
            let answer = one(source, loaded, catalogues, (&plan, run), destination, watch)?;
            return Ok(answer.print("campaign", std::slice::from_ref(loaded)));
        }
    };
    let rows = phea_engineering::campaign::campaign(&plan, wanted, ledger, watch)?;
    let summary = Summary::of(&plan, &rows);
    let complete = rows.len() as u64 == wanted.runs;
    let files = match request.files && complete {
        true => campaign::files(&plan, &rows, &summary)?,
        false => vec![],
    };
    let warnings = misfits_in_runs(&loaded.project);
    let answer = Unprinted {
        document: campaign::document(&plan, (wanted, request.files), rows.len(), &summary),
        body: campaign::body(&plan, wanted, (rows.len(), &summary), warnings.clone()).into_object(),
        files,
        affirmative: complete,
    };
    Ok(answer.with_warnings(warnings).print("campaign", std::slice::from_ref(loaded)))
}

/// The project with the values of its recordings and the models of its lines, and the plan of its
/// campaign.
fn planned<'a>(
    source: &dyn Source,
    loaded: &'a Loaded,
    seed: u32,
    watch: Watch<'_>,
) -> Result<(Cow<'a, Loaded>, Plan), CommandError> {
    let identified = with_recordings(source, loaded, watch)?;
    let loaded = identified.map_or(Cow::Borrowed(loaded), Cow::Owned);
    let chosen = with_chosen_lines(source, &loaded, LoopInQuestion::Given);
    let loaded = chosen.map_or(loaded, Cow::Owned);
    let plan = Plan::new(source, &loaded, seed)
        .map_err(|error| CommandError::from(error).into_refusal(source, &loaded))?;
    Ok((loaded, plan))
}

/// Campaign whose runs several computers share in chunks.
pub struct CampaignChunks {
    plan: Plan,
}

impl CampaignChunks {
    /// The campaign of a project with this seed.
    ///
    /// # Errors
    /// [`CommandError`] if the project declares no campaign.
    pub fn new(source: &dyn Source, loaded: &Loaded, seed: u32) -> Result<CampaignChunks, CommandError> {
        let (_, plan) = planned(source, loaded, seed, &mut |_| true)?;
        Ok(CampaignChunks { plan })
    }

    /// Number of runs whose rows are stored, each verified; an empty store receives its header.
    ///
    /// # Errors
    /// [`CommandError`] if the store contains another campaign or cannot be written.
    pub fn stored(&self, requested: u64, store: &mut dyn RowStore) -> Result<u64, CommandError> {
        Ok(stored_runs(&self.plan, requested, store)?)
    }

    /// Lines of these runs as the table of the campaign has them.
    ///
    /// # Errors
    /// [`CommandError::Stopped`] if the watch returned false.
    pub fn lines(&self, runs: Range<u64>, effort: Effort, watch: Watch<'_>) -> Result<String, CommandError> {
        match lines_of_runs(&self.plan, runs, effort, watch) {
            Err(CampaignError::Cancelled) => Err(Stopped.into()),
            lines => Ok(lines?),
        }
    }
}

/// A single run: its numbers as settings of the project, and the complete output of `simulate` with
/// them.
fn one(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    (plan, run): (&Plan, u64),
    destination: Option<&dyn Destination>,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let draw = plan.draw(run);
    let settings = plan.settings(&draw);
    let all: Vec<String> = loaded.all_settings().into_iter().chain(settings.iter().cloned()).collect();
    let mut drawn = project::read(source, &loaded.path, &all, catalogues)
        .map_err(|report| CampaignError::Settings(Box::new(report)))?
        .with_lines_of(loaded);
    drawn.project.scenarios.retain(|scenario| scenario.name == plan.scenario());
    let table = destination.map(|destination| (destination, TableFormat::Csv));
    let output = RunOutput { ledger: true, attention: Attention::Steps, ..RunOutput::new(false, table) };
    let runs = simulate_into(source, &Setup::new(&drawn.project)?, output, watch)?;
    let warnings = misfits_in_runs(&drawn.project);
    Ok(Unprinted {
        document: campaign::run_document(&draw, &settings, &drawn, &runs),
        body: campaign::run_body((plan, &draw), settings, (&drawn, &runs), warnings.clone()).into_object(),
        files: phea_engineering::simulate::files(&drawn, &runs),
        affirmative: runs.iter().all(ScenarioRun::is_reliable),
    }
    .with_warnings(warnings))
}
