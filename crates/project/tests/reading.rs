//! Reading, printing and error messages of a project.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use phea_project::catalogue::{self, CatalogueKind};
use phea_project::source::Memory;
use phea_project::{
    self as project, Component, DeclaredCylinder, DeclaredLine, HoseExpansion, Loaded, Origin, Project,
    Refusal, STARTER,
};

fn read(text: &str) -> Result<Loaded, Refusal> {
    project::read(&Memory::default().with("rig.toml", text), "rig.toml", &[], &[])
}

#[track_caller]
fn accept(text: &str) -> Loaded {
    read(text).unwrap_or_else(|report| panic!("{report}"))
}

/// Printing and reading again gives an equal project; printing that gives an equal text.
#[track_caller]
fn round_trip(project: &Project) {
    let text = project::print(project);
    let again = accept(&text).project;
    assert!(again == *project, "{text}");
    assert_eq!(project::print(&again), text);
}

#[test]
fn the_starter_is_spotless() {
    let loaded = accept(STARTER);
    assert_eq!(loaded.warnings, []);
    assert_eq!(loaded.sha256.len(), 64);
    round_trip(&loaded.project);
}

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const PIPE: &str = include_str!("../../../examples/ybitu/pipe.toml");

#[test]
fn the_ybitu_projects_read_and_warn_of_active_friction_only() {
    for text in [HOSE, PIPE] {
        let loaded = accept(text);
        let messages: Vec<&str> = loaded.warnings.iter().map(|warning| warning.message.as_str()).collect();
        assert_eq!(messages.len(), 1, "{messages:?}");
        // ORIGIN: analytic, 2000 (120 - 80)/80
        assert!(messages[0].contains("at least 1000 N.s/m"), "{messages:?}");
        round_trip(&loaded.project);
    }
}

/// Projects that together use every key.
pub(crate) fn valid() -> Vec<(String, String)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/valid");
    let files = std::fs::read_dir(folder).expect("the corpus is there");
    let mut files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    files.sort();
    let text = |path: &std::path::PathBuf| std::fs::read_to_string(path).expect("a text");
    files.iter().map(|path| (path.display().to_string(), text(path))).collect()
}

#[test]
fn valid_projects_read_without_warnings_and_round_trip() {
    for (name, text) in valid() {
        let loaded = accept(&text);
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        round_trip(&loaded.project);
    }
}

#[test]
fn every_key_is_in_a_valid_project() {
    let texts: String = valid().into_iter().map(|(_, text)| text).chain([HOSE.to_string()]).collect();
    for entry in project::keys() {
        let name = entry.key.name;
        assert!(name == "NAME" || texts.contains(name), "{} is in no valid project", entry.path);
        assert!(entry.key.doc.ends_with('.'), "{}: {}", entry.path, entry.key.doc);
    }
}

#[test]
fn line_ends_and_byte_order_mark_do_not_matter() {
    let plain = accept(HOSE);
    let windows = accept(&format!("\u{feff}{}", HOSE.replace('\n', "\r\n")));
    assert!(plain.project == windows.project);
    assert_ne!(plain.sha256, windows.sha256);
    assert_eq!(plain.warnings[0].line, windows.warnings[0].line);
}

#[test]
fn settings_take_precedence_over_everything_else() {
    let source = Memory::default().with("rig.toml", HOSE);
    let set = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
        project::read(&source, "rig.toml", &settings, &[])
    };
    let loaded = set(&[
        "line.length=2 m",
        "supply.pressure = \"80 bar\"",
        "valve.flow_coefficients=[1e-7, 1e-7, 1e-7, 1e-7]",
        "specification.0.limit=1.4",
        "uncertainty.\"supply.pressure\".nominal=80 bar",
        "uncertainty.\"supply.pressure\".minimum=70 bar",
        "uncertainty.\"supply.pressure\".maximum=90 bar",
        "title=Rig of the second floor",
    ]);
    // a linear parameter that depends on it is uncertain already
    let report = loaded.expect_err("counted twice");
    assert_eq!(report.diagnostics[0].file, "--set uncertainty.\"supply.pressure\".nominal=80 bar");

    let loaded = set(&[
        "line.length=2 m",
        "line.b.length=1 m",
        "title=Rig of the second floor",
        "sizing.time_constant=0.1",
    ])
    .unwrap_or_else(|report| panic!("{report}"));
    let actuator = loaded.project.actuator.as_ref().expect("a rig");
    assert_eq!((actuator.line.a.length(), actuator.line.b.length()), (Some(2.0), Some(1.0)));
    assert_eq!(loaded.project.title, "Rig of the second floor");
    assert_eq!(loaded.settings.len(), 4);
    let origin = |path: &str| loaded.provenance.iter().find(|p| p.path == path).map(|p| p.origin.clone());
    assert_eq!(origin("line.b.length"), Some(Origin::Setting("line.b.length=1 m".to_string())));
    assert_eq!(origin("fluid.density"), Some(Origin::Project));
    assert_eq!(origin("cylinder.friction.stribeck_exponent"), Some(Origin::Project));
    assert_eq!(origin("fluid.polytropic_exponent"), Some(Origin::Default));
    let source = "Ledezma (2019), Table A.1".to_string();
    let name = "moog_760_c263a".to_string();
    assert_eq!(origin("valve.nominal_flow"), Some(Origin::Catalogue { name, source }));

    for (setting, message) in [
        ("line.length", "a setting has the form path=value"),
        ("line..length=1 m", "an empty name in the path"),
        ("specification.7.limit=1", "`7` is not an element of this list of 3"),
        ("line.length.x=1", "nothing can be set inside a text"),
        ("line.length=1 s", "expected a length, found a time"),
        ("supply.presure=70 bar", "unknown key `presure` in [supply]"),
    ] {
        let report = set(&[setting]).expect_err(setting);
        let first = &report.diagnostics[0];
        assert_eq!((first.message.as_str(), first.file.clone()), (message, format!("--set {setting}")));
    }
}

