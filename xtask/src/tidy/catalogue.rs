//! Every number in the built-in catalogue has a source.
//!
//! In `crates/workbench/catalogue/` a value is a number or a text that begins with one. It is sourced when its own table has a
//! `source`, as in `bore = { value = "12.7 mm", source = "..." }`, or when the table `source` beside it has its key.

use super::Violation;
use crate::repository::Repository;

const FOLDER: &str = "crates/workbench/catalogue/";
const SOURCE: &str = "source";

pub(super) fn check(repository: &Repository) -> Vec<Violation> {
    let files = repository.texts(|path| path.starts_with(FOLDER) && path.ends_with(".toml"));
    files.flat_map(|(path, text)| check_file(path, text)).collect()
}

fn check_file(path: &str, text: &str) -> Vec<Violation> {
    match text.parse::<toml::Table>() {
        Ok(table) => {
            let mut unsourced = Vec::new();
            collect_unsourced(&table, &mut Vec::new(), &mut unsourced);
            unsourced
                .into_iter()
                .map(|key| Violation::new(path, 0, format!("`{key}` has no source")))
                .collect()
        }
        Err(error) => vec![Violation::new(path, 0, error.to_string())],
    }
}

fn collect_unsourced(table: &toml::Table, above: &mut Vec<String>, unsourced: &mut Vec<String>) {
    let sources = table.get(SOURCE);
    let has_text =
        |value: Option<&toml::Value>| value.and_then(toml::Value::as_str).is_some_and(|text| text.len() > 5);
    for (key, value) in table.iter().filter(|(key, _)| !matches!(key.as_str(), SOURCE | "schema")) {
        above.push(key.clone());
        match value {
            toml::Value::Table(inner) => collect_unsourced(inner, above, unsourced),
            toml::Value::Array(items) if items.iter().any(toml::Value::is_table) => {
                let tables = items.iter().filter_map(toml::Value::as_table);
                tables.for_each(|inner| collect_unsourced(inner, above, unsourced));
            }
            value => {
                let own = above.len() > 1 && key == "value" && has_text(sources);
                let listed =
                    sources.and_then(toml::Value::as_table).is_some_and(|list| has_text(list.get(key)));
                if is_number(value) && !own && !listed {
                    unsourced.push(above.join("."));
                }
            }
        }
        above.pop();
    }
}

fn is_number(value: &toml::Value) -> bool {
    match value {
        toml::Value::Integer(_) | toml::Value::Float(_) => true,
        toml::Value::String(text) => text.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.'),
        toml::Value::Array(items) => items.iter().any(is_number),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<String> {
        let path = "crates/workbench/catalogue/hoses/example.toml";
        check(&Repository::from_texts(&[(path, text)])).iter().map(|v| v.message.clone()).collect()
    }

    #[test]
    fn numbers_and_quantities_need_a_source() {
        assert_eq!(messages("[hose]\nname = \"example\"\nbore = \"12.7 mm\""), ["`hose.bore` has no source"]);
        assert_eq!(messages("r = { value = 3 }\nk = 2.5").len(), 2);
        assert_eq!(messages("schema = 1\nname = \"3130-08\"").len(), 1);
    }

    #[test]
    fn a_source_stands_in_the_value_or_in_a_table_beside_it() {
        assert!(messages("bore = { value = \"12.7 mm\", source = \"Eaton (2008), page 12\" }").is_empty());
        assert!(
            messages("[hose]\nbore = \"12.7 mm\"\n[hose.source]\nbore = \"Eaton (2008), page 12\"")
                .is_empty()
        );
        assert_eq!(messages("[hose]\nbore = \"12.7 mm\"\n[hose.source]\nbore = \"\"").len(), 1);
    }
}
