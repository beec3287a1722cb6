//! Shaping by hand on project files: changes in order, elements that pass their point, and files of
//! which nothing else changes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use crate::run_command::{answer, json, try_answer};
use num_complex::Complex64;
use phea_dynamics::controller::Timing;
use phea_dynamics::linear::Discretization;
use phea_qft::manual_shaping::{ElementPattern, WantedPoint, pass_through};
use phea_workbench::command::{CommandError, Request};
use phea_workbench::engineering::shaping::{Change, RequestedChange, Shaped};
use phea_workbench::project::{self, DeclaredElement, ElementKind, Loaded};
use phea_workbench::shaping::pass_words;
use phea_workbench::source::Memory;
use serde_json::Value;

/// An integrator with a gain of 1 to 4, and its specifications; the controller follows.
const SERVO: &str = "schema = 1\ntitle = \"x\"\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n[uncertainty]\n\
    k = { nominal = 1, minimum = 1, maximum = 4, points = 3, spacing = \"log\" }\n[[specification]]\n\
    kind = \"robust_stability\"\nlimit = 1.3\nfrequencies = [1, 10, 100]\n[[specification]]\nkind = \"sensitivity\"\n\
    limit = 0.5\nfrequencies = [1]\n";

fn request(shaped: Shaped, changes: &[(Change, &str)]) -> Request {
    let changes =
        changes.iter().map(|&(change, text)| RequestedChange { change, text: text.to_string() }).collect();
    Request::Shape { shaped, changes }
}

fn shaped(project: &str, changes: &[(Change, &str)]) -> (Value, String) {
    let request = request(Shaped::Controller, changes);
    let answer = answer(project, &[], &[], &request);
    let saved = String::from_utf8(answer.files[0].bytes.clone()).unwrap();
    (parsed(&answer.json), saved)
}

fn kinds(answer: &Value) -> Vec<String> {
    let rows = answer["elements"].as_array().unwrap();
    rows.iter().map(|row| row["kind"].as_str().unwrap().to_string()).collect()
}

fn read(text: &str) -> Loaded {
    project::read(&Memory::default().with("rig.toml", text), "rig.toml", &[], &[])
        .unwrap_or_else(|report| panic!("{report}\n{text}"))
}

fn elements(text: &str) -> Vec<DeclaredElement> {
    read(text).project.controller.map(|controller| controller.transfer.as_elements()).unwrap_or_default()
}

/// Magnitude in dB and phase in degrees of the nominal loop.
fn loop_at(answer: &Value, frequency: f64) -> (f64, f64) {
    let rows = answer["loop"].as_array().unwrap();
    let row = rows.iter().find(|row| row["frequency_rad_per_s"] == frequency).unwrap();
    (row["magnitude_db"].as_f64().unwrap(), row["phase_deg"].as_f64().unwrap())
}

const POLYNOMIALS: &str = "[controller]                # given\nnumerator = \"0.5*(s + 2)\"   # two parts\n\
                           denominator = \"s\"\nsaturation = \"10 V\"\n";

// ORIGIN: analytic
#[test]
fn changes_are_made_in_their_order() {
    let changes = [
        (Change::Add, "{ kind = \"pole\", frequency = 200 }"),
        (Change::Add, "{ kind = \"gain\", value = 3 }"),
        (Change::Move, "3=1"),
        (Change::Disable, "2"),
        (Change::Replace, "3={ kind = \"roll_off\", frequency = \"30 Hz\" }"),
        (Change::Remove, "2"),
        (Change::Add, "{ kind = \"integrator\" }"),
    ];
    let (found, saved) = shaped(&format!("{SERVO}{POLYNOMIALS}"), &changes);
    assert_eq!(kinds(&found), ["gain", "roll_off", "integrator"]);
    assert_eq!(elements(&saved).iter().map(|one| one.kind.name()).collect::<Vec<_>>(), kinds(&found));
    let (found, _) = shaped(&format!("{SERVO}{POLYNOMIALS}"), &changes[..4]);
    assert_eq!(kinds(&found), ["gain", "general", "pole"]);
    assert_eq!(found["elements"][1]["enabled"], false);
    let (magnitude, _) = loop_at(&found, 10.0); // 3/(s (s/200 + 1)) alone
    assert!((magnitude - 20.0 * (0.3 / 1.0025_f64.sqrt()).log10()).abs() < 1e-9, "{magnitude}");
}