#[test]
fn numbers_are_found_and_replaced_by_their_path() {
    let project = accept(HOSE).project;
    assert_eq!(project.number("supply.pressure"), Some(70e5));
    assert_eq!(project.number("line.length"), Some(1.5));
    assert_eq!(project.number("valve.flow_coefficients.supply_to_b"), Some(2e-7));
    assert_eq!(project.number("line.dynamic_stiffening.minimum"), Some(4.0));
    assert_eq!(project.number("supply.temperature"), None);
    let longer = project.with_number("line.length", 2.0).expect("a path");
    let line = &longer.actuator.as_ref().expect("a rig").line;
    assert_eq!((line.a.length(), line.b.length()), (Some(2.0), Some(2.0)));
    assert!(longer.with_number("line.length", 1.5) == Some(project));
}

#[test]
fn findings_are_shown_with_their_line() {
    let report = read(&HOSE.replace("pressure = \"70 bar\"", "pressure = \"70 baar\"")).expect_err("refused");
    // ORIGIN: written by hand
    let expected = r#"error: unknown unit `baar`
  --> rig.toml:16:16
   |
16 | pressure = "70 baar"                      # section 5.2.1
   |                ^^^^ expected a pressure, such as "70 bar", "7 MPa", "1000 psi"
   |
help: did you mean `bar`?"#;
    assert!(report.to_string().contains(expected), "{report}");
    let missing = project::read(&Memory::default(), "rig.toml", &[], &[]).expect_err("no file");
    assert_eq!(missing.diagnostics[0].message, "cannot read rig.toml: no such file");
}

/// A missing file is reported with a file of similar name.
#[test]
fn a_misspelt_file_is_reported_with_the_closest_name() {
    let source = Memory::default().with("rigs/hose.toml", HOSE).with("rigs/notes.txt", "");
    let help = |path: &str| {
        let report = project::read(&source, path, &[], &[]).expect_err("no such file");
        report.diagnostics[0].help.clone()
    };
    assert_eq!(help("rigs/hoes.toml").as_deref(), Some("did you mean `rigs/hose.toml`?"));
    assert_eq!(help("rigs/pipe_of_steel.toml"), None);
    assert_eq!(help("rig/hose.toml").as_deref(), Some("there is no folder `rig` either"));
    assert_eq!(help("hose.toml"), None);
}

#[test]
fn catalogues_are_added_and_every_number_has_a_source() {
    let soft = include_str!("catalogue/fictitious_soft.toml");
    let source = Memory::default()
        .with("own/soft.toml", soft)
        .with("own/notes.txt", "no catalogue")
        .with("rig.toml", HOSE);
    let settings = ["line.hose=fictitious_soft".to_string()];
    let loaded = project::read(&source, "rig.toml", &settings, &["own".to_string()]);
    let loaded = loaded.unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(loaded.catalogue_files, ["built-in:valves/moog_760_c263a.toml", "own/soft.toml"]);
    assert_eq!(loaded.project.number("line.bore"), Some(0.0127));
    assert!(project::read(&source, "rig.toml", &settings, &[]).is_err());

    let unsourced = soft.replace("source = ", "# source = ");
    let source = Memory::default().with("soft.toml", unsourced);
    let report = catalogue::load(&source, &["soft.toml".to_string()]).expect_err("no sources");
    assert!(report.diagnostics.iter().all(|found| found.message.ends_with("has no source")), "{report}");
    assert_eq!(report.diagnostics.len(), 3);

    let own = catalogue::load(&Memory::default(), &[]).expect("built in");
    for kind in CatalogueKind::ALL {
        for entry in own.entries(kind) {
            assert!(entry.file.contains(&format!("{}s/{}.toml", kind.name(), entry.name)), "{}", entry.file);
        }
    }
    // read as a user's files, so that all errors in one are reported
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("catalogue");
    for kind in CatalogueKind::ALL {
        let files = std::fs::read_dir(folder.join(format!("{}s", kind.name()))).expect("a folder");
        let files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
        assert_eq!(own.names(kind).len(), files.len());
        for file in files {
            let bytes = std::fs::read(&file).expect("readable");
            let path = format!("catalogue/{}s/{}", kind.name(), file.file_name().unwrap().to_string_lossy());
            let source = Memory::default().with(&path, bytes);
            catalogue::load(&source, &[path]).unwrap_or_else(|report| panic!("{report}"));
        }
    }
}

