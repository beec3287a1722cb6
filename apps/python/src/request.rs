//! Requests from the options of Python.

use std::str::FromStr;

use phea_workbench::answer::TableFormat;
use phea_workbench::command::{
    AlternativesRequest, CampaignRequest, CampaignRuns, FrequencyOptions, Request, SimulateRequest,
};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::linearize::SweepRequest;
use phea_workbench::engineering::shaping::{Change, RequestedChange, Shaped};
use phea_workbench::export::ExportKind;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A request, and the file of its table.
pub(crate) struct Asked {
    pub(crate) request: Request,
    /// Path of the table of a campaign.
    pub(crate) table: Option<String>,
}

/// The request of this name with these options, which `phea/_project.py` states in full.
pub(crate) fn asked(name: &str, options: &Bound<'_, PyDict>) -> PyResult<Asked> {
    let options = Options(options);
    let files: bool = options.get("files")?.unwrap_or(true);
    let request = match name {
        "check" => Request::Check,
        "size" => Request::Size { gain: options.get("gain")?, length: options.get("length")? },
        "linearize" => {
            let points = options.get("points")?;
            let sweep: Option<String> = options.get("sweep")?;
            Request::Linearize { sweep: sweep.map(|range| SweepRequest { range, points }) }
        }
        "verify" => {
            Request::Verify { proof: options.flag("prove")?, on_machine: options.flag("on_machine")? }
        }
        "shape" => Request::Shape {
            shaped: if options.flag("prefilter")? { Shaped::Prefilter } else { Shaped::Controller },
            changes: changes(options.get("changes")?.unwrap_or_default())?,
        },
        "design" => Request::Design {
            seed: options.get("seed")?,
            stages: files,
            repair: options.get("repair")?.unwrap_or(true),
        },
        "simulate" => Request::Simulate(simulate(&options, files)?),
        "alternatives" => Request::Alternatives(alternatives_request(&options)?),
        "campaign" => Request::Campaign(campaign(&options, files)?),
        "bench" => Request::Bench,
        "export" => Request::Export { kind: kind(&options.get::<String>("kind")?.unwrap_or_default())? },
        "report" => Request::Report { files, alternatives: options.flag("alternatives")? },
        _ => return Err(PyValueError::new_err(format!("no command is called `{name}`"))),
    };
    Ok(Asked { request, table: options.get("table")? })
}

/// Options by name; an absent one and `None` are the same.
pub(crate) struct Options<'a, 'py>(pub(crate) &'a Bound<'py, PyDict>);

impl<'py> Options<'_, 'py> {
    pub(crate) fn get<T>(&self, name: &str) -> PyResult<Option<T>>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let Some(value) = self.0.get_item(name)?.filter(|value| !value.is_none()) else { return Ok(None) };
        let found: Result<T, PyErr> = value.extract().map_err(Into::into);
        found.map(Some).map_err(|error| PyTypeError::new_err(format!("{name}: {error}")))
    }

    fn flag(&self, name: &str) -> PyResult<bool> {
        Ok(self.get(name)?.unwrap_or(false))
    }
}

fn simulate(options: &Options<'_, '_>, files: bool) -> PyResult<SimulateRequest> {
    let format: Option<String> = options.get("format")?;
    let format = format.map(|text| TableFormat::from_str(&text)).transpose();
    let of_sines = FrequencyOptions {
        frequencies: options.get("frequencies")?,
        amplitude: options.get("amplitude")?,
        reference_amplitude: options.get("reference_amplitude")?,
    };
    Ok(SimulateRequest {
        table: format.map_err(|error| PyValueError::new_err(error.to_string()))?.unwrap_or_default(),
        figures: files,
        frequency_response: options.flag("frequency_response")?.then_some(of_sines),
        check: options.flag("check")?,
        ledgers: true,
    })
}

/// Request on the alternatives of a project.
pub(crate) fn alternatives_request(options: &Options<'_, '_>) -> PyResult<AlternativesRequest> {
    Ok(AlternativesRequest {
        files: options.get("files")?.unwrap_or(true),
        front: options.get("front")?,
        sweep: options.get("sweep")?,
        points: options.get("points")?,
        frequencies: options.get("frequencies")?,
    })
}

fn campaign(options: &Options<'_, '_>, files: bool) -> PyResult<CampaignRequest> {
    let all = Effort::on_all_cores();
    let effort = options.get("threads")?.map_or(all, |threads| Effort { threads, ..all });
    let runs = match options.get("run")? {
        Some(run) => CampaignRuns::One(run),
        None => CampaignRuns::All(RequestedRuns { runs: options.get("runs")?.unwrap_or_default(), effort }),
    };
    Ok(CampaignRequest { seed: options.get("seed")?.unwrap_or(1), runs, files })
}

fn kind(name: &str) -> PyResult<ExportKind> {
    let names = ExportKind::ALL.map(ExportKind::name).join(", ");
    let unknown = || PyValueError::new_err(format!("kind is one of {names}, not {name}"));
    ExportKind::named(name).ok_or_else(unknown)
}

/// Changes from pairs of the name of an option of `shape` and its text.
fn changes(pairs: Vec<(String, String)>) -> PyResult<Vec<RequestedChange>> {
    let one = |(option, text): (String, String)| {
        let known = Change::ALL.into_iter().find(|change| change.option() == option);
        let change = known.ok_or_else(|| PyValueError::new_err(format!("no change is called `{option}`")))?;
        Ok(RequestedChange { change, text })
    };
    pairs.into_iter().map(one).collect()
}
