//! The chapters of the report for which the nonlinear machine is driven: scenarios, sensitivity,
//! campaign.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::report_page::{nominal, report_of};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project;
use phea_workbench::report::{Report, report, runs_within_budget};
use phea_workbench::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");

/// A report without its specifications, which these chapters do not need.
fn reported(text: &str, settings: &[&str]) -> Report {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let source = Memory::default().with("rig.toml", text);
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    report(&source, &loaded, &Setup::new(&loaded.project).unwrap(), None, &mut |_| true).unwrap()
}

fn without(text: &str, first: &str, until: &str) -> String {
    let (before, rest) = text.split_once(first).unwrap();
    format!("{before}{until}{}", rest.split_once(until).unwrap().1)
}

/// Text between the anchor of a chapter and its end.
fn chapter<'a>(report: &'a Report, anchor: &str) -> &'a str {
    let start = report.html.find(&format!("<section id=\"{anchor}\">")).expect("the chapter is there");
    let rest = &report.html[start..];
    &rest[..rest.find("</section>").unwrap()]
}

/// The cells of the row that begins with this text.
fn row(chapter: &str, first: &str) -> Vec<String> {
    let begins =
        |row: &&str| row.split_once('>').is_some_and(|(_, text)| text.starts_with(&format!("{first}</td>")));
    let mut rows = chapter.split("<tr>").map(|row| row.split("</tr>").next().unwrap());
    let row = rows.find(begins).unwrap_or_else(|| panic!("no {first}"));
    let cells = row.split("<td").skip(1).map(|cell| cell.split_once('>').unwrap().1);
    cells.map(|cell| cell.trim_end_matches("</td>").to_string()).collect()
}

/// Every step of a reference has its own row, with published numbers below; unpublished numbers are
/// mentioned once.
#[test]
fn every_event_has_its_row_and_the_published_value() {
    let text = without(HOSE, "[[specification]]", "[controller] ");
    let text = without(&text, "[design] ", "[[scenario]]");
    let report = reported(&text, &[]);
    let chapter = chapter(&report, "simulation");
    let step = row(chapter, "step to 4 kN at 2 s");
    assert_eq!((step.len(), step[3].as_str()), (8, "0.287 s"));
    let published = row(chapter, "Ledezma (2019), Figure 6.18");
    assert_eq!(published[1..4], ["2.15 %", "-", "0.200 s"]);
    let heights = [
        "1 kN at 1 s",
        "3 kN at 2 s",
        "4 kN at 3 s",
        "2 kN at 4 s",
        "-1 kN at 5 s",
        "-4 kN at 6 s",
        "0 kN at 7 s",
    ];
    for height in heights {
        // overshoot, rise, settling, error and command, but no load that moves
        let cells = row(chapter, &format!("step to {height}"));
        assert_eq!(cells.len(), 7, "{cells:?}");
        let rise: f64 = cells[2].trim_end_matches(" s").parse().unwrap();
        let settling: f64 = cells[3].trim_end_matches(" s").parse().unwrap();
        assert!(0.1 < rise && rise < settling && settling < 0.5, "{cells:?}");
    }
    assert_eq!(chapter.matches("these steps were chosen").count(), 1);
    // the whole and two events of the first scenario; of seven steps only the greatest
    let names: Vec<&str> = report.figures.iter().map(|figure| figure.name.as_str()).collect();
    let drawn: Vec<&&str> = names.iter().filter(|name| name.starts_with("simulation-")).collect();
    let expected = [
        "simulation-1",
        "simulation-1-event-1",
        "simulation-1-event-2",
        "simulation-2",
        "simulation-2-event-7",
    ];
    assert_eq!(drawn, expected.iter().collect::<Vec<_>>());
    // enlarged figures show both forces, and positions too if the load moves
    let shows = |name: &str, text: &str| {
        let figure = report.figures.iter().find(|figure| figure.name == name).unwrap();
        figure.to_svg_standalone().contains(text)
    };
    let of = |text: &str| expected.map(|name| shows(name, text));
    assert_eq!(of("hydraulic force"), [false, true, true, false, true]);
    assert_eq!(of("Position"), [true, false, true, true, false]);
    // each quantity of the sensitivity is named once for each event of the first scenario
    let symbol = "Sensor stiffness <span class=\"equation\"><i>K</i><sub>S</sub></span>";
    let sensitivity = self::chapter(&report, "sensitivity");
    let declared = "20.0 MN/m, as declared";
    assert_eq!((sensitivity.matches(symbol).count(), sensitivity.matches(declared).count()), (2, 2));
    assert!(!sensitivity.contains("K_S"));
}

