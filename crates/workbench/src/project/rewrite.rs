//! A project's text with another controller and prefilter in it, everything else byte for byte as it was.

mod statement;

use std::collections::BTreeMap;

use self::statement::{Content, Statement, entries, statements};
use super::printer::Printer;
use super::{Controller, Prefilter, Transfer};

/// Keys of [controller] and [prefilter] that make a law.
const LAW: [&str; 7] = ["numerator", "denominator", "gain", "zeros", "poles", "domain", "elements"];
/// Those of [controller] beside its law.
const BESIDE: [&str; 7] = [
    "saturation",
    "anti_windup",
    "sample_time",
    "delay",
    "discretization",
    "quantization",
    "load_velocity_feed_forward",
];

/// The bytes of a project file with this controller, and with this prefilter if there is one, in place of what it said. Keys of [controller]
/// and [prefilter] beside the law stay as they are written, unless `settings` overrode them.
pub(crate) fn with_laws(
    bytes: &[u8],
    settings: &[String],
    controller: &Controller,
    prefilter: Option<&Prefilter>,
) -> Vec<u8> {
    // what was read as a project is UTF-8
    let text = String::from_utf8_lossy(bytes);
    let (mark, content) =
        text.strip_prefix('\u{feff}').map_or(("", text.as_ref()), |rest| ("\u{feff}", rest));
    let overrides = |table: &str| settings.iter().any(|setting| setting.trim_start().starts_with(table));
    let overridden = overrides("controller");
    let lines = if overridden { controller_lines(controller) } else { law_lines(&controller.transfer) };
    let keys: Vec<&str> = LAW.into_iter().chain(BESIDE.into_iter().filter(|_| overridden)).collect();
    let mut content = replaced(content, "controller", &keys, &lines);
    if let Some(prefilter) = prefilter {
        // samples of a law in z are those of the loop
        let overridden = overrides("prefilter");
        let lines = if overridden { prefilter_lines(prefilter) } else { law_lines(&prefilter.transfer) };
        let keys: Vec<&str> =
            LAW.into_iter().chain(["sample_time"]).chain(overridden.then_some("continuous")).collect();
        content = replaced(&content, "prefilter", &keys, &lines);
    }
    format!("{mark}{content}").into_bytes()
}

/// The text with these lines in place of whatever law the table has.
pub(crate) fn with_law(text: &str, table: &str, lines: &[(String, String)]) -> String {
    replaced(text, table, &LAW, lines)
}

/// Those that say what their absence would say too are left out.
fn prefilter_lines(prefilter: &Prefilter) -> Lines {
    let mut printer = Printer::new(BTreeMap::new());
    prefilter.clone().visit(&mut printer);
    printer.lines().into_iter().filter(|(key, _)| key != "continuous" || prefilter.continuous).collect()
}

/// Controller and prefilter as tables of a project file, ready to be pasted into one.
pub(crate) fn snippet(controller: &Controller, prefilter: Option<&Prefilter>) -> String {
    let table = |name: &str, lines: Lines| {
        lines.iter().fold(format!("[{name}]\n"), |text, (key, value)| format!("{text}{key} = {value}\n"))
    };
    let prefilter = prefilter.map(|prefilter| table("prefilter", prefilter_lines(prefilter)));
    [Some(table("controller", controller_lines(controller))), prefilter]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("\n")
}

/// Keys with their values as TOML.
type Lines = Vec<(String, String)>;

fn law_lines(transfer: &Transfer) -> Lines {
    let mut printer = Printer::new(BTreeMap::new());
    transfer.clone().visit(&mut printer);
    printer.lines()
}

/// Those that say what their absence would say too are left out.
fn controller_lines(controller: &Controller) -> Lines {
    let lines = |mut controller: Controller| {
        let mut printer = Printer::new(BTreeMap::new());
        controller.visit(&mut printer);
        printer.lines()
    };
    let absent = lines(Controller::default());
    lines(controller.clone()).into_iter().filter(|line| !absent.contains(line)).collect()
}