/// A file without a change remains as it is, whatever the form of its controller; with a change,
/// only the lines of the controller differ, and the controller reads back as printed.
#[test]
fn everything_else_is_unchanged_byte_for_byte() {
    let lead = (Change::Add, "{ kind = \"lead\", zero_frequency = 5, pole_frequency = 50 }");
    let inline = "controller = { numerator = \"2\", delay = \"1 ms\", denominator = \"s + 9\" }\n";
    let (head, tail) = SERVO.split_once("[plant]").unwrap();
    let factors = "[controller]\npoles = [0]   # integral\nzeros = [-3]\n# the gain\ngain = 2 # loud\n";
    let dotted = "controller.elements = [{ kind = \"gain\", value = 2 }]\ncontroller.delay = \"1 ms\"\n";
    let listed = "[controller]\nelements = [\n    # first\n    { kind = \"gain\", value = 2.50 },   # loud, too\n    \
                  { kind = \"zero\", frequency = \"1 Hz\" },\n    # the end\n]\ndelay = \"1 ms\" # slow\n";
    let tables = "[controller]\ndelay = \"1 ms\"\n\n[[controller.elements]]\nkind = \"gain\"\nvalue = 2.50 # loud\n\n\
                  # a corner\n[[controller.elements]]\nkind = \"zero\"\nfrequency = \"1 Hz\"\n\n# next\n[prefilter]\n\
                  numerator = \"1\"\ndenominator = \"1\"\n";
    let timed = "[controller]\nsample_time = \"1 ms\" # computer\n\n[controller.quantization]\ncoefficients = \"f32\"\n";
    let after_servo = |controller: &str| format!("{SERVO}{controller}");
    let texts = [
        after_servo(POLYNOMIALS),
        format!("{head}{inline}[plant]{tail}"),
        format!("{head}{dotted}[plant]{tail}"),
        after_servo(factors),
        after_servo(timed),
        format!("{head}controller.sample_time = \"1 ms\"\ncontroller.delay = \"1 ms\"\n[plant]{tail}"),
        after_servo(listed),
        after_servo(tables),
        SERVO.to_string(),
        SERVO.trim_end().to_string(),
        format!("\u{feff}{}", after_servo(listed).replace('\n', "\r\n")),
        after_servo(tables).replace('\n', "\r\n"),
        after_servo(POLYNOMIALS).replace('\n', "\r\n"),
    ];
    for text in texts {
        assert_eq!(shaped(&text, &[]).1, text);
        assert_eq!(
            shaped(&text, &[lead, (Change::Remove, &(elements(&text).len() + 1).to_string())]).1,
            text
        );
        let (found, saved) = shaped(&text, &[lead]);
        let declared = elements(&saved);
        assert_eq!(declared.len(), elements(&text).len() + 1, "{saved}");
        assert_eq!(declared[..declared.len() - 1], elements(&text)[..], "{saved}");
        let printed: Vec<String> = declared.iter().map(DeclaredElement::print).collect();
        let shown = found["elements"].as_array().unwrap().iter();
        assert_eq!(shown.map(|row| row["element"].as_str().unwrap()).collect::<Vec<_>>(), printed);
        let before = read(&text).project.controller.unwrap_or_default();
        let after = read(&saved).project.controller.unwrap();
        let transfer = before.transfer.clone();
        assert_eq!(project::DeclaredController { transfer, ..after }, before, "{saved}");
        assert_eq!(saved.contains('\r'), text.contains('\r'));
        let bare = saved.replace("\r\n", "");
        assert!(!text.contains('\r') || !bare.contains(['\r', '\n']), "{saved:?}");
        // comments on the law are removed with it
        let is_unchanged = |line: &&str| {
            !line.contains("controller") && !is_controller(line) && !line.trim_start().starts_with('#')
        };
        for line in text.lines().filter(is_unchanged) {
            assert!(saved.contains(line), "{line} is lost in\n{saved}");
        }
    }
}

fn is_controller(line: &str) -> bool {
    let keys = ["numerator = \"0.5", "denominator = \"s\"", "poles =", "zeros =", "gain ="];
    keys.iter().any(|key| line.starts_with(key))
}