/// Bands, spreads and the worst runs with the command that repeats one of them.
#[test]
fn a_campaign_has_its_chapter() {
    let report = reported(CAMPAIGN, &["scenario.0.duration=3.3 s"]);
    let chapter = chapter(&report, "campaign");
    let number = |text: &str| text.split(' ').next().unwrap().parse::<f64>().unwrap();
    let overshoot = row(chapter, "overshoot (%)");
    let quantiles: Vec<f64> = overshoot[1..6].iter().map(|cell| number(cell)).collect();
    assert!(quantiles.is_sorted() && number(&overshoot[6]) >= quantiles[4], "{overshoot:?}");
    // the run that is worst in most metrics comes first
    let peak = row(chapter, "disturbance peak (kN)");
    let worst = peak[6].split_once('(').unwrap().1.trim_end_matches(')').to_string();
    let of = &row(chapter, &worst)[1];
    assert!(of.contains("load motion at 3 s: disturbance peak") && of.contains("control rms"), "{of}");
    assert!(chapter.contains(&format!("phea campaign PROJECT.toml --seed 1 --run {worst}")));
    assert!(chapter.find(&format!(">{worst}</td>")) < chapter.find(": overshoot</td>"));
    // a drawn number is within its range
    let pressure = row(chapter, "<code>supply.<wbr>pressure</code>");
    assert_eq!((pressure[1].as_str(), pressure.len()), ("<span class=\"unit\">bar</span>", 8));
    let [from, to] = [number(&pressure[2]), number(&pressure[3])];
    assert_eq!((from, to), (56.0, 84.0));
    assert!(pressure[4..].iter().all(|cell| (from..=to).contains(&number(cell))), "{pressure:?}");
}

/// A sine is drawn for two of its cycles, whatever the duration of the scenario; other references
/// as long as they move.
#[test]
fn a_sine_is_shown_for_two_cycles() {
    let text = without(HOSE, "[[specification]]", "[controller] ");
    let (before, _) = text.split_once("[design] ").unwrap();
    for (frequency, cycles) in
        [("2 Hz", "the first 1.00 s of 4.00 s"), ("4 Hz", "the first 0.500 s of 4.00 s")]
    {
        let scenario = format!(
            "[[scenario]]\nname = \"sine\"\nduration = \"4 s\"\n\
             reference = {{ kind = \"sine\", start = \"0 s\", amplitude = \"1 kN\", frequency = \"{frequency}\" }}\n"
        );
        let report = reported(&format!("{before}{scenario}"), &[]);
        let chapter = chapter(&report, "simulation");
        assert!(chapter.contains(cycles), "{frequency}");
        let event = report.figures.iter().find(|figure| figure.name == "simulation-1-event-1").unwrap();
        assert!(event.to_svg_standalone().contains(">error<"));
    }
    let ramp = "[[scenario]]\nname = \"ramp\"\nduration = \"4 s\"\n\
        reference = { kind = \"ramp\", start = \"0 s\", duration = \"1 s\", force = \"1 kN\" }\n";
    let report = reported(&format!("{before}{ramp}"), &[]);
    assert!(chapter(&report, "simulation").contains("over the whole scenario"));
}

/// The project states the number of runs in its report.
#[test]
fn the_number_of_runs_is_that_of_the_project() {
    for runs in [12, 20] {
        let settings = ["scenario.0.duration=2.5 s".to_string(), format!("campaign.runs={runs}")];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let report = reported(CAMPAIGN, &settings);
        assert!(chapter(&report, "campaign").contains(&format!("{runs} runs of the scenario")), "{runs}");
    }
}

/// The assumptions are those of the rig: no hose, no words on hoses; a supply of constant pressure.
#[test]
fn assumptions_are_those_of_the_rig() {
    let hose = reported(&without(HOSE, "[[specification]]", "[controller] "), &[]);
    let volumes = reported(CAMPAIGN, &["scenario.0.duration=2.5 s", "campaign.runs=8"]);
    let [hose, volumes] = [&hose, &volumes].map(|report| chapter(report, "provenance"));
    assert!(hose.contains("wall of a hose") && !volumes.contains("wall of a hose"));
    assert!(hose.contains("no waves travel in it"));
    // the time constant is stated, and the hose judged by one modulus
    assert!(hose.contains("its time constant is stated, and it settles to 2 % in 3.91 time constants"));
    assert!(hose.contains("taken at the supply pressure"));
    assert!(!volumes.contains("no waves travel in it") && volumes.contains("by its viscous part alone"));
}

/// A hose with compliance by volume holds its oil at the mean pressure, and a stated settling time
/// gives the time constant by its band.
#[test]
fn assumptions_follow_from_stated_values() {
    let text = without(HOSE, "[[specification]]", "[controller] ");
    let text = without(&text, "[design] ", "[[scenario]]")
        .replace("time_constant = \"50 ms\"", "settling_time = \"200 ms\"\nsettling_band_percent = 1");
    let (rig, _) = text.split_once("[[scenario]]").unwrap();
    let report = reported(rig, &["line.compliance=by_volume"]);
    let assumptions = chapter(&report, "provenance");
    assert!(
        assumptions.contains("follows from the stated settling time, and it settles to 1 % in 4.61"),
        "{assumptions}"
    );
    assert!(
        assumptions.contains("at the mean of supply and tank pressure")
            && !assumptions.contains("at the supply pressure")
    );
}