#[track_caller]
fn warns(text: &str, message: &str) {
    let loaded = accept(text);
    assert!(loaded.warnings.iter().any(|found| found.message == message), "{:?}", loaded.warnings);
    round_trip(&loaded.project);
}

#[test]
fn keys_without_effect_are_reported() {
    let rig = include_str!("valid/volumes.toml");
    let friction = "friction = { model = \"viscous\", viscous = 299";
    let with_coulomb = rig.replace(friction, &format!("{friction}, coulomb = 80"));
    warns(&with_coulomb, "`coulomb` has no effect with model \"viscous\"");
    let stiffness = "\n[linear]\nhydraulic_stiffness = 2.24e6";
    warns(
        &rig.replace("\n[linear]", stiffness),
        "`line.b.volume` does not reach the linear model: [linear] sets what it changes",
    );
    let case = "[[load_case]]\nname = \"on a wall\"\nset = { \"load.model\" = \"wall\" }\n";
    warns(
        &format!("{HOSE}\n{case}"),
        "[[load_case]] has no effect, and its values are not read: there is no [[alternative]] to judge under it",
    );
    warns(&format!("{HOSE}\n[load]\nmass = 2\n"), "`mass` has no effect with model \"prescribed\"");
    warns(
        &HOSE.replace("anti_windup = \"none\"", "discretization = \"matched\""),
        "`discretization` has no effect: there is no `sample_time`",
    );
    let elsewhere = HOSE.replace("viscous_friction          =", "\"cylinder.moving_mass\" =").replace(
        "\"100 N.s/m\", minimum = \"100 N.s/m\", maximum = \"3e4 N.s/m\"",
        "\"13 kg\", minimum = \"12 kg\", maximum = \"14 kg\"",
    );
    let stated = "the project states 13.1 kg for `cylinder.moving_mass`, not 13 kg: only the family has the latter as its \
                  nominal plant";
    warns(&elsewhere, stated);
    let silent = "`noise` has no effect on a continuous controller";
    let noisy = HOSE.replace("[force_sensor]", "[force_sensor]\nnoise = \"2 N\"");
    warns(&noisy, silent);
    let at_value = noisy.lines().position(|line| line == "noise = \"2 N\"").map(|index| (index + 1, 9));
    let found = accept(&noisy).warnings.into_iter().find(|found| found.message == silent);
    assert_eq!(found.map(|found| (found.line, found.column)), at_value);
    let sampled = noisy.replace("saturation =", "sample_time = \"1 ms\"\nsaturation =");
    assert!(accept(&sampled).warnings.iter().all(|found| found.message != silent));
    let improper = "[prefilter] has more zeros than poles: it can be verified, but not simulated or sampled";
    warns(&HOSE.replace("numerator = \"910\"", "numerator = \"s^3 + 910\""), improper);
    let weak = HOSE.replace("length = \"1.5 m\"", "length = \"1.5 m\"\nworking_pressure = \"50 bar\"");
    warns(&weak, "the hose's `working_pressure` is below the supply pressure");
}

