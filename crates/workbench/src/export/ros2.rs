//! Controller as a package of ros2_control around the C functions.

use super::c;
use super::{DeployedSignal, ExportedController};
use crate::answer::OutputFile;

/// Files of the package beside those of C, each with its template: `NAME` stands before an ending
/// that begins with `_`.
const TEMPLATES: [(&str, &str, Comment); 7] = [
    ("_controller.hpp", include_str!("ros2/controller.hpp"), Comment::C),
    ("_controller.cpp", include_str!("ros2/controller.cpp"), Comment::C),
    ("_plugin.xml", include_str!("ros2/plugin.xml"), Comment::None),
    ("_parameters.yaml", include_str!("ros2/parameters.yaml"), Comment::Hash),
    ("CMakeLists.txt", include_str!("ros2/CMakeLists.txt"), Comment::Hash),
    ("package.xml", include_str!("ros2/package.xml"), Comment::None),
    ("README.md", include_str!("ros2/README.md"), Comment::None),
];

/// How a head is written into a file.
#[derive(Clone, Copy)]
enum Comment {
    C,
    Hash,
    None,
}

/// Names of the files.
pub(super) fn file_names(name: &str) -> Vec<String> {
    TEMPLATES.iter().map(|(ending, ..)| file_name(name, ending)).collect()
}

fn file_name(name: &str, ending: &str) -> String {
    if ending.starts_with('_') { format!("{name}{ending}") } else { ending.to_string() }
}

/// Samples per second, if it is a whole number, as ros2_control has it.
pub fn update_rate(exported: &ExportedController) -> Option<u32> {
    let rate = 1.0 / exported.deployed.controller.sample_time_s();
    let whole = rate.round();
    let is_whole = (rate - whole).abs() <= 1e-9 * rate && (1.0..1e6).contains(&whole);
    is_whole.then_some(whole as u32)
}

/// The package; no file for a sample time without a whole number of samples per second.
pub fn files(exported: &ExportedController) -> Vec<OutputFile> {
    let Some(rate) = update_rate(exported) else { return vec![] };
    let texts = Texts::new(exported, rate);
    let own = TEMPLATES.iter().map(|(ending, template, comment)| {
        let text = texts.filled(template);
        let head = &texts.head;
        let text = match comment {
            Comment::C => format!("{}\n{text}", c::comment(head)),
            Comment::Hash => {
                let lines = head.iter().map(|line| format!("{}\n", format!("# {line}").trim_end()));
                format!("{}\n{text}", lines.collect::<String>())
            }
            Comment::None => text,
        };
        OutputFile::new(file_name(&exported.name, ending), text)
    });
    c::files(exported).into_iter().chain(own).collect()
}

/// Texts that replace the words between `@` in a template.
struct Texts {
    head: Vec<String>,
    words: [(&'static str, String); 10],
}

impl Texts {
    fn new(exported: &ExportedController, rate: u32) -> Texts {
        let head = exported.head();
        let signals: Vec<&str> = exported
            .signals()
            .into_iter()
            .filter(|signal| *signal != DeployedSignal::Reference)
            .map(DeployedSignal::name)
            .collect();
        let quoted: Vec<String> = signals.iter().map(|name| format!("\"{name}\"")).collect();
        let read = signals.iter().enumerate().map(|(index, name)| {
            format!("  signals.{name} = value_of(state_interfaces_[places_[{index}]], 0);\n")
        });
        let interfaces = signals.iter().map(|name| format!("    {name}_interface: sensor/{name}\n"));
        let name = &exported.name;
        let words = [
            ("GUARD", name.to_uppercase()),
            ("NAME", name.clone()),
            ("COUNT", signals.len().to_string()),
            ("SIGNALS", quoted.join(", ")),
            ("READ", read.collect()),
            ("INTERFACES", interfaces.collect()),
            ("RATE", rate.to_string()),
            ("VERSION", exported.contract.version.to_string()),
            ("TITLE", escaped(&exported.contract.title)),
            ("HEAD", head.join("\n").replace("```", "'''")),
        ];
        Texts { head, words }
    }

    /// A template with its words replaced, each place once.
    fn filled(&self, template: &str) -> String {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, after)) = rest.split_once('@') {
            text.push_str(before);
            let known = after.split_once('@').and_then(|(word, after)| {
                let is_word = |(known, _): &&(&str, String)| *known == word;
                self.words.iter().find(is_word).map(|(_, value)| (value, after))
            });
            rest = match known {
                Some((value, after)) => {
                    text.push_str(value);
                    after
                }
                None => {
                    text.push('@');
                    after
                }
            };
        }
        text + rest
    }
}

/// A text between tags of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
