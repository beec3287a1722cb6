//! A key in percent accepts the percent sign, in every form of its number.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use phea_project::source::Memory;
use phea_project::{self as project, Loaded, STARTER};
use phea_quantity::PERCENT;

fn read(text: &str, settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    let source = Memory::default().with("rig.toml", text);
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// Single rule for all of them: the dimension of the key.
#[test]
fn every_key_named_percent_is_a_percentage() {
    let keys = project::keys();
    let named: Vec<_> = keys.iter().filter(|entry| entry.path.contains("percent")).collect();
    assert!(named.len() >= 3, "{named:?}");
    for entry in named {
        assert!(std::ptr::eq(entry.key.dimension, &PERCENT), "{}", entry.path);
    }
}

fn with(scenario: &str) -> String {
    format!(
        "{STARTER}\n[[scenario]]\nname = \"percent\"\n{scenario}\nduration = \"1 s\"\nreference = {{ at = \"0.1 s\", force = \"100 N\" }}\n"
    )
}

#[test]
fn two_percent_are_two_in_text_number_setting_and_band() {
    let last = |loaded: &Loaded| loaded.project.scenarios.last().unwrap().settling_band_percent;
    for written in ["\"2 %\"", "\"2\"", "2", "\"2 percent\""] {
        assert_eq!(last(&read(&with(&format!("settling_band_percent = {written}")), &[])), 2.0, "{written}");
    }
    let index = read(&with(""), &[]).project.scenarios.len() - 1;
    for written in ["2 %", "2", "\"2 %\""] {
        let setting = format!("scenario.{index}.settling_band_percent={written}");
        assert_eq!(last(&read(&with(""), &[&setting])), 2.0, "{written}");
    }
    let printed = project::print(&read(&with("settling_band_percent = \"2 %\""), &[]).project);
    assert!(printed.contains("settling_band_percent = 2\n"), "{printed}");
}

/// A spread is a fraction of the declared value, in either spelling.
#[test]
fn a_spread_of_ten_percent_is_a_tenth() {
    let campaign = |spread: &str| {
        read(
            &format!("{STARTER}\n[campaign.parameters]\n\"supply.pressure\" = {{ spread = {spread} }}\n"),
            &[],
        )
        .project
        .campaign
    };
    assert_eq!(campaign("\"10 %\""), campaign("0.1"));
}

/// Forms of a limit are not among the listed keys.
#[test]
fn a_requirement_in_time_accepts_percent_in_text() {
    let text = |overshoot: &str, band: &str| {
        format!(
            "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n[[specification]]\nkind = \"tracking\"\nfrequencies = [1]\nlower = 1e-3\n[specification.upper]\novershoot_percent = {overshoot}\nsettling_time = \"0.1 s\"\nsettling_band_percent = {band}\n"
        )
    };
    let limits = |text: &str| read(text, &[]).project.specifications;
    assert_eq!(limits(&text("\"2 %\"", "\"1 %\"")), limits(&text("2", "1")));
}
