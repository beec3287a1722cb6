//! The report: one self-contained page, whatever the title of its project, and reproducible.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{self, HOSE, PIPE, answer, load, try_answer};
use std::sync::OnceLock;

use phea_qft::verification::Verdict;
use phea_workbench::answer::{Answer, picture_of};
use phea_workbench::command::Request;
use phea_workbench::report::{Report, report};
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;
use phea_workbench::trial::Agreement;
use resvg::usvg::roxmltree::{Document, Node};

const PLANT: &str = include_str!("truth/plant.toml");

fn report_answer(project: &str) -> Answer {
    answer(&without_design(project), &[], &[], &Request::Report { files: true, alternatives: false })
}

/// The project without its section [design]: a search takes time, and most tests are about other
/// chapters.
fn without_design(project: &str) -> String {
    let Some((start, rest)) = project.split_once("[design]") else { return project.to_string() };
    let end = rest.find("\n[").map_or("", |end| &rest[end..]);
    format!("{start}{end}")
}

/// The rig and its controller without specifications, design and scenarios: all that tests of the
/// nominal loop need.
pub(crate) fn nominal() -> String {
    let (rig, rest) = HOSE.split_once("[[specification]]").unwrap();
    let (_, rest) = rest.split_once("[controller]").unwrap();
    let (controller, _) = rest.split_once("[design]").unwrap();
    format!("{rig}[controller]{controller}")
}

/// The reports of both rigs as their command writes them, drawn once.
fn hose() -> &'static Answer {
    static ANSWER: OnceLock<Answer> = OnceLock::new();
    ANSWER.get_or_init(|| report_answer(HOSE))
}

fn pipe() -> &'static Answer {
    static ANSWER: OnceLock<Answer> = OnceLock::new();
    ANSWER.get_or_init(|| report_answer(PIPE))
}

fn page(answer: &Answer) -> &str {
    let file = answer.files.iter().find(|file| file.name == "report.html").unwrap();
    std::str::from_utf8(&file.bytes).unwrap()
}

/// The report of the hose without its sizing chapter and its pictures, computed once.
fn plain_hose() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| plain_report(HOSE))
}

/// The report without its sizing chapter and its pictures, which is all that many tests need.
fn plain_report(project: &str) -> Report {
    report_of(&without_design(project), &[])
}

/// Families with lines in motion have no polynomials, but have step responses.
#[test]
fn a_family_with_lines_in_motion_has_its_steps_drawn() {
    let settings = ["line.model=segments", "line.segments=4", "line.relaxation_time=0.3 ms"];
    let (project, _) = HOSE.split_once("[design]").unwrap();
    let report = report_of(project, &settings);
    assert!(report.figures.iter().any(|found| found.name == "family_steps"));
}

/// Text between `<name` and `</name>`, the tags included.
fn elements<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let (open, close) = (format!("<{name}"), format!("</{name}>"));
    let mut found = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find(&open) {
        let end = start + rest[start..].find(&close).expect("an element is closed") + close.len();
        found.push(&rest[start..end]);
        rest = &rest[end..];
    }
    found
}

/// The values of an attribute anywhere on the page.
fn attributes<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!(" {name}=\"");
    page.split(&start).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn a_page_is_self_contained() {
    for answer in [hose(), pipe()] {
        let page = page(answer);
        for attribute in ["src", "href", "xlink:href", "data", "action", "srcset", "poster"] {
            for target in attributes(page, attribute) {
                assert!(target.starts_with('#') || target.starts_with("data:"), "{attribute}={target}");
            }
        }
        for word in ["@import", "<script", "<link", "<iframe", "<object", "<base", "http-equiv"] {
            assert!(!page.contains(word), "{word}");
        }
        for target in page.split("url(").skip(1) {
            let target = target.trim_start_matches(['"', '\'']);
            assert!(target.starts_with('#') || target.starts_with("data:"), "url({}", &target[..40]);
        }
        // The only address is a name: that of the SVG language.
        for address in
            page.split("http").skip(1).filter(|rest| rest.starts_with("://") || rest.starts_with("s://"))
        {
            assert!(address.starts_with("://www.w3.org/2000/svg\""), "http{}", &address[..40]);
        }
    }
}

