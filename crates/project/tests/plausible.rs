//! Implausible numbers cause warnings, and those of a sound rig do not.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use std::fs;
use std::path::Path;

use phea_project as project;
use phea_project::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

fn warnings(text: &str, settings: &[&str]) -> Vec<String> {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let messages = loaded.warnings.iter().map(|warning| warning.message.clone());
    messages.filter(|message| message.contains(" have ")).collect()
}

#[test]
fn a_forgotten_unit_is_requested() {
    for (setting, messages) in [
        (
            "cylinder.piston_diameter=63",
            "`piston_diameter` is 63 m: pistons have 10 mm to 500 mm; was 63 mm meant?",
        ),
        (
            "fluid.bulk_modulus=1.5 MPa",
            "`bulk_modulus` is 15 bar: fluids of hydraulics have 1 GPa to 2.5 GPa; was 1.5 GPa meant?",
        ),
        (
            "force_sensor.stiffness=150",
            "`stiffness` is 150 N/m: load cells have 1 kN/mm to 10000 kN/mm; was 150 kN/mm meant?",
        ),
        ("supply.pressure=160", "`pressure` is 160 Pa: supplies have 10 bar to 500 bar; was 160 bar meant?"),
        (
            "fluid.entrained_air=0.5",
            "`entrained_air` is 0.5: fluids of hydraulics have 0 to 0.02; was 0.005 meant?",
        ),
        ("line.length=1500", "`length` is 1500 m: lines have 50 mm to 30 m; was 1.5 m meant?"),
    ] {
        assert_eq!(warnings(HOSE, &[setting]), [messages], "{setting}");
    }
}

/// A factor of ten beyond the usual range may be a special rig, without a warning.
#[test]
fn unusual_rigs_need_no_confirmation() {
    for setting in ["cylinder.piston_diameter=2", "line.length=200 m", "force_sensor.stiffness=1 kN/mm"] {
        assert_eq!(warnings(HOSE, &[setting]), Vec::<String>::new(), "{setting}");
    }
    for folder in ["../../examples/ybitu", "../../examples/benchmark", "tests/valid"] {
        for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "toml") {
                let text = fs::read_to_string(&path).unwrap();
                let Ok(loaded) =
                    project::read(&Memory::default().with("rig.toml", text), "rig.toml", &[], &[])
                else {
                    continue;
                };
                let messages: Vec<_> =
                    loaded.warnings.iter().filter(|one| one.message.contains(" have ")).collect();
                assert!(messages.is_empty(), "{}: {messages:?}", path.display());
            }
        }
    }
}