#[test]
fn comments_remain_with_their_elements() {
    let listed = "[controller]\nelements = [\n    # first\n    { kind = \"gain\", value = 2.50 },   # loud, too\n    \
                  { kind = \"zero\", frequency = \"1 Hz\" }, # corner\n    # the end\n]\ndelay = \"1 ms\" # slow\n";
    let changes =
        [(Change::Move, "1=2"), (Change::Disable, "1"), (Change::Add, "{ kind = \"pole\", frequency = 7 }")];
    let saved = shaped(&format!("{SERVO}{listed}"), &changes).1;
    let expected = "[controller]\nelements = [\n    { kind = \"zero\", frequency = \"1 Hz\", enabled = false }, # corner\n    \
                    # first\n    { kind = \"gain\", value = 2.50 },   # loud, too\n    { kind = \"pole\", frequency = \"7 rad/s\" },\n    \
                    # the end\n]\ndelay = \"1 ms\" # slow\n";
    assert_eq!(saved, format!("{SERVO}{expected}"));
    let tables = "[controller]\ndelay = \"1 ms\"\n\n[[controller.elements]]\nkind = \"gain\"\nvalue = 2.50 # loud\n\n\
                  # a corner\n[[controller.elements]]\nkind = \"zero\"\nfrequency = \"1 Hz\"\n\n# next\n[prefilter]\n\
                  numerator = \"1\"\ndenominator = \"1\"\n";
    let saved = shaped(&format!("{SERVO}{tables}"), &[(Change::Remove, "1"), changes[2]]).1;
    let expected = "[controller]\ndelay = \"1 ms\"\n\n[[controller.elements]]\nkind = \"zero\"\nfrequency = \"1 Hz\"\n\n\
                    [[controller.elements]]\nkind = \"pole\"\nfrequency = \"7 rad/s\"\n\n# next\n[prefilter]\n\
                    numerator = \"1\"\ndenominator = \"1\"\n";
    assert_eq!(saved, format!("{SERVO}{expected}"));
    let off = shaped(&format!("{SERVO}{tables}"), &[(Change::Disable, "1")]).1;
    let gain = "kind = \"gain\"\nvalue = 2.50 # loud\n";
    assert_eq!(off, format!("{SERVO}{tables}").replace(gain, &format!("{gain}enabled = false\n")));
    assert_eq!(shaped(&off, &[(Change::Enable, "1")]).1, off.replace("false", "true"));
    let emptied = shaped(&format!("{SERVO}{tables}"), &[(Change::Remove, "1"), (Change::Remove, "1")]).1;
    assert_eq!(elements(&emptied), []);
    assert!(
        emptied.starts_with(&format!("{SERVO}[controller]\nelements = []\ndelay = \"1 ms\"\n")),
        "{emptied}"
    );
}

#[test]
fn polynomials_become_an_exact_general_element() {
    let saved =
        shaped(&format!("{SERVO}{POLYNOMIALS}"), &[(Change::Pass, "gain through 0 dB at 10 rad/s")]).1;
    let [gain, general] = &elements(&saved)[..] else { panic!("{saved}") };
    let (ElementKind::Gain { .. }, ElementKind::General(ratio)) = (&gain.kind, &general.kind) else {
        panic!()
    };
    assert_eq!(ratio.numerator.as_ref().map(project::Formula::text), Some("0.5*(s + 2)"));
    let expected = "[controller]\nelements = [\n    { kind = \"gain\", value = ";
    let (_, controller) = saved.split_once(SERVO).unwrap();
    assert!(controller.starts_with(expected), "{controller}");
    let rest = "    { kind = \"general\", numerator = \"0.5*(s + 2)\", denominator = \"s\" },\n]\n\
                saturation = \"10 V\"\n";
    assert!(controller.ends_with(rest), "{controller}");
}

/// A law in z, as deployed, remains in z; and rounded coefficients are those of the shaped law.
#[test]
fn a_law_in_z_is_shaped_in_z() {
    let law =
        "[controller]\nsample_time = \"1 ms\"\ngain = 0.5\npoles = [0.9]\ndomain = \"z\"\ndelay = \"1 ms\"\n";
    let (found, saved) = shaped(&format!("{SERVO}{law}"), &[(Change::Add, "{ kind = \"gain\", value = 2 }")]);
    let [general, gain] = &elements(&saved)[..] else { panic!("{saved}") };
    assert_eq!((general.print().as_str(), &gain.kind), (DEPLOYED, &ElementKind::Gain { value: 2.0 }));
    let other = law.replace("gain = 0.5", "gain = 1");
    assert_eq!(loop_at(&found, 10.0), loop_at(&shaped(&format!("{SERVO}{other}"), &[]).0, 10.0));
    assert!(saved.ends_with("sample_time = \"1 ms\"\ndelay = \"1 ms\"\n"), "{saved}");
}

