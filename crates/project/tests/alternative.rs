//! Alternatives: their settings, in all forms, and the places of their errors.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_project::source::Memory;
use phea_project::{Loaded, Refusal, STARTER, print, read, read_alternative, read_load_case};

fn loaded(alternatives: &str, settings: &[&str]) -> Result<Loaded, Refusal> {
    let source = Memory::default().with("rig.toml", format!("{STARTER}\n{alternatives}"));
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    read(&source, "rig.toml", &settings, &[])
}

fn other(alternatives: &str, settings: &[&str]) -> Result<Loaded, Refusal> {
    read_alternative(&Memory::default(), &loaded(alternatives, settings).unwrap(), &[], 0)
}

/// An alternative equals the project with its settings on the command line.
#[test]
fn an_alternative_equals_the_project_with_set() {
    let forms = [
        "set = { \"supply.pressure\" = \"80 bar\", \"line.length\" = \"2 m\" }",
        "[alternative.set]\n\"supply.pressure\" = \"80 bar\"\n\"line.length\" = \"2 m\"",
        "[alternative.set]\nsupply.pressure = \"80 bar\"\nline.length = \"2 m\"",
        "[alternative.set]\n'supply.pressure' = \"80 bar\"\n[alternative.set.line]\nlength = \"2 m\"",
    ];
    for form in forms {
        let text = format!("[[alternative]]\nname = \"other\"\n{form}\n");
        let (found, expected) = (
            other(&text, &["cylinder.moving_mass=\"20 kg\""]).unwrap(),
            loaded(
                &text,
                &["cylinder.moving_mass=\"20 kg\"", "supply.pressure=\"80 bar\"", "line.length=\"2 m\""],
            )
            .unwrap(),
        );
        assert_eq!(found.project, expected.project, "{form}");
        assert_eq!(found.settings, expected.settings, "{form}");
    }
}

#[test]
fn an_inline_table_replaces_a_whole_table() {
    let text = "[[alternative]]\nname = \"pipe\"\n[alternative.set]\n\"line\" = { pipe = { bore = \"10 mm\" }, length = \"1 m\" }\n";
    let pipe = other(text, &[]).unwrap();
    let expected = loaded(text, &["line={ pipe = { bore = \"10 mm\" }, length = \"1 m\" }"]).unwrap();
    assert_eq!(pipe.project, expected.project);
    assert_ne!(pipe.project.actuator, loaded(text, &[]).unwrap().project.actuator);
}

/// A printed project reads back as an equal one, including alternatives.
#[test]
fn alternatives_are_printed_as_they_are_read() {
    let text = "[[alternative]]\nname = \"a \\\"b\\\"\"\n[alternative.set]\nline.length = \"2 m\"\n\
                \"uncertainty.\\\"line.length\\\"\" = { minimum = 1, maximum = 2, points = 3, list = [1, inf, true, \"x\"] }\n";
    let first = loaded(text, &[]).unwrap().project;
    assert_eq!(first.alternatives[0].set[0], ("line.length".to_string(), "\"2 m\"".to_string()));
    assert_eq!(first.alternatives[0].set[1].0, "uncertainty.\"line.length\"");
    let source = Memory::default().with("rig.toml", print(&first));
    assert_eq!(read(&source, "rig.toml", &[], &[]).unwrap().project.alternatives, first.alternatives);
}

/// An error in a value or key has its place in the table of the alternative.
#[test]
fn errors_have_their_place_in_the_file() {
    let first = STARTER.lines().count() + 2;
    let text = "[[alternative]]\nname = \"wrong\"\n[alternative.set]\n\"line.lenght\" = \"2 m\"\nsupply.pressure = \"80 mm\"\n";
    let refusal = other(text, &[]).unwrap_err();
    let places: Vec<_> = refusal.diagnostics.iter().map(|found| (found.line, found.column)).collect();
    let messages: Vec<_> = refusal.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "alternative `wrong`: unknown key `lenght` in [line]",
            "alternative `wrong`: expected a pressure, found a length"
        ]
    );
    assert_eq!(refusal.diagnostics[0].help.as_deref(), Some("did you mean `length`?"));
    // the name after `"line.`, and the unit of the value
    assert_eq!(places, [(first + 3, 7), (first + 4, 23)]);
    assert!(refusal.diagnostics.iter().all(|found| found.file == "rig.toml"));
}

/// A warning on the project is reported with the project: a refusal of its alternative does not
/// repeat it.
#[test]
fn a_warning_of_the_project_is_not_repeated() {
    let rig = include_str!("../../../examples/ybitu/hose.toml");
    let text = format!("{rig}\n[[alternative]]\nname = \"wrong\"\nset = {{ \"line.lenght\" = \"2 m\" }}\n");
    let source = Memory::default().with("rig.toml", text);
    let base = read(&source, "rig.toml", &[], &[]).unwrap();
    assert!(!base.warnings.is_empty());
    let refusal = read_alternative(&source, &base, &[], 0).unwrap_err();
    assert_eq!(refusal.diagnostics.len(), 1, "{refusal}");
}

/// A load case is set before the alternative sets its own values, and is listed like them.
#[test]
fn an_alternative_takes_precedence_over_a_load_case() {
    let text = "[[load_case]]\nname = \"other\"\nset = { \"supply.pressure\" = \"80 bar\", \"line.length\" = \"3 m\" }\n\
                [[alternative]]\nname = \"long\"\nset = { \"line.length\" = \"2 m\" }\n";
    let source = Memory::default();
    let case = read_load_case(&source, &loaded(text, &[]).unwrap(), &[], 0).unwrap();
    let found = read_alternative(&source, &case, &[], 0).unwrap();
    let settings = ["supply.pressure=\"80 bar\"", "line.length=\"3 m\"", "line.length=\"2 m\""];
    assert_eq!(found.settings, settings);
    assert_eq!(found.project, loaded(text, &settings).unwrap().project);
    let wrong = text.replace("80 bar", "80 mm");
    let refusal = read_load_case(&source, &loaded(&wrong, &[]).unwrap(), &[], 0).unwrap_err();
    assert_eq!(refusal.diagnostics[0].message, "load case `other`: expected a pressure, found a length");
}
