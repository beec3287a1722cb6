//! One concept a file, named after it: `foo.rs` beside `foo/`, no drawer for leftovers.

use super::Violation;
use crate::repository::Repository;

const LEFTOVERS: [&str; 8] = ["mod", "utils", "util", "common", "helpers", "helper", "misc", "shared"];

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    repository.texts(|path| path.ends_with(".rs")).filter_map(|(path, _)| check_name(path)).collect()
}

fn check_name(path: &str) -> Option<Violation> {
    let mut parts = path.trim_end_matches(".rs").split('/');
    let leftover = parts.find(|part| LEFTOVERS.contains(part))?;
    let cure = if leftover == "mod" { "foo.rs beside foo/" } else { "the concept it holds" };
    Some(Violation::new(path, 0, format!("named `{leftover}`: name it after {cure}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawers_are_refused_and_modules_about_moduli_are_not() {
        for path in ["crates/a/src/b/mod.rs", "crates/a/src/utils.rs", "crates/a/src/common/line.rs"] {
            assert!(check_name(path).is_some(), "{path}");
        }
        for path in ["crates/a/src/modulus.rs", "crates/a/src/line.rs"] {
            assert!(check_name(path).is_none(), "{path}");
        }
    }
}