const DEPLOYED: &str = r#"{ kind = "general", gain = 0.5, poles = [0.9], domain = "z" }"#;

/// Solved elements, in a continuous and in a sampled loop, and replacing another element: the
/// nominal loop passes the point.
#[test]
fn the_loop_passes_the_wanted_point() {
    let sampled = format!("{POLYNOMIALS}sample_time = \"2 ms\"\ndelay = \"3 ms\"\n");
    for controller in ["", POLYNOMIALS, sampled.as_str()] {
        let project = format!("{SERVO}{controller}");
        let (magnitude, phase) = loop_at(&shaped(&project, &[]).0, 10.0);
        for (element, decibels, degrees) in [
            ("gain", Some(-6.0), None),
            ("lead", Some(7.0), Some(40.0)),
            ("lag", Some(-7.0), Some(-40.0)),
            ("complex_poles", Some(3.0), Some(-60.0)),
            ("complex_zeros", Some(-3.0), Some(60.0)),
            ("pi", Some(2.0), Some(-20.0)),
            ("pole", None, Some(-35.0)),
            ("pole", Some(-2.0), None),
            ("zero", Some(2.0), None),
            ("roll_off", None, Some(-50.0)),
            ("roll_off with damping_ratio 1.2", Some(-5.0), None),
            ("notch", Some(-12.0), None),
            ("notch with frequency = 4 Hz", Some(-4.0), Some(-30.0)),
        ] {
            if controller == sampled && element.starts_with("complex_zeros") {
                continue; // two zeros cannot be sampled with one pole
            }
            if element == "zero" && controller == sampled {
                continue;
            }
            let wanted: Vec<String> = decibels
                .map(|change| format!("{} dB", magnitude + change))
                .into_iter()
                .chain(degrees.map(|change| format!("{} deg", phase + change)))
                .collect();
            let text = format!("{element} through {} at 10 rad/s", wanted.join(", "));
            let (found, _) = shaped(&project, &[(Change::Pass, &text)]);
            let (reached, turned) = loop_at(&found, 10.0);
            if let Some(change) = decibels {
                assert!((reached - magnitude - change).abs() < 1e-9, "{text}: {reached}");
            }
            if let Some(change) = degrees {
                let error = (turned - phase - change) / 360.0;
                assert!((error - error.round()).abs() < 1e-11, "{text}: {turned}");
            }
        }
    }
    let project = format!("{SERVO}{POLYNOMIALS}");
    let changes = [
        (Change::Add, "{ kind = \"lead\", zero_frequency = 1, pole_frequency = 2 }"),
        (Change::Pass, "2=lead through 3 dB, -70 deg at 10"),
    ];
    let (found, _) = shaped(&project, &changes);
    assert_eq!(kinds(&found), ["general", "lead"]);
    let (reached, turned) = loop_at(&found, 10.0);
    assert!((reached - 3.0).abs() < 1e-9 && (turned + 70.0).abs() < 1e-9, "{reached} {turned}");
}

