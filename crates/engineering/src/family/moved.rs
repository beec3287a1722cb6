//! The numbers of a project that its directions move.

use phea_dynamics::scalar::Scalar;

use crate::project::Project;

/// A number that directions move.
///
/// ```text
/// number = stated + sum of change z
/// ```
#[derive(Clone, Debug)]
pub(super) struct MovedNumber {
    path: String,
    stated: f64,
    /// Index of the direction's z among the parameters, and the change per standard deviation.
    changes: Vec<(usize, f64)>,
}

/// Numbers that the directions of a project move, each once; `parameters` are the uncertain ones.
pub(super) fn moved(project: &Project, parameters: &[String]) -> Vec<MovedNumber> {
    let mut found: Vec<MovedNumber> = Vec::new();
    for direction in &project.directions {
        let Some(z) = parameters.iter().position(|name| *name == direction.name) else { continue };
        for (path, change) in &direction.changes.numbers {
            match found.iter_mut().find(|one| one.path == *path) {
                Some(one) => one.changes.push((z, *change)),
                None => {
                    let Some(stated) = project.number(path) else { continue };
                    found.push(MovedNumber { path: path.clone(), stated, changes: vec![(z, *change)] });
                }
            }
        }
    }
    found
}

/// The names of the parameters, then those of the moved numbers.
pub(super) fn names(parameters: &[String], moved: &[MovedNumber]) -> Vec<String> {
    parameters.iter().chain(moved.iter().map(|one| &one.path)).cloned().collect()
}

/// The values of the parameters, then those of the moved numbers.
pub(super) fn values<S: Scalar>(parameters: &[S], moved: &[MovedNumber]) -> Vec<S> {
    let value = |one: &MovedNumber| {
        let changes = one.changes.iter().filter_map(|(z, change)| Some((*parameters.get(*z)?, *change)));
        changes.fold(S::from(one.stated), |sum, (z, change)| sum + z * S::from(change))
    };
    parameters.iter().copied().chain(moved.iter().map(value)).collect()
}
