//! Names of the files that a command may write, known before it runs.

use phea_engineering::design::{DESIGNED_CERTIFICATE, DESIGNED_PROJECT, NEAREST_PROJECT};
use phea_engineering::simulate::file_names;

use crate::answer::TableFormat;
use crate::audit::CERTIFICATE_FILE;
use crate::export::identifier;
use crate::project::{AS_DECLARED, Loaded, Project};
use crate::shaping::SHAPED_PROJECT;

use super::{CampaignRuns, Request};

/// Names of the files that a command may write into its folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OutputNames {
    exact: Vec<String>,
    /// Numbered names, each as the part before the number and the ending.
    numbered: Vec<[String; 2]>,
}

/// Files of the stages of a design and of the audit of its result.
const OF_DESIGN: [&str; 13] = [
    DESIGNED_PROJECT,
    NEAREST_PROJECT,
    DESIGNED_CERTIFICATE,
    CERTIFICATE_FILE,
    "bounds.csv",
    "templates.csv",
    "loop.csv",
    "prefilter_band.csv",
    "rounds.csv",
    "margins.csv",
    "controller.json",
    "prefilter.json",
    "verification.json",
];

/// Files of the virtual tests of valve, cylinder and lines.
const OF_BENCH: [&str; 11] = [
    "leakage.csv",
    "metering.csv",
    "metering_low_flow.csv",
    "pressure_gain.csv",
    "reversals.csv",
    "sliding.csv",
    "breakaway.csv",
    "breakaway_back.csv",
    "shaken.csv",
    "line_pressure_rise.csv",
    "line_frequency_response.csv",
];

/// Files of everything that can be identified from recordings.
const OF_IDENTIFICATION: [&str; 5] =
    ["valve.toml", "uncertainty.toml", "measured.toml", "line.toml", "friction.toml"];

const ALTERNATIVES: [&str; 3] = ["alternatives.csv", "load_cases.csv", "front.csv"];

impl OutputNames {
    /// Returns the names for a request on a project.
    pub fn of(loaded: &Loaded, request: &Request) -> OutputNames {
        let project = &loaded.project;
        match request {
            Request::Check => OutputNames::exact(&["derived.csv"]),
            Request::Size { .. } => OutputNames::exact(&["sizing.csv"]),
            Request::Linearize { .. } => OutputNames::exact(&["poles.csv", "sweep.csv"]),
            Request::Verify { .. } => OutputNames::exact(&["margins.csv", CERTIFICATE_FILE]),
            Request::Shape { .. } => OutputNames::exact(&["margins.csv", SHAPED_PROJECT]),
            Request::Design { .. } => OutputNames::exact(&OF_DESIGN),
            Request::Simulate(request) => OutputNames::of_scenarios(project, request.table),
            Request::Compare => OutputNames::default(),
            Request::Alternatives(_) => OutputNames::of_alternatives(project),
            Request::Campaign(campaign) => match campaign.runs {
                CampaignRuns::One(_) => OutputNames::of_scenarios(project, TableFormat::Csv),
                CampaignRuns::All(_) => OutputNames::exact(&["runs.csv", "runs.csv.ahead", "runs.parquet"]),
            },
            Request::Bench => OutputNames::exact(&OF_BENCH),
            Request::Export { kind } => {
                let names = identifier(&project.title).map(|name| kind.file_names(&name));
                OutputNames { exact: names.unwrap_or_default(), ..OutputNames::default() }
            }
            Request::Report { .. } => OutputNames::exact(&OF_DESIGN).and(&["report.html"]),
        }
    }

    /// Returns the names for an identification from these recordings.
    pub fn of_identification(files: &[String]) -> OutputNames {
        let stem = |file: &String| {
            let name = file.rsplit(['/', '\\']).next().unwrap_or_default();
            name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_string()
        };
        let responses = files.iter().map(|file| [stem(file), "response.csv".to_string()]);
        OutputNames { numbered: responses.collect(), ..OutputNames::exact(&OF_IDENTIFICATION) }
    }

    fn exact(names: &[&str]) -> OutputNames {
        OutputNames::default().and(names)
    }

    fn and(mut self, names: &[&str]) -> OutputNames {
        self.exact.extend(names.iter().map(|name| name.to_string()));
        self
    }

    /// The table of each scenario and the state at its end, or a frequency response.
    fn of_scenarios(project: &Project, format: TableFormat) -> OutputNames {
        let table = format.ending();
        let names = file_names(project.scenarios.iter().map(|scenario| scenario.name.as_str()));
        let of_one = |name: String| [[name.clone(), table.to_string()], [name, "state.toml".to_string()]];
        let responses = ["open_loop", "closed_loop"].map(|name| format!("frequency_response_{name}.{table}"));
        OutputNames { exact: responses.to_vec(), numbered: names.into_iter().flat_map(of_one).collect() }
    }

    /// The tables, and the project of each alternative in each load case.
    fn of_alternatives(project: &Project) -> OutputNames {
        let own = project.alternatives.iter().map(|one| one.name.clone());
        let all: Vec<String> = std::iter::once(AS_DECLARED.to_string()).chain(own).collect();
        let cases = project.load_cases.iter();
        let in_cases = cases.flat_map(|case| all.iter().map(move |name| format!("{name}, {}", case.name)));
        let names: Vec<String> = all.iter().cloned().chain(in_cases).collect();
        let names = file_names(names.iter().map(String::as_str));
        let numbered = names.into_iter().map(|name| [name, "toml".to_string()]);
        OutputNames { numbered: numbered.collect(), ..OutputNames::exact(&ALTERNATIVES) }
    }

    /// True if a file of this name may be written; every drawing may. Names that differ only in
    /// case count as one, as on some file systems.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::command::OutputNames;
    /// let names = OutputNames::of_identification(&["rig/Step.csv".to_string()]);
    /// assert!(names.contains("valve.toml") && names.contains("step-2.response.csv"));
    /// assert!(!names.contains("step.csv"));
    /// ```
    pub fn contains(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        let is_drawing = [".svg", ".png"].iter().any(|ending| name.ends_with(ending));
        let is_numbered = |[stem, ending]: &[String; 2]| {
            let (stem, ending) = (stem.to_lowercase(), format!(".{ending}").to_lowercase());
            name.strip_suffix(&ending).is_some_and(|rest| rest == stem || without_number(rest) == Some(&stem))
        };
        is_drawing
            || self.exact.iter().any(|exact| exact.to_lowercase() == name)
            || self.numbered.iter().any(is_numbered)
    }
}

/// A name without the distinguishing number at its end; `None` if it has none.
fn without_number(name: &str) -> Option<&str> {
    let plain = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    plain.strip_suffix([' ', '-']).filter(|_| plain.len() < name.len())
}