/// Plant k/s with k from 1 to 4 and a gain g: |T| = 4g/|jw + 4g| and |S| = w/|jw + g| by hand.
#[test]
fn margins_are_those_of_the_worst_plant_the_worst_first() {
    let (found, _) = shaped(SERVO, &[(Change::Add, "{ kind = \"gain\", value = 1.5 }")]);
    let margins = found["margins"].as_array().unwrap();
    let row = |index: usize| {
        let row = &margins[index];
        (row["kind"].as_str().unwrap(), row["frequency_rad_per_s"].as_f64().unwrap())
    };
    assert_eq!(row(0), ("sensitivity", 1.0));
    assert_eq!([row(1), row(2), row(3)], [1.0, 10.0, 100.0].map(|w| ("robust_stability", w)));
    let decibels = |ratio: f64| 20.0 * ratio.log10();
    let margin = |index: usize| margins[index]["margin_db"].as_f64().unwrap();
    assert!((margin(0) - decibels(0.5 * (1.0 + 1.5_f64 * 1.5).sqrt())).abs() < 1e-9);
    assert!((margin(1) - decibels(1.3 * 37.0_f64.sqrt() / 6.0)).abs() < 1e-9);
    assert_eq!((&margins[0]["plant"]["k"], &margins[1]["plant"]["k"]), (&1.0.into(), &4.0.into()));
    // |S| = 1/2 requires a gain of sqrt 3
    let change = margins[0]["gain_change_db"].as_f64().unwrap();
    assert!((change - decibels(3.0_f64.sqrt() / 1.5)).abs() < 1e-6, "{change}");
    assert_eq!((&margins[0]["allowed"], &margins[1]["allowed"]), (&false.into(), &true.into()));
    assert_eq!(found["stable"], true);
    let unstable = shaped(SERVO, &[(Change::Add, "{ kind = \"integrator\" }")]).0;
    assert_ne!(unstable["stable"], true); // two integrators: undamped
}

#[test]
fn the_prefilter_is_shaped_independently() {
    let project =
        format!("{SERVO}{POLYNOMIALS}\n[prefilter] # soft\nnumerator = \"1\"\ndenominator = \"s + 1\"\n");
    let changes = [(Change::Pass, "pole through -90 deg at 2 rad/s"), (Change::Disable, "1")];
    let request = request(Shaped::Prefilter, &changes);
    let found = json(&project, &[], &[], &request);
    assert_eq!(
        (found["shaped"].as_str(), kinds(&found)),
        (Some("prefilter"), vec!["general".to_string(), "pole".to_string()])
    );
    let saved = String::from_utf8(answer(&project, &[], &[], &request).files[0].bytes.clone()).unwrap();
    let prefilter = read(&saved).project.prefilter.unwrap();
    // the -63.4 degrees of 1/(s + 1) leave 26.6, which a pole at 4 rad/s gives at 2 rad/s
    let ElementKind::Pole { frequency: pole } = prefilter.transfer.elements[1].kind else { panic!() };
    assert!((pole - 4.0).abs() < 1e-9, "{pole}");
    assert!(saved.contains(POLYNOMIALS) && saved.contains("[prefilter]\n"));
    let refused = try_answer(SERVO, &[], &[], &request);
    assert!(matches!(refused, Err(CommandError::Shaping(_))));
}

/// Message, column and help of a change that is rejected.
fn refusal(change: Change, text: &str) -> (String, usize, String) {
    let request = request(Shaped::Controller, &[(change, text)]);
    let project = format!("{SERVO}{POLYNOMIALS}");
    let error = try_answer(&project, &[], &[], &request).expect_err("it is refused");
    let report = error.refusal().unwrap_or_else(|| panic!("{error}"));
    let found = &report.diagnostics[0];
    assert_eq!((found.file.as_str(), found.line), (format!("--{} {text}", change.option()).as_str(), 1));
    (found.message.clone(), found.column, found.help.clone().unwrap_or_default())
}