/// The text with these keys of a top-level table taken out and these lines in their place.
fn replaced(text: &str, table: &str, keys: &[&str], lines: &[(String, String)]) -> String {
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut surgery =
        Surgery { table, keys, lines, end, out: String::new(), inserted: false, section: vec![] };
    for statement in statements(text) {
        surgery.take(text.get(statement.range.clone()).unwrap_or_default(), &statement);
    }
    if !surgery.inserted {
        surgery.end_line();
        surgery.out.push_str(&format!("{end}[{table}]{end}"));
        surgery.insert("");
    }
    surgery.out
}

/// A text on its way from statement to statement.
struct Surgery<'a> {
    table: &'a str,
    /// Keys of it that are taken out.
    keys: &'a [&'a str],
    lines: &'a [(String, String)],
    /// End of a line.
    end: &'static str,
    out: String,
    inserted: bool,
    /// Path of the present table.
    section: Vec<String>,
}

impl Surgery<'_> {
    fn take(&mut self, written: &str, statement: &Statement) {
        match &statement.content {
            Content::Nothing => self.out.push_str(written),
            Content::Header(path) => {
                self.section = path.clone();
                if !self.is_replaced(path) {
                    self.out.push_str(written);
                }
                if path.len() == 1 && path.first().is_some_and(|first| first == self.table) {
                    self.end_line();
                    self.insert("");
                }
            }
            Content::Value { path, value } => {
                let whole = [self.section.as_slice(), path].concat();
                let is_table = whole.len() == 1 && whole.first().is_some_and(|first| first == self.table);
                if is_table {
                    return self.inline(written, value.clone());
                }
                // dotted keys above every header
                let dotted =
                    self.section.is_empty() && whole.first().is_some_and(|first| first == self.table);
                if dotted && !self.inserted {
                    self.insert(&format!("{}.", self.table));
                }
                if !self.is_replaced(&whole) {
                    self.out.push_str(written);
                }
            }
        }
    }

    /// Whether a key or table is part of what is replaced.
    fn is_replaced(&self, path: &[String]) -> bool {
        matches!(path, [table, key, ..] if table == self.table && self.keys.contains(&key.as_str()))
    }

    fn insert(&mut self, prefix: &str) {
        self.inserted = true;
        for (key, value) in self.lines {
            self.out.push_str(&format!("{prefix}{key} = {value}{}", self.end));
        }
    }

    /// `controller = { ... }`: what stays of it and the new entries, in one line.
    fn inline(&mut self, written: &str, value: std::ops::Range<usize>) {
        self.inserted = true;
        let kept = entries(written.get(value.clone()).unwrap_or_default());
        let kept =
            kept.into_iter().filter(|(key, _)| !self.keys.contains(&key.as_str())).map(|(_, text)| text);
        let new = self.lines.iter().map(|(key, value)| format!("{key} = {value}"));
        let all: Vec<String> = new.chain(kept).collect();
        let (before, after) = (written.get(..value.start), written.get(value.end..));
        let text =
            format!("{}{{ {} }}{}", before.unwrap_or_default(), all.join(", "), after.unwrap_or_default());
        self.out.push_str(&text);
    }

    fn end_line(&mut self) {
        if !self.out.is_empty() && !self.out.ends_with('\n') {
            self.out.push_str(self.end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Lines {
        [("gain", "2"), ("poles", "[0]")].map(|(key, value)| (key.to_string(), value.to_string())).to_vec()
    }

    fn rewritten(text: &str) -> String {
        replaced(text, "controller", &LAW, &law())
    }

    #[test]
    fn a_table_keeps_its_other_keys_and_comments() {
        let text = "a = \"[controller]\"\n[controller]  # G\nnumerator = \"s\"  # old\n# why\ndelay = \"1 ms\"\ndenominator = '''\ns'''\n\n[x]\ngain = 1\n";
        let expected = "a = \"[controller]\"\n[controller]  # G\ngain = 2\npoles = [0]\n# why\ndelay = \"1 ms\"\n\n[x]\ngain = 1\n";
        assert_eq!(rewritten(text), expected);
    }

    #[test]
    fn elements_go_in_every_form() {
        let expected = "[controller]\ngain = 2\npoles = [0]\ndelay = 1\n[x]\nelements = 1\n";
        for elements in
            ["elements = [\n  { kind = \"gain\", value = 1 }, # one\n  { kind = \"integrator\" },\n]\n", ""]
        {
            let text = format!("[controller]\n{elements}delay = 1\n[x]\nelements = 1\n");
            assert_eq!(rewritten(&text), expected);
        }
        let tables = "[controller]\ndelay = 1\n[[controller.elements]]\nkind = \"gain\"\nvalue = 1\n[[controller . \"elements\"]]\nkind = \"integrator\"\n[x]\nelements = 1\n";
        assert_eq!(rewritten(tables), expected);
    }

    #[test]
    fn dotted_inline_and_absent_tables() {
        assert_eq!(
            rewritten("controller.numerator = \"1\"\ncontroller.delay = 1\n[x]\n"),
            "controller.gain = 2\ncontroller.poles = [0]\ncontroller.delay = 1\n[x]\n"
        );
        assert_eq!(
            rewritten("controller = { numerator = \"1, 2\", delay = 1, zeros = [1, [2, 3]] } # c\n[x]\n"),
            "controller = { gain = 2, poles = [0], delay = 1 } # c\n[x]\n"
        );
        assert_eq!(rewritten("[x]\ny = 1"), "[x]\ny = 1\n\n[controller]\ngain = 2\npoles = [0]\n");
        assert_eq!(
            rewritten("[x]\r\ny = 1\r\n"),
            "[x]\r\ny = 1\r\n\r\n[controller]\r\ngain = 2\r\npoles = [0]\r\n"
        );
        // a table within it stays
        assert_eq!(
            rewritten("[controller.q]\ngain = 1\n"),
            "[controller.q]\ngain = 1\n\n[controller]\ngain = 2\npoles = [0]\n"
        );
    }

    #[test]
    fn what_a_setting_says_beside_the_law_is_written_with_it() {
        use crate::project::{FeedForward, Quantization};
        let text =
            "[controller]\ngain = 1\n[controller.quantization]\ncommand_bits = 8\n[prefilter]\ngain = 1\n";
        let transfer = Transfer { gain: Some(2.0), ..Transfer::default() };
        let controller = Controller {
            transfer: transfer.clone(),
            sample_time: Some(1e-3),
            quantization: Some(Quantization { command_bits: 12, ..Quantization::default() }),
            load_velocity_feed_forward: Some(FeedForward { gain: Some(3.0) }),
            ..Controller::default()
        };
        let prefilter = Prefilter { transfer, continuous: true, ..Prefilter::default() };
        let written = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|setting| setting.to_string()).collect();
            String::from_utf8(with_laws(text.as_bytes(), &settings, &controller, Some(&prefilter))).unwrap()
        };
        // without a setting the text says it already
        assert_eq!(written(&[]), text.replace("gain = 1", "gain = 2"));
        let set = written(&["controller.sample_time=1e-3", "prefilter.continuous=true"]);
        for line in [
            "sample_time = ",
            "quantization = { command_bits = 12",
            "load_velocity_feed_forward = { gain = 3 }",
        ] {
            assert_eq!(set.matches(line).count(), 1, "{line} in\n{set}");
        }
        assert!(set.ends_with("[prefilter]\ngain = 2\ncontinuous = true\n"), "{set}");
        assert!(!set.contains("command_bits = 8") && !set.contains("[controller.quantization]"), "{set}");
        let pasted = snippet(&controller, Some(&prefilter));
        assert!(pasted.contains("load_velocity_feed_forward = {") && pasted.ends_with("continuous = true\n"));
    }
}
