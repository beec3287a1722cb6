//! A project's text with another controller and prefilter in it, everything else byte for byte as
//! it was.
//!
//! It rests on the tokens of `toml_parser`. The crate `toml_edit` (0.25) does not keep every byte:
//! it drops all carriage returns, ends the last line where it had no end, and does not keep the
//! order of dotted keys. Settings (`--set`) change the tree that was read, to whose positions
//! errors refer, and not the text.

mod statement;
mod surgery;

use std::collections::BTreeMap;

use self::surgery::{KeyValues, LAW, replaced};
use super::printer::Printer;
use super::{DeclaredController, Prefilter, Transfer};

/// Keys of [controller] other than its transfer function.
const BESIDE: [&str; 8] = [
    "saturation",
    "anti_windup",
    "sample_time",
    "delay",
    "discretization",
    "quantization",
    "load_velocity_feed_forward",
    "impedance",
];

/// The bytes of a project file with this controller, and with this prefilter if there is one, in
/// place of the old ones. Other keys of `[controller]` and `[prefilter]` remain as they are
/// written, unless `settings` overrode them.
pub fn with_laws(
    bytes: &[u8],
    settings: &[String],
    controller: &DeclaredController,
    prefilter: Option<&Prefilter>,
) -> Vec<u8> {
    // a text that was read as a project is UTF-8
    let text = String::from_utf8_lossy(bytes);
    let (mark, content) =
        text.strip_prefix('\u{feff}').map_or(("", text.as_ref()), |rest| ("\u{feff}", rest));
    let overrides = |table: &str| settings.iter().any(|setting| setting.trim_start().starts_with(table));
    let overridden = overrides("controller");
    let lines = if overridden { controller_lines(controller) } else { law_lines(&controller.transfer) };
    let keys: Vec<&str> = LAW.into_iter().chain(BESIDE.into_iter().filter(|_| overridden)).collect();
    let mut content = replaced(content, "controller", &keys, &lines);
    if let Some(prefilter) = prefilter {
        // a controller in z has the samples of the loop
        let overridden = overrides("prefilter");
        let lines = if overridden { prefilter_lines(prefilter) } else { law_lines(&prefilter.transfer) };
        let keys: Vec<&str> =
            LAW.into_iter().chain(["sample_time"]).chain(overridden.then_some("continuous")).collect();
        content = replaced(&content, "prefilter", &keys, &lines);
    }
    format!("{mark}{content}").into_bytes()
}

/// The text with these lines in place of the transfer function of the table.
pub fn with_law(text: &str, table: &str, lines: &[(String, String)]) -> String {
    replaced(text, table, &LAW, lines)
}

/// Keys with their default values are left out.
fn prefilter_lines(prefilter: &Prefilter) -> KeyValues {
    let mut printer = Printer::new(BTreeMap::new());
    prefilter.clone().visit(&mut printer);
    printer.lines().into_iter().filter(|(key, _)| key != "continuous" || prefilter.continuous).collect()
}

/// Controller and prefilter as tables of a project file, ready to be pasted into one.
pub fn snippet(controller: &DeclaredController, prefilter: Option<&Prefilter>) -> String {
    let table = |name: &str, lines: KeyValues| {
        lines.iter().fold(format!("[{name}]\n"), |text, (key, value)| format!("{text}{key} = {value}\n"))
    };
    let prefilter = prefilter.map(|prefilter| table("prefilter", prefilter_lines(prefilter)));
    [Some(table("controller", controller_lines(controller))), prefilter]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("\n")
}

fn law_lines(transfer: &Transfer) -> KeyValues {
    let mut printer = Printer::new(BTreeMap::new());
    transfer.clone().visit(&mut printer);
    printer.lines()
}

/// Keys with their default values are left out.
fn controller_lines(controller: &DeclaredController) -> KeyValues {
    let lines = |mut controller: DeclaredController| {
        let mut printer = Printer::new(BTreeMap::new());
        controller.visit(&mut printer);
        printer.lines()
    };
    let absent = lines(DeclaredController::default());
    lines(controller.clone()).into_iter().filter(|line| !absent.contains(line)).collect()
}