#[test]
fn every_link_of_the_page_has_its_place() {
    let page = page(hose());
    let mut places = attributes(page, "id");
    for target in attributes(page, "href").iter().filter_map(|target| target.strip_prefix('#')) {
        assert!(places.contains(&target), "{target}");
    }
    let all = places.len();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), all, "an id is used twice");
}

/// HTML's void elements, which XML requires to be closed.
fn as_xml(page: &str) -> String {
    // HTML knows attributes without a value, XML does not.
    let mut xml = page
        .replacen("<!DOCTYPE html>", "", 1)
        .replace("<details open>", "<details open=\"\">")
        .replace("<wbr>", "<wbr/>");
    for name in ["meta", "br", "hr", "img", "link", "col"] {
        let open = format!("<{name} ");
        let mut closed = String::new();
        let mut rest = xml.as_str();
        while let Some(start) = rest.find(&open) {
            let end = start + rest[start..].find('>').unwrap();
            closed.push_str(&rest[..end]);
            closed.push('/');
            rest = &rest[end..];
        }
        closed.push_str(rest);
        xml = closed;
    }
    // A style sheet has characters that XML does not allow.
    xml.replace("<style>", "<style><![CDATA[").replace("</style>", "]]></style>")
}

fn text(node: Node) -> String {
    node.descendants().filter(|inner| inner.is_text()).filter_map(|inner| inner.text()).collect()
}

#[test]
fn the_page_and_every_figure_are_well_formed() {
    for (project, answer) in [(HOSE, hose()), (PIPE, pipe())] {
        let page = page(answer);
        let xml = as_xml(page);
        let document = Document::parse(&xml).unwrap_or_else(|error| panic!("{error}"));
        let title = document.descendants().find(|node| node.has_tag_name("h1")).unwrap();
        assert!(project.contains(&format!("title = \"{}\"", text(title))));
        // the marks of verdicts have their word next to them
        let mut figures = elements(page, "svg");
        figures.retain(|figure| !figure.contains("aria-hidden=\"true\""));
        assert!(figures.len() >= 7, "{}", figures.len());
        for figure in figures {
            let document = Document::parse(figure).unwrap_or_else(|error| panic!("{error}: {figure}"));
            assert_eq!(document.root_element().attribute("role"), Some("img"));
        }
    }
}

