//! Unit of a number of a project, by its path.

use super::read::keys;

/// SI unit of the number at a path, such as a column of a campaign: empty for a pure number, `None`
/// if no project has such a key. A quantity of motion has the unit that it has in a rig with a
/// cylinder. The states from which a scenario starts are at `start.`.
///
/// # Example
/// ```
/// use phea_project::unit_of_key;
/// assert_eq!(unit_of_key("supply.pressure"), Some("Pa"));
/// assert_eq!(unit_of_key("line.a.length"), Some("m"));
/// assert_eq!(unit_of_key("start.position"), Some("m"));
/// assert_eq!(unit_of_key("supply.colour"), None);
/// ```
pub fn unit_of_key(path: &str) -> Option<&'static str> {
    let known = keys();
    let unit = |parts: &[String]| {
        let entry = known.iter().find(|entry| is_at(&entry.path, parts));
        entry.map(|entry| entry.key.dimension.si_unit())
    };
    let parts: Vec<String> = path.split('.').map(without_index).collect();
    let parts = match parts.split_first() {
        Some((start, state)) if start == "start" => {
            [&["scenario[]".to_string(), "start".to_string()], state].concat()
        }
        _ => parts,
    };
    // the keys of a part that exists on either side are listed once, without its side
    let without = |index: usize| [&parts[..index], &parts[index + 1..]].concat();
    unit(&parts).or_else(|| (0..parts.len()).find_map(|index| unit(&without(index))))
}

/// A part of a path with `[]` in place of an index.
fn without_index(part: &str) -> String {
    match part.split_once('[') {
        Some((name, index)) if index.ends_with(']') => format!("{name}[]"),
        _ => part.to_string(),
    }
}

/// True if a listed path, in which `NAME` is any name, is that of these parts.
fn is_at(listed: &str, parts: &[String]) -> bool {
    let mut own = listed.split('.');
    parts.iter().all(|part| own.next().is_some_and(|name| name == "NAME" || name == part))
        && own.next().is_none()
}
