//! A project's text with another controller and prefilter in it, or with other elements of one; all
//! other bytes are unchanged.
//!
//! The implementation uses the tokens of `toml_parser`. The crate `toml_edit` (0.25) does not
//! preserve every byte: it drops all carriage returns, adds a missing end of the last line, and
//! changes the order of dotted keys. Settings (`--set`) change the tree that was read, to whose
//! positions errors refer, and not the text.

mod elements;
mod statement;
mod surgery;

pub use elements::{RewriteError, with_elements};

use std::collections::BTreeMap;

use self::surgery::{KeyValues, replaced};
use super::listing::keys_of_table;
use super::printer::Printer;
use super::{ChosenLines, DeclaredController, DeclaredPressureFeedback, Motions, Prefilter, Transfer};
use phea_table::Variants;

/// Keys of [controller] and [prefilter] that form a transfer function.
fn law_keys() -> Vec<&'static str> {
    keys_of_table(|listing| Transfer::default().visit(listing))
}

/// Bytes of a project file with this controller, and with this prefilter if there is one, in place
/// of the old ones. Other keys of `[controller]` and `[prefilter]` remain as written, unless
/// `settings` overrode them.
pub fn with_laws(
    bytes: &[u8],
    settings: &[String],
    (controller, prefilter): (&DeclaredController, Option<&Prefilter>),
    motions: Motions,
) -> Vec<u8> {
    // the text of a project that was read is UTF-8
    let text = String::from_utf8_lossy(bytes);
    let (mark, content) =
        text.strip_prefix('\u{feff}').map_or(("", text.as_ref()), |rest| ("\u{feff}", rest));
    let overrides = |table: &str| settings.iter().any(|setting| setting.trim_start().starts_with(table));
    let (keys, lines) = match overrides("controller") {
        true => {
            let all = keys_of_table(|listing| DeclaredController::default().visit(listing));
            (all, controller_lines(controller, motions))
        }
        false => (law_keys(), law_lines(&controller.transfer)),
    };
    let mut content = replaced(content, "controller", &keys, &lines);
    if let Some(prefilter) = prefilter {
        let (keys, lines) = match overrides("prefilter") {
            true => {
                let all = keys_of_table(|listing| Prefilter::default().visit(listing));
                (all, prefilter_lines(prefilter))
            }
            // a controller in z has the sample time of the loop
            false => ([law_keys(), vec!["sample_time"]].concat(), law_lines(&prefilter.transfer)),
        };
        content = replaced(&content, "prefilter", &keys, &lines);
    }
    format!("{mark}{content}").into_bytes()
}

/// Bytes of a project file with this pressure feedback of its controller in place of the old one,
/// or without any for `None`.
pub fn with_pressure_feedback(bytes: &[u8], feedback: Option<&DeclaredPressureFeedback>) -> Vec<u8> {
    const KEY: &str = "pressure_feedback";
    let text = String::from_utf8_lossy(bytes);
    let only = DeclaredController { pressure_feedback: feedback.copied(), ..DeclaredController::default() };
    // a pressure has one unit in every rig
    let lines = controller_lines(&only, Motions::default())
        .into_iter()
        .filter(|(key, _)| key == KEY)
        .collect::<KeyValues>();
    replaced(&text, "controller", &[KEY], &lines).into_bytes()
}

/// Bytes of a project file with the chosen model of lines for which none is stated: the choice
/// might differ for another controller, and margins depend on the model.
pub fn with_line_model(bytes: &[u8], chosen: &ChosenLines) -> Vec<u8> {
    const KEY: &str = "model";
    let text = String::from_utf8_lossy(bytes);
    let line = (KEY.to_string(), format!("\"{}\"", chosen.motion().word()));
    replaced(&text, "line", &[KEY], &[line]).into_bytes()
}

/// Text with these lines in place of the transfer function of the table.
fn with_law(text: &str, table: &str, lines: &[(String, String)]) -> String {
    replaced(text, table, &law_keys(), lines)
}

/// Lines of a prefilter; keys with their default values are omitted.
fn prefilter_lines(prefilter: &Prefilter) -> KeyValues {
    let mut printer = Printer::new(BTreeMap::new());
    prefilter.clone().visit(&mut printer);
    printer.lines().into_iter().filter(|(key, _)| key != "continuous" || prefilter.continuous).collect()
}

/// Controller and prefilter as tables of the file of a project with these motions, to be pasted
/// into it.
pub fn snippet(
    (controller, prefilter): (&DeclaredController, Option<&Prefilter>),
    motions: Motions,
) -> String {
    let table = |name: &str, lines: KeyValues| {
        lines.iter().fold(format!("[{name}]\n"), |text, (key, value)| format!("{text}{key} = {value}\n"))
    };
    let prefilter = prefilter.map(|prefilter| table("prefilter", prefilter_lines(prefilter)));
    [Some(table("controller", controller_lines(controller, motions))), prefilter]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("\n")
}

fn law_lines(transfer: &Transfer) -> KeyValues {
    let mut printer = Printer::new(BTreeMap::new());
    transfer.clone().visit(&mut printer);
    printer.lines().into_iter().chain(element_lines(transfer)).collect()
}

/// Elements of a transfer function, one per line; `None` if it has none.
fn element_lines(transfer: &Transfer) -> Option<(String, String)> {
    let rows: String = transfer.elements.iter().map(|one| format!("  {},\n", one.print())).collect();
    (!rows.is_empty()).then(|| ("elements".to_string(), format!("[\n{rows}]")))
}

/// Lines of a controller; keys with their default values are omitted.
fn controller_lines(controller: &DeclaredController, motions: Motions) -> KeyValues {
    let lines = |mut controller: DeclaredController| {
        let mut printer = Printer::new(BTreeMap::new()).in_motions(motions);
        controller.visit(&mut printer);
        printer.lines()
    };
    let absent = lines(DeclaredController::default());
    let elements = element_lines(&controller.transfer);
    elements
        .into_iter()
        .chain(lines(controller.clone()).into_iter().filter(|line| !absent.contains(line)))
        .collect()
}