/// The measured valve of the catalogue is the thesis' null at 0.078 V rising and -0.05 V falling,
/// and otherwise the example's valve.
#[test]
fn the_measured_valve_adds_its_null_to_that_of_the_examples() {
    let read = |settings: &[String]| {
        let source = Memory::default().with("rig.toml", HOSE);
        project::read(&source, "rig.toml", settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
    };
    let valve = |project: &Project| project.actuator.clone().expect("a rig").valve;
    let (plain, measured) =
        (valve(&read(&[])), valve(&read(&["valve.model=moog_760_c263a_ybitu".to_string()])));
    assert_eq!((plain.null_bias, plain.hysteresis), (0.0, None));
    let half = measured.hysteresis.expect("measured") / 2.0;
    assert!((measured.null_bias + half - 0.078).abs() < 1e-12);
    assert!((measured.null_bias - half + 0.05).abs() < 1e-12);
    assert_eq!(measured.threshold, None);
    assert_eq!(measured.flow, plain.flow);
    assert_eq!(measured.leakage.edges(), plain.leakage.edges());
    assert_eq!((measured.tare_flow, measured.tare_pressure), (plain.tare_flow, Some(70e5)));
}

#[test]
fn a_side_inherits_unstated_values() {
    // ORIGIN: written by hand in these lines; the slope is Ledezma (2019), Table A.1
    let [pipe, own] =
        ["[line.b]\npipe = { bore = \"10 mm\" }\n", "[line.b]\nbore = \"9 mm\"\n"].map(|side| {
            let text = HOSE.replace("[force_sensor]", &format!("{side}\n[force_sensor]"));
            accept(&text.replace("dynamic_stiffening", "bore = \"13 mm\"\ndynamic_stiffening")).project
        });
    let lines = |project: &Project| project.actuator.clone().expect("a rig").line;
    let (piped, narrowed) = (lines(&pipe), lines(&own));
    let bore = |line: &DeclaredLine| line.hose().map(|hose| hose.bore);
    assert_eq!(bore(&piped.a), Some(0.013));
    assert!(
        matches!(&piped.b.component, Component::Pipe { pipe, length } if pipe.bore == 0.01 && *length == 1.5)
    );
    assert_eq!(narrowed.b.hose_name(), Some("eaton_synflex_3130_08"));
    assert_eq!((bore(&narrowed.a), bore(&narrowed.b)), (Some(0.013), Some(0.009)));
    assert_eq!(narrowed.b.hose().map(|hose| hose.expansion.slope()), Some(2.236e-12));
    round_trip(&pipe);
    round_trip(&own);
    // the measured value gives the slope through zero
    let measured = HOSE.replace("hose = \"eaton_synflex_3130_08\"", "bore = \"9.5 mm\"\nvolumetric_expansion = \"2.4 cc/ft\"\nvolumetric_expansion_pressure = \"1000 psi\"");
    let project = accept(&measured).project;
    let expansion = lines(&project).a.hose().map(|hose| hose.expansion);
    assert!(matches!(expansion, Some(HoseExpansion::Measured { .. })), "{expansion:?}");
    round_trip(&project);
}

#[test]
fn areas_are_derived_from_diameters_or_stated() {
    let diameters = DeclaredCylinder {
        piston_diameter: Some(0.05),
        rod_diameter: Some(0.022),
        ..DeclaredCylinder::default()
    };
    let [area_a, area_b] = diameters.effective_areas_m2();
    // ORIGIN: analytic, pi/4 (0.05^2 - 0.022^2) = 1.58336e-3
    assert!((area_a - 1.58336e-3).abs() < 0.5e-8 && area_a == area_b);
    // an area is the effective one: an additional rod subtracts nothing
    let area = DeclaredCylinder {
        piston_area: Some(1.583e-3),
        rod_diameter: Some(0.022),
        ..DeclaredCylinder::default()
    };
    assert_eq!(area.effective_areas_m2(), [1.583e-3; 2]);
    assert!((area.piston_diameter_m() - 0.05).abs() < 1e-5);
    let areas = DeclaredCylinder { piston_areas: Some([2e-3, 1e-3]), ..DeclaredCylinder::default() };
    assert_eq!(areas.effective_areas_m2(), [2e-3, 1e-3]);
}

const MOTOR: &str = include_str!("valid/motor.toml");

/// A printed controller of a motor reads back equal when pasted into its project: torques have the
/// units of a rig that turns.
#[test]
fn printed_fragments_can_be_pasted_into_the_project_of_a_motor() {
    let quantization = "quantization = { command_bits = 12, command_range = [\"-10 V\", \"10 V\"], measurement_bits = 12, \
                        measurement_range = [\"-500 N.m\", \"500 N.m\"], allowed_force_error = \"2 N.m\" }\n";
    let text = MOTOR.replace("sample_time = \"1 ms\"\n", &format!("sample_time = \"1 ms\"\n{quantization}"));
    let project = accept(&text).project;
    let controller = project.controller.as_ref().expect("a controller");
    assert!(controller.quantization.is_some());
    let pasted = project::snippet((controller, None), project.motions());
    assert!(pasted.contains("\"500 N.m\"") && pasted.contains("\"2 N.m\""), "{pasted}");
    let (before, rest) = text.split_once("[controller]").expect("a controller");
    let after = rest.split_once("\n[[scenario]]").expect("a scenario").1;
    assert_eq!(accept(&format!("{before}{pasted}\n[[scenario]]{after}")).project, project);
}
