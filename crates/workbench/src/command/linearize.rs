//! `linearize`: the linear models, at one value or over a sweep.

use phea_engineering::linearize::{Linearization, SweepRequest, linearize, sweep};
use phea_engineering::setup::Setup;

use super::CommandError;
use super::unprinted::Unprinted;
use crate::answer::{Body, picture_files};
use crate::linearize;
use crate::project::Loaded;
use crate::report;
use crate::source::Source;

fn linearized(setup: &Setup<'_>) -> Result<Linearization, CommandError> {
    Ok(linearize(setup.rig()?, setup.controller.as_ref(), &setup.sensor)?)
}

pub(super) fn linearize_answer(loaded: &Loaded) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let linearization = linearized(&setup)?;
    let mut document = linearize::output(&setup, &linearization);
    let body = linearize::body(&setup, &linearization).into_object();
    let files = linearize::files(&linearization);
    document.later(move || report::of_models(&linearization));
    Ok(Unprinted { document, body, files, affirmative: true })
}

pub(super) fn swept_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &SweepRequest,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let linearization = linearized(&setup)?;
    let swept = sweep(source, loaded, &setup, catalogues, request)?;
    let mut files = linearize::files(&linearization);
    files.extend(linearize::sweep_files(&swept));
    files.extend(picture_files(&[linearize::sweep_figure(&swept)]));
    Ok(Unprinted {
        document: linearize::sweep_document(&swept),
        body: linearize::body_swept(&setup, &linearization, &swept).into_object(),
        files,
        affirmative: true,
    })
}