/// The step of a tracking specification, by its time.
const IN_TIME: &str = "[[specification]]\nkind = \"tracking\"\nfrequencies = [0.1, 1]\nband = [0.1, 1]\n\
    [specification.upper]\novershoot_percent = 1\nsettling_time = \"0.4 s\"\nsettling_band_percent = 1\nzero = \"60 rad/s\"\n\
    [specification.lower]\nsettling_time = \"0.8 s\"\nsettling_band_percent = 1\npole = \"60 rad/s\"\n";

/// The first page reports for a requirement in time the worst over the runs of the campaign too,
/// for a sampled loop and a delayed one as for a continuous one, and over other numbers.
#[test]
fn the_first_page_takes_the_worst_of_the_campaign() {
    let text = format!("{CAMPAIGN}\n{IN_TIME}");
    let cases: [&[&str]; 4] = [
        &[],
        &["controller.sample_time=1 ms"],
        &["controller.delay=1 ms"],
        &["campaign.parameters={ \"supply.pressure\" = { minimum = \"50 bar\", maximum = \"100 bar\" } }"],
    ];
    for more in cases {
        let settings = [&["scenario.0.duration=2.9 s", "campaign.runs=12"], more].concat();
        let report = reported(&text, &settings);
        let settling = row(chapter(&report, "campaign"), "settling to 1 % (s)");
        let (worst, run) = settling[6].split_once(" (").expect("a run");
        let (_, page) = report.html.split_once("id=\"decision\">").expect("the first page");
        let page = page.split("</section>").next().unwrap();
        let worst = format!("{:.3} s at worst (campaign, run {run}", worst.parse::<f64>().unwrap());
        assert!(page.replace('\u{a0}', " ").contains(&worst), "{more:?}: {worst}");
    }
}

/// A settling time, in the required band, that no step satisfies.
const STEP: &str =
    "[[specification]]\nkind = \"step\"\nsettling_time = \"10 ms\"\nsettling_band_percent = 1e-6\n";

/// A run of several steps counts once; a step that does not settle is known over its window only;
/// and the advice is for a project with a required step, which has no limits of tracking to
/// tighten.
#[test]
fn runs_are_counted_and_the_advice_is_for_a_required_step() {
    let settings = [
        "scenario.0.duration=0.6 s",
        "scenario.0.settling_band_percent=1e-6",
        "scenario.0.reference=[{ at = \"0.1 s\", force = \"1 kN\" }, { at = \"0.3 s\", force = \"2 kN\" }]",
        "scenario.0.load_motion={ kind = \"smooth_step\", start = \"0.5 s\", duration = \"50 ms\", distance = \"1 mm\" }",
        "campaign.runs=8",
    ];
    let report = reported(&format!("{CAMPAIGN}\n{STEP}"), &settings);
    let (_, page) = report.html.split_once("id=\"decision\">").expect("the first page");
    let page = page.split("</section>").next().unwrap().replace('\u{a0}', " ");
    assert!(page.contains("missed by 100 % of 8 completed campaign runs"), "{page}");
    assert!(page.contains("not settled within its window at worst"), "{page}");
    let next = &report.decision.next;
    let advice = next.iter().find(|step| step.contains("does not settle within its window")).unwrap();
    assert!(!advice.contains("limits of tracking"), "{advice}");
    assert!(advice.contains("of kind `step`") || advice.contains("by the linear loop too"), "{advice}");
    let tracking = reported(&format!("{CAMPAIGN}\n{IN_TIME}"), &settings).decision.next;
    assert!(!tracking.iter().any(|step| step.contains("of kind `step`")), "{tracking:?}");
}

/// A report has as many runs as its budget of integration steps permits, estimated from the first
/// of them, and at least these.
#[test]
fn a_campaign_satisfies_its_budget_of_steps() {
    // ORIGIN: analytic, ten million steps over those of a run
    for (steps_of_a_run, runs) in [(3_000, 500), (20_000, 500), (40_000, 250), (1_000_000, 10)] {
        assert_eq!(runs_within_budget(500, [8, 8 * steps_of_a_run]), runs, "{steps_of_a_run}");
    }
    assert_eq!(runs_within_budget(500, [8, 8 * 10_000_000]), 8, "those that were made");
    assert_eq!(runs_within_budget(500, [8, 0]), 500, "none was completed");
    assert_eq!(runs_within_budget(5, [5, 5 * 3_000]), 5);
}

#[test]
fn without_leakage_the_force_of_the_open_loop_remains() {
    let caption = |settings: &[&str]| {
        let report = report_of(&nominal(), settings);
        report.figures.iter().find(|figure| figure.name == "load-motion").unwrap().caption.clone()
    };
    assert!(caption(&[]).contains("In the end nothing remains."));
    let tight = caption(&[
        "linear.flow_pressure_coefficient=0",
        "uncertainty.flow_pressure_coefficient.minimum=0",
        "uncertainty.flow_pressure_coefficient.spacing=linear",
    ]);
    assert!(tight.contains("In the end there remains -") && tight.contains("kN open loop"), "{tight}");
}

#[test]
fn a_loop_with_dead_time_has_its_step() {
    let html = report_of(&nominal(), &["controller.delay=\"1 ms\""]).html;
    assert!(html.contains("The closed loop is stable.") && !html.contains("No step response"));
}
