//! The alternatives of a project as tasks, which several computers can judge, and the answer that
//! joins the results.

use std::borrow::Cow;

use phea_dynamics::watch::Stopped;
use phea_engineering::alternatives::{AlternativesPlan, Judging, prepared_load};

use super::alternatives::{AlternativesRequest, prepared_loads, unprinted};
use super::{CommandError, Request, Watch, motor, with_lines, with_recordings};
use crate::alternatives::{EncodedTask, PrintedTask, decoded, encoded, joined};
use crate::answer::Answer;
use crate::error::TaskResultError;
use crate::project::Loaded;
use crate::source::Source;

/// The judgements that a request on the alternatives of a project needs: independent tasks, whose
/// results as bytes give the answer of the command in any order.
pub struct AlternativesTasks<'a> {
    source: &'a dyn Source,
    /// The project as read, for messages.
    read: &'a Loaded,
    /// The project with the values from its recordings and a model for each line.
    loaded: Cow<'a, Loaded>,
    catalogues: &'a [String],
    request: Request,
    files: bool,
    plan: AlternativesPlan,
}

impl<'a> AlternativesTasks<'a> {
    /// The tasks of a request.
    ///
    /// # Errors
    /// [`CommandError`] for a project without alternatives or specifications, and for options that
    /// are invalid.
    pub fn new(
        source: &'a dyn Source,
        read: &'a Loaded,
        catalogues: &'a [String],
        requested: &AlternativesRequest,
        watch: Watch<'_>,
    ) -> Result<AlternativesTasks<'a>, CommandError> {
        let request = Request::Alternatives(requested.clone());
        let planned = motor::refuse(read, &request).and_then(|()| {
            let loaded = match with_recordings(source, read, watch)? {
                Some(identified) => Cow::Owned(with_lines(source, &identified, &request).into_owned()),
                None => with_lines(source, read, &request),
            };
            let plan = AlternativesPlan::new(&loaded, &requested.read()?)?;
            Ok((loaded, plan))
        });
        let (loaded, plan) = planned.map_err(|error| error.into_refusal(source, read))?;
        Ok(AlternativesTasks { source, read, loaded, catalogues, request, files: requested.files, plan })
    }

    /// Number of tasks, all of which can be prepared.
    ///
    /// # Errors
    /// [`CommandError`] for an alternative that cannot be prepared.
    pub fn count(&self) -> Result<usize, CommandError> {
        self.refused(|| {
            prepared_loads(self.source, &self.loaded, self.catalogues, &self.plan)?;
            Ok(self.plan.tasks().len())
        })
    }

    /// Result of the task at this place, from 0, as bytes for [`AlternativesTasks::joined`].
    ///
    /// # Errors
    /// [`CommandError::Stopped`] if the watch returned false, and [`CommandError`] for an
    /// alternative that cannot be prepared, or without such a task.
    pub fn judged(&self, place: usize, watch: Watch<'_>) -> Result<Vec<u8>, CommandError> {
        self.refused(|| {
            let tasks = self.plan.tasks();
            let absent = TaskResultError::NoTask { place, count: tasks.len() };
            let task = *tasks.get(place).ok_or(absent)?;
            let prepared = prepared_load(self.source, &self.loaded, self.catalogues, task.load())?;
            let judging = Judging::new(self.source, self.catalogues, &self.plan)?;
            let judged = judging.judged(&prepared, task, watch).ok_or(Stopped)?;
            let task = PrintedTask::of(judged, self.loaded.project.motion());
            Ok(encoded(&EncodedTask { place, task })?)
        })
    }

    /// The answer of the command, from the results of all tasks in any order.
    ///
    /// # Errors
    /// [`CommandError`] if a result is missing, or the bytes are not results of these tasks.
    pub fn joined(&self, results: &[Vec<u8>]) -> Result<Answer, CommandError> {
        let tasks = self.plan.tasks();
        let mut in_order: Vec<Option<PrintedTask>> = vec![None; tasks.len()];
        for bytes in results {
            let EncodedTask { place, task: result } = decoded(bytes)?;
            let absent = TaskResultError::NoTask { place, count: tasks.len() };
            let (task, own) = tasks.get(place).zip(in_order.get_mut(place)).ok_or(absent)?;
            if !result.is_of(*task, &self.plan) {
                return Err(TaskResultError::OfOthers(place).into());
            }
            *own = Some(result);
        }
        if let Some(place) = in_order.iter().position(Option::is_none) {
            return Err(TaskResultError::Missing(place).into());
        }
        let found = joined(&self.plan, self.loaded.project.motion(), in_order);
        let loaded: &Loaded = &self.loaded;
        Ok(unprinted(&found, self.files).print(self.request.name(), std::slice::from_ref(loaded)))
    }

    fn refused<T>(&self, found: impl FnOnce() -> Result<T, CommandError>) -> Result<T, CommandError> {
        found().map_err(|error| error.into_refusal(self.source, self.read))
    }
}