#[test]
fn impossible_changes_are_refused_with_their_place() {
    let check = |change, text, message: &str, column, help: &str| {
        assert_eq!(refusal(change, text), (message.to_string(), column, help.to_string()), "{text}");
    };
    let element_help =
        "an element is an inline table: { kind = \"lead\", zero_frequency = 5, pole_frequency = 50 }";
    check(Change::Add, "lead", "this is not an element", 1, element_help);
    check(Change::Add, "{ kind = \"led\" }", "`kind` cannot be \"led\"", 10, "did you mean \"lead\"?");
    let lag = "{ kind = \"lag\", zero_frequency = 5, pole_frequency = 50 }";
    check(Change::Add, lag, "a lag has its zero above its pole", 34, "write kind = \"lead\"");
    let zero = "{ kind = \"lead\", zero_freqency = 5, pole_frequency = 50 }";
    let unknown = "unknown key `zero_freqency` in [elements], and `zero_frequency` is missing";
    check(Change::Add, zero, unknown, 18, "did you mean `zero_frequency`?");
    check(Change::Add, "{ kind = lead }", "string values must be quoted, expected literal string", 10, "");
    check(
        Change::Add,
        "{ kind = \"pole\", frequency = -2 }",
        "`frequency` must be above 0 rad/s; it is -2 rad/s",
        30,
        "",
    );
    check(Change::Remove, "0", "there is no element `0`", 1, "there is one element");
    check(Change::Remove, "one", "there is no element `one`", 1, "elements are counted from 1");
    check(Change::Move, "1", "there is no `=` in it", 1, "for instance 3=1");
    check(Change::Move, "1 = 2", "there is no element `2`", 5, "there is one element");
    let needs = "missing `frequency` in [elements]: kind \"pole\" needs it";
    check(Change::Replace, "1={ kind = \"pole\" }", needs, 3, "Corner or natural frequency.");
    let example = "for instance: lead through -6 dB, -130 deg at 20 rad/s";
    check(Change::Pass, "lead", "it does not say `through` which point", 1, example);
    check(Change::Pass, "lead through 3 dB", "it does not say `at` which frequency", 14, example);
    check(Change::Pass, "leed through 3 dB at 2", "`leed` cannot be solved for", 1, "did you mean `lead`?");
    let coordinate = "write a magnitude in dB, a phase in deg, or both";
    check(Change::Pass, "pi through 3 dB, 4 at 2", "`4` is not a coordinate of the chart", 18, coordinate);
    check(Change::Pass, "pi through x dB at 2", "`x` is not a number", 12, example);
    let (message, column, _) = refusal(Change::Pass, "pi through 1 dB at 2 bar");
    assert_eq!((message.as_str(), column), ("expected an angular frequency, found a pressure", 22));
    let (message, ..) = refusal(Change::Pass, "lead through 0 dB, -170 deg at 10 rad/s");
    assert!(
        message
            .starts_with("a lead turns the loop by more than 0 and less than 90 degrees; the point needs -")
    );
}

// ORIGIN: written by hand
#[test]
fn unreachable_points_of_an_element_are_described_in_words() {
    let message = |pattern, magnitude_db, phase_deg, timing: Timing| {
        let wanted = WantedPoint { frequency_rad_per_s: 20.0, magnitude_db, phase_deg };
        let (size, phase) = (10_f64.powf(-0.5), -150_f64.to_radians());
        let present = Complex64::new(size * phase.cos(), size * phase.sin());
        pass_words(&pass_through(pattern, &wanted, present, &timing).unwrap_err())
    };
    let continuous = Timing::default();
    let contains_words = |pattern, magnitude_db, phase_deg, words: &str| {
        assert_eq!(message(pattern, magnitude_db, phase_deg, continuous), words);
    };
    contains_words(
        ElementPattern::Lead,
        Some(0.0),
        Some(-30.0),
        "a lead turns the loop by more than 0 and less than 90 degrees; the point needs +120 degrees",
    );
    contains_words(
        ElementPattern::Lead,
        Some(-9.0),
        Some(-110.0),
        "a lead, turning it by +40 degrees, raises the loop by more than +2.315 dB; the point needs +1 dB",
    );
    contains_words(
        ElementPattern::RealPole,
        Some(-16.0),
        Some(-195.0),
        "a real pole, turning it by -45 degrees, raises the loop by -3.01 dB; the point needs -6 dB",
    );
    let phase = "a gain leaves the phase as it is; the point needs +10 degrees";
    contains_words(ElementPattern::Gain, Some(0.0), Some(-140.0), phase);
    let magnitude = "a real zero raises the loop by more than 0 dB; the point needs -2 dB";
    contains_words(ElementPattern::RealZero, Some(-12.0), None, magnitude);
    contains_words(ElementPattern::Lag, Some(-12.0), None, "a lag needs magnitude and phase of the point");
    let notch = |pole_damping_ratio| ElementPattern::NotchHere { pole_damping_ratio };
    let needs = "a notch at this frequency needs the magnitude of the point";
    contains_words(notch(0.5), None, Some(-170.0), needs);
    let number = "a notch at this frequency cannot have a damping ratio of -1";
    contains_words(notch(-1.0), Some(-12.0), None, number);
    let held =
        Timing { sample_time_s: Some(0.01), discretization: Discretization::Matched, ..Timing::default() };
    assert_eq!(
        message(ElementPattern::Lag, Some(-12.0), Some(-160.0), held),
        "in a sampled loop an element is solved for with the discretization `tustin` alone"
    );
}
