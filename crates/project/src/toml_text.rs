//! Values as TOML on one line.

use super::tree::{Entry, TreeNode, Value};
use phea_quantity as quantity;

/// Key of TOML.
pub(crate) fn bare_or_quoted(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { key.to_string() } else { quoted(key) }
}

/// Basic TOML string.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// List on one line.
pub(crate) fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// Table on one line.
pub(crate) fn inline(lines: &[(String, String)]) -> String {
    let parts: Vec<String> = lines.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    if parts.is_empty() { "{}".to_string() } else { format!("{{ {} }}", parts.join(", ")) }
}

/// Any value on one line; `None` for a date.
pub(crate) fn in_toml(node: &TreeNode) -> Option<String> {
    Some(match &node.value {
        Value::Text(text) => quoted(text),
        Value::Number(number) => quantity::print_bare(*number),
        Value::Flag(flag) => flag.to_string(),
        Value::Date => return None,
        Value::List(items) => list(items.iter().map(in_toml).collect::<Option<Vec<_>>>()?.into_iter()),
        Value::Table(entries) => {
            let entry = |entry: &Entry| Some((bare_or_quoted(&entry.key), in_toml(&entry.node)?));
            inline(&entries.iter().map(entry).collect::<Option<Vec<_>>>()?)
        }
    })
}