#[test]
fn every_chapter_is_present() {
    let page = page(hose());
    let headings = elements(page, "h2").join("\n");
    for words in [
        "The rig",
        "Derived quantities",
        "Stiffness over the stroke",
        "Sizing of the hose",
        "models",
        "The impedance at the load",
        "Step response",
        "Specifications",
        "Provenance and assumptions",
    ] {
        assert!(headings.contains(words), "{words}: {headings}");
    }
    // Tables: the poles of every model, the asymptotes, the candidates with their reasons, the
    // assumptions.
    for words in [
        "6.12",
        "6.13",
        "compliance plateau",
        "rejected",
        "warns",
        "SHA-256",
        "eaton_synflex_3130_08",
        "section 6.4.1 and Table A.1",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

/// The text of the chapter on specifications.
fn demands(page: &str) -> String {
    let xml = as_xml(page);
    let document = Document::parse(&xml).unwrap_or_else(|error| panic!("{error}"));
    let chapter = document.descendants().find(|node| node.attribute("id") == Some("specifications")).unwrap();
    text(chapter)
}

/// Limit |T| <= 1.3 tolerates 1 + 1/1.3 and 1 - 1/1.3 of the gain, 2 asin(1/2.6) of phase, and
/// guarantees a distance of 1/2.3 from -1.
#[test]
fn every_limit_is_stated_with_its_meaning() {
    let chapter = demands(page(hose()));
    for words in [
        "|L/(1+L)| ≤ 1.3",
        "|1/(1+L)| ≤ |s/(s + 15)|",
        "|F L/(1+L)| ≤ |28.213 (s + 75)/(s2 + 73.6 s + 2116)|",
        "upper limit, not met; required: at most 1 % overshoot, settled within 1 % in 0.1 s; the limit itself reaches 2.19 %",
        "lower limit, not met; required: no overshoot, settled within 1 % in 0.3 s",
        "by a factor of 1.77 (4.96 dB) or falls to a share of 0.231 (-12.7 dB)",
        "the phase margin is at least 45.2°, and L stays at least 0.435 away from -1",
    ] {
        assert!(chapter.contains(words), "{words}: {chapter}");
    }
    assert_eq!(chapter.matches("A stable loop").count(), 1, "s/(s + 15) guarantees no margin: {chapter}");
}

/// The lags 1/(s + 1) below and 0.1 above intersect at sqrt(99) rad/s; towards zero they are 20 dB
/// in the wrong order.
#[test]
fn limits_that_cross_are_reported() {
    let project = format!(
        "{PLANT}\n[[specification]]\nkind = \"tracking\"\nupper = 0.1\nlower = \"1/(s + 1)\"\nfrequencies = [1]\nband = [0, 100]\n\
         [[specification]]\nkind = \"sensitivity\"\nlimit = 1\nfrequencies = [1]\nband = [0, inf]\n\
         [[specification]]\nkind = \"sensitivity\"\nlimit = 2\nfrequencies = [1]\n\
         [[specification]]\nkind = \"control_effort\"\nlimit = \"3e-9*s/(s^2 + 4)\"\nfrequencies = [1]\n\
         [[specification]]\nkind = \"robust_stability\"\nlimit = {{ frequencies = [1, 10], values = [2, 3] }}\nfrequencies = [1]\n[controller]\nnumerator = \"1\"\ndenominator = \"1\"\n"
    );
    let chapter = demands(&plain_report(&project).html);
    for words in [
        "No loop satisfies [[specification]] 1 (tracking): from 0 rad/s on its lower limit is above its upper one, by 20.0 dB towards zero",
        "[[specification]] 2 (sensitivity) stays stable while its gain grows without bound or falls to a share of 0.500 (-6.02 dB)",
        "|G/(1+L)| ≤ |3·10-9 s/(s2 + 4)|",
        "|L/(1+L)| ≤ table of 2 points from 1 to 10 rad/s",
    ] {
        assert!(chapter.contains(words), "{words}: {chapter}");
    }
    assert!(
        !chapter.contains("[[specification]] 3 (sensitivity) stays"),
        "its band does not hold every frequency: {chapter}"
    );
    assert!(!chapter.contains("Tracking limits in time"), "nothing was required: {chapter}");
}

#[test]
fn figures_come_as_svg_and_png_under_names_of_their_own() {
    let answer = hose();
    let mut names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    for figure in [
        "circuit",
        "stiffness",
        "sizing-nomograph",
        "sizing-length",
        "bode",
        "bode-reduction",
        "impedance",
        "step",
    ] {
        assert!(names.contains(&format!("{figure}.svg").as_str()), "{figure}: {names:?}");
    }
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all);
    for file in &answer.files {
        if file.name.ends_with(".svg") {
            Document::parse(std::str::from_utf8(&file.bytes).unwrap()).unwrap();
            let picture = picture_of(file).unwrap().unwrap();
            assert!(picture.bytes.starts_with(b"\x89PNG\r\n\x1a\n") && picture.bytes.len() > 2000);
        }
    }
}

#[test]
fn the_same_project_gives_the_same_bytes() {
    let (one, other) = (hose(), report_answer(HOSE));
    assert_eq!(one.json, other.json);
    for (one, other) in one.files.iter().zip(&other.files) {
        assert_eq!(one.name, other.name);
        assert!(one.bytes == other.bytes, "{}", one.name);
    }
}

#[test]
fn it_is_made_for_light_and_dark_and_paper() {
    let page = &plain_hose().html;
    for words in
        ["prefers-color-scheme: dark", "@media print", "color-scheme: light dark", "name=\"viewport\""]
    {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn a_hostile_title_is_escaped() {
    let title = "<script>alert(1)</script> & \\\"quotes\\\" ]]> </svg>";
    let project =
        nominal().replace("title = \"Ybitu rig, 1.5 m of HVE hose\"", &format!("title = \"{title}\""));
    assert_ne!(project, nominal());
    let report = report_of(&project, &[]);
    assert!(!report.html.contains("<script"));
    let xml = as_xml(&report.html);
    let document = Document::parse(&xml).unwrap_or_else(|error| panic!("{error}"));
    for name in ["h1", "title"] {
        let node = document.descendants().find(|node| node.has_tag_name(name)).unwrap();
        assert_eq!(text(node), "<script>alert(1)</script> & \"quotes\" ]]> </svg>");
    }
    for figure in &report.figures {
        Document::parse(&figure.to_svg_standalone()).unwrap_or_else(|error| panic!("{error}"));
        Document::parse(&figure.to_svg_inline()).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn another_plant_is_checked_and_refused_elsewhere_with_the_reason() {
    assert!(answer(PLANT, &[], &[], &Request::Check).affirmative);
    for request in [
        Request::Report { files: true, alternatives: false },
        Request::Linearize { sweep: None },
        run_command::size_request(None, None),
    ] {
        let error = try_answer(PLANT, &[], &[], &request).unwrap_err().to_string();
        assert!(error.contains("[plant]") && error.contains("[cylinder]"), "{error}");
    }
}

/// The behaviour of the machine under the controller is in its chapter with a figure, and among the
/// first facts, its edge by its word.
#[test]
fn controllers_are_shown_on_the_machine() {
    // the result of `design` for the hose with lumped lines
    let report = report_with(&[
        "line.compliance=by_volume",
        "controller.numerator=0.7217*(s + 23.992)*(s + 2148.5)",
        "controller.denominator=s*(s^2 + 624.8*s + 1077500)",
        "prefilter.numerator=479.07",
        "prefilter.denominator=s^2 + 35.964*s + 479.07",
    ]);
    let fact =
        |name: &str| report.summary.iter().find(|(known, _)| *known == name).map(|(_, text)| text.as_str());
    assert!(fact("Audit of the controller").unwrap().starts_with("met"));
    assert_eq!(
        fact("Controller in the nonlinear simulation"),
        Some("contradicts: the rig with waves in its lines")
    );
    assert!(report.figures.iter().any(|found| found.name == "machine_steps"));
    // by word, form and colour
    for shown in [
        "<span class=\"mark good\"><svg",
        "<span class=\"mark bad\"><svg",
        "The nonlinear simulation contradicts the verdict",
    ] {
        assert!(report.html.contains(shown), "{shown}");
    }
    let given = report.decision.given.as_ref().unwrap();
    assert_eq!((given.verdict, given.machine), (Some(Verdict::Met), Some(Agreement::Contradicts)));
    let next = report.decision.next.join("\n");
    assert!(
        report.decision.next[0].contains(
            "do not rely on it before the nonlinear simulation, which contradicts the verdict, agrees"
        ),
        "{next}"
    );
    assert!(
        next.contains("Shorten the hose")
            && next.contains("the nonlinear simulation contradicts the verdict"),
        "{next}"
    );
}

/// A transfer function has the robust chapters, whether its closed loop is rational or not.
#[test]
fn a_plant_with_specifications_has_the_robust_chapters() {
    let servo = include_str!("../../../examples/qft/servo.toml");
    for settings in [&[][..], &["controller.delay=\"1 ms\""], &["controller.sample_time=\"1 ms\""]] {
        let report = report_of(servo, settings);
        for heading in ["Specifications", "Templates and bounds", "Audit of the controller"] {
            assert!(report.html.contains(&format!("<h2>{heading}</h2>")), "{heading} {settings:?}");
        }
        for figure in ["templates", "nichols", "audit_1_robust_stability", "audit_2_tracking", "family_steps"]
        {
            assert!(report.figures.iter().any(|found| found.name == figure), "{figure} {settings:?}");
        }
        for table in ["bounds.csv", "templates.csv", "margins.csv"] {
            assert!(report.tables.iter().any(|found| found.name == table), "{table} {settings:?}");
        }
    }
}

#[test]
fn a_project_without_sizing_or_controller_has_the_other_chapters() {
    let (start, rest) = HOSE.split_once("[sizing]").unwrap();
    let (_, rest) = rest.split_once("[uncertainty]").unwrap();
    // a controller would be designed if there were specifications
    let end = rest.split("[[specification]]").next().unwrap();
    let page = plain_report(&format!("{start}[uncertainty]{end}")).html;
    assert!(!page.contains("id=\"sizing\""));
    assert!(page.contains("no controller") && page.contains("id=\"impedance\""));
}

#[test]
fn the_summary_agrees_with_the_commands() {
    let answer = hose();
    // ORIGIN: recomputed by comparisons/recompute_rig.py: 2232961.6 and 4108630.5 N/m, 2.7330293e-4
    // V/N at 1.5 m
    for words in [
        "2.23 to 4.11 MN/m",
        "1.50 m a line at K_p = 2.73e-4 V/N",
        "open loop passive, closed loop not passive",
    ] {
        assert!(answer.text.contains(words), "{words}: {}", answer.text);
    }
}

#[test]
fn only_models_of_the_same_parameters_are_drawn_against_each_other() {
    let report = plain_hose();
    let drawing = |name: &str| {
        report.figures.iter().find(|figure| figure.name == name).unwrap().to_svg_standalone().to_string()
    };
    assert!(!drawing("bode").contains("two-pressure"));
    let reduction = drawing("bode-reduction");
    for name in ["two-pressure, derived parameters", "derived parameters"] {
        assert!(reduction.contains(name), "{name}");
    }
    assert!(!reduction.contains("(6.12)") && !reduction.contains("(6.13)"));
    // Derived K_H of the hose at mid stroke is softer than the value in use: the table names both
    // fifth orders.
    let text = answer(HOSE, &[], &[], &Request::Linearize { sweep: None }).text;
    for row in
        ["two-pressure, derived parameters", "fifth order, derived parameters", "6.7 instead of two-pressure"]
    {
        assert!(text.contains(row), "{text}");
    }
}

/// The report of the hose with settings, without its sizing chapter.
fn report_with(settings: &[&str]) -> Report {
    report_of(&without_design(HOSE), settings)
}

/// The report of a project with settings, without a sizing chapter.
pub(crate) fn report_of(project: &str, settings: &[&str]) -> Report {
    let loaded = load(project, settings, &[]);
    report(&Memory::default(), &loaded, &Setup::new(&loaded.project).unwrap(), None, &mut |_| true).unwrap()
}

#[test]
fn an_unstable_loop_is_reported_as_unstable_without_metrics() {
    let unstable = report_of(&nominal(), &["controller.numerator=\"s + 8\""]);
    assert!(
        unstable.summary.contains(&("Nominal linear loop", "unstable".to_string())),
        "{:?}",
        unstable.summary
    );
    assert!(
        unstable
            .html
            .contains("The closed loop is unstable: its force grows without bound and is not drawn.")
    );
    assert!(unstable.figures.iter().all(|figure| figure.name != "step"));
    let (_, step) = plain_hose().summary.iter().find(|(name, _)| *name == "Nominal linear loop").unwrap();
    assert!(step.contains("% overshoot, settles in "), "{step}");
    // A proportional loop ends away from its reference: it does not settle in the band.
    let other_loop =
        report_of(&nominal(), &["controller.numerator=\"0.0001\"", "controller.denominator=\"1\""]);
    assert!(!other_loop.html.contains("settles in not"));
}
