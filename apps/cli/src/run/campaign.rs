//! Campaign whose table is a file that grows.

use std::path::PathBuf;

use phea_files::{Folder, Inputs, LockedTable, write};
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, Request};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns, RowStore};
use phea_workbench::source::Destination;

use super::{FileSystem, failed, load, refused, reject_replaced_inputs};
use crate::arguments::Common;
use crate::failure::Failure;
use crate::interruption::Interruption;
use crate::messages::ProgressLine;

/// Request of the command line.
pub(super) fn request(
    runs: Option<u64>,
    seed: u32,
    run: Option<u64>,
    (threads, files): (Option<u16>, bool),
) -> CampaignRequest {
    let all = Effort::on_all_cores();
    let effort = threads.map_or(all, |threads| Effort { threads: threads.into(), ..all });
    let chosen = match (run, runs) {
        (Some(run), _) => CampaignRuns::One(run),
        (None, runs) => CampaignRuns::All(RequestedRuns { runs: runs.unwrap_or_default(), effort }),
    };
    CampaignRequest { seed, runs: chosen, files }
}

/// The answer, and the files that were written.
pub(super) fn answer_with_files(
    common: &Common,
    campaign: &CampaignRequest,
) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let request = Request::Campaign(*campaign);
    let path = common.project.to_string_lossy();
    let loaded = load(&path, &common.settings, &common.catalogues, request.name())?;
    let inputs = Inputs::of_projects([&loaded]);
    reject_replaced_inputs(&inputs, (&request, &loaded), [common.out.as_deref(), None])?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let mut table = match (&common.out, campaign.runs) {
        (Some(folder), CampaignRuns::All(_)) => {
            let path = folder.join("runs.csv");
            Some(LockedTable::open(&path).map_err(|message| failed(&request, &loaded, &message))?)
        }
        _ => None,
    };
    let tables = common.out.as_deref().map(|folder| Folder::new(folder, &inputs));
    let destination = tables.as_ref().map(|tables| tables as &dyn Destination);
    let ledger = table.as_mut().map(|table| table as &mut dyn RowStore);
    let mut watch = |progress| {
        line.show_evenly(progress);
        !interruption.is_requested()
    };
    let catalogues = &common.catalogues;
    let into = (ledger, destination);
    let answer = command::campaign_watched(&FileSystem, &loaded, catalogues, campaign, into, &mut watch);
    line.clear();
    let answer = answer.map_err(|error| {
        table.iter().for_each(LockedTable::leave_no_trace);
        refused(&loaded, &request, (&error, line.stage()))
    })?;
    // the table remains locked until all other files are written
    let mut written: Vec<PathBuf> = table.iter().map(|table| table.path().to_path_buf()).collect();
    written.extend(tables.map(Folder::into_begun).unwrap_or_default());
    if let Some(folder) = &common.out {
        let more = write(folder, &answer.files, &inputs);
        written.extend(more.map_err(|message| failed(&request, &loaded, &message))?);
    }
    Ok((answer, written))
}
