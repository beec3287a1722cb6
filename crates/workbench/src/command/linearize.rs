//! `linearize`: the linear models, at one value or over a sweep.

use super::CommandError;
use crate::answer::Answer;
use crate::answer::picture_files;
use crate::linearize::{self, Linearization, SweepRequest, linearize, sweep};
use crate::project::Loaded;
use crate::setup::Setup;
use crate::source::Source;

fn linearized(setup: &Setup<'_>) -> Result<Linearization, CommandError> {
    Ok(linearize(setup.rig()?, setup.controller.as_ref(), &setup.sensor)?)
}

pub(super) fn linearize_answer(loaded: &Loaded) -> Result<Answer, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let linearization = linearized(&setup)?;
    Ok(Answer {
        text: linearize::text(&setup, &linearization),
        json: linearize::json(loaded, &setup, &linearization),
        files: linearize::files(&linearization),
        affirmative: true,
    })
}

pub(super) fn swept_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    asked: &SweepRequest,
) -> Result<Answer, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let linearization = linearized(&setup)?;
    let swept = sweep(source, (loaded, &setup), catalogues, asked)?;
    let mut files = linearize::files(&linearization);
    files.extend(linearize::sweep_files(&swept));
    files.extend(picture_files(&[linearize::sweep_figure(&swept)]));
    Ok(Answer {
        text: linearize::sweep_text(&swept),
        json: linearize::json_swept(loaded, &setup, &linearization, &swept),
        files,
        affirmative: true,
    })
}
