//! Every number in the built-in catalogue has a source, and every file of it is built in.
//!
//! A file in `crates/project/catalogue/` describes one product and is called after it. `source`
//! holds for every number of the file, `[sources]` for single ones.

use super::Violation;
use crate::repository::Repository;

const BUILT_IN: &str = "crates/project/src/catalogue/built_in.rs";
const FOLDER: &str = "crates/project/catalogue/";

/// A source shorter than this names no document.
const SHORTEST_SOURCE: usize = 12;

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let files = repository.texts(|path| path.starts_with(FOLDER) && path.ends_with(".toml"));
    let built_in = repository.text(BUILT_IN).unwrap_or_default();
    let check = |(path, text)| check_file(path, text).into_iter().chain(check_built_in(path, built_in));
    files.flat_map(check).collect()
}

fn check_built_in(path: &str, built_in: &str) -> Option<Violation> {
    let included =
        path.strip_prefix(FOLDER).is_some_and(|name| built_in.contains(&format!("catalogue/{name}")));
    (!included).then(|| Violation::new(path, 0, format!("has no line in {BUILT_IN}")))
}

fn check_file(path: &str, text: &str) -> Vec<Violation> {
    let table: toml::Table = match text.parse() {
        Ok(table) => table,
        Err(error) => return vec![Violation::new(path, 0, error.to_string())],
    };
    let mut found = Vec::new();
    let name = table.get("name").and_then(toml::Value::as_str).unwrap_or_default();
    if !path.ends_with(&format!("/{name}.toml")) {
        found.push(Violation::new(path, 0, format!("is not called after its product, `{name}`")));
    }
    let is_source = |value: Option<&toml::Value>| {
        value.and_then(toml::Value::as_str).is_some_and(|text| text.len() >= SHORTEST_SOURCE)
    };
    let numbers = table.iter().filter(|(key, value)| *key != "schema" && is_number(value));
    for (key, _) in numbers {
        let own = table.get("sources").and_then(toml::Value::as_table).and_then(|sources| sources.get(key));
        if !is_source(own.or(table.get("source"))) {
            let line =
                text.lines().position(|line| line.starts_with(key.as_str())).map_or(0, |index| index + 1);
            found.push(Violation::new(path, line, format!("`{key}` has no source")));
        }
    }
    found
}

/// A number, or a text that begins with one, or anything that holds one.
fn is_number(value: &toml::Value) -> bool {
    match value {
        toml::Value::Integer(_) | toml::Value::Float(_) => true,
        toml::Value::String(text) => {
            let unsigned = text.trim_start_matches(['-', '+', '.']);
            unsigned.starts_with(|c: char| c.is_ascii_digit())
        }
        toml::Value::Array(items) => items.iter().any(is_number),
        toml::Value::Table(table) => table.values().any(is_number),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<String> {
        let path = "crates/project/catalogue/hoses/example.toml";
        let text = format!("schema = 1\nname = \"example\"\n{text}");
        let built_in = "include_str!(\"../../catalogue/hoses/example.toml\")";
        let files = [(path, text.as_str()), (BUILT_IN, built_in)];
        check(&Repository::from_texts(&files)).iter().map(|v| v.message.clone()).collect()
    }

    #[test]
    fn numbers_and_quantities_need_a_source() {
        assert_eq!(messages("bore = \"12.7 mm\"\ntitle = \"Example\""), ["`bore` has no source"]);
        assert_eq!(messages("r = { nominal = 3 }\nk = 2.5\nrange = [\".5 m\"]").len(), 3);
        assert_eq!(messages("source = \"a book\"\nbore = 1.0").len(), 1);
    }

    #[test]
    fn a_source_holds_for_the_file_or_for_one_number() {
        assert!(messages("source = \"Eaton (2008), page 12\"\nbore = \"12.7 mm\"").is_empty());
        assert!(messages("bore = 1.0\n[sources]\nbore = \"Eaton (2008), page 12\"").is_empty());
        assert_eq!(
            messages("bore = 1.0\nlength = 2.0\n[sources]\nbore = \"Eaton (2008), page 12\"").len(),
            1
        );
    }

    #[test]
    fn a_file_is_called_after_its_product() {
        assert_eq!(messages("").len(), 0);
        let files = [("crates/project/catalogue/a.toml", "name = \"b\""), (BUILT_IN, "catalogue/a.toml")];
        assert_eq!(check(&Repository::from_texts(&files)).len(), 1);
    }

    #[test]
    fn a_file_is_built_in() {
        let files = [("crates/project/catalogue/a.toml", "name = \"a\""), (BUILT_IN, "")];
        assert_eq!(check(&Repository::from_texts(&files)).len(), 1);
    }
}
