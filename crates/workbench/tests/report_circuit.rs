//! Circuits of a report show the declarations of the project, uncut.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::try_answer;
use phea_workbench::command::Request;

const LINKAGE: &str = include_str!("../../project/tests/valid/linkage.toml");
const FOUR_BAR: &str = include_str!("../../project/tests/valid/linkage_four_bar.toml");
const TABLE: &str = include_str!("../../project/tests/valid/linkage_table.toml");
const SWITCHED: &str = include_str!("../../../examples/ybitu/switched_gas.toml");
const ADJUSTED: &str = include_str!("../../../examples/ybitu/variable_impedance.toml");
const TELESCOPIC: &str = include_str!("../../project/tests/valid/telescopic.toml");
const TURNING: &str = include_str!("../../project/tests/valid/motor_turning.toml");

/// The project without the parts that its drawing does not show, so that nothing is verified or
/// simulated.
fn drawn(project: &str) -> &str {
    let ends = ["[uncertainty]", "[[specification]]", "[[scenario]]"].map(|table| project.find(table));
    &project[..ends.into_iter().flatten().min().unwrap_or(project.len())]
}

/// The texts of the drawing, with sub- and superscripts joined to their letters.
fn texts(project: &str, settings: &[&str]) -> Vec<String> {
    let answer =
        try_answer(drawn(project), settings, &[], &Request::Report { files: true, alternatives: false })
            .unwrap();
    let file = answer.files.iter().find(|file| file.name == "circuit.svg").unwrap();
    let svg = std::str::from_utf8(&file.bytes).unwrap();
    let texts: Vec<String> = svg
        .split("<text ")
        .skip(1)
        .map(|text| {
            let inside = text.split_once('>').unwrap().1.split("</text>").next().unwrap();
            let parts = inside.split('<').enumerate();
            parts
                .map(|(index, part)| if index == 0 { part } else { part.split_once('>').unwrap().1 })
                .collect()
        })
        .collect();
    let cut: Vec<&String> = texts.iter().filter(|text| text.contains('…')).collect();
    assert!(cut.is_empty(), "{cut:?}");
    texts
}

/// The chapter on the impedance states its location.
#[test]
fn the_impedance_of_a_linkage_is_stated_at_the_rod_and_about_the_joint() {
    let page = |project: &str| {
        let answer =
            try_answer(drawn(project), &[], &[], &Request::Report { files: true, alternatives: false })
                .unwrap();
        let file = answer.files.into_iter().find(|file| file.name == "report.html").unwrap();
        String::from_utf8(file.bytes).unwrap()
    };
    let sentence = "about the joint it is r² (Z + ";
    assert!(page(LINKAGE).contains(sentence) && !page(TELESCOPIC).contains(sentence));
}

#[track_caller]
fn contains_all(texts: &[String], expected: &[&str]) {
    for words in expected {
        assert!(texts.iter().any(|text| text == words), "{words}: {texts:?}");
    }
}

/// The lever arm of a triangle is a b sin(phi)/l by the law of cosines, here at the position of
/// rest.
#[test]
fn a_lever_has_its_kind_and_its_arm() {
    // ORIGIN: analytic, of the lengths of the project file
    let (a, b, l_0, position) = (0.3_f64, 0.05_f64, 0.26_f64, 0.03);
    let sensor_stretch = 2000.0 / 20e6;
    let l = l_0 + position - sensor_stretch;
    let cosine = (a * a + b * b - l * l) / (2.0 * a * b);
    let arm = 1e3 * a * b * (1.0 - cosine * cosine).sqrt() / l;
    let arm = format!("{arm:.1} mm");
    contains_all(
        &texts(LINKAGE, &[]),
        &["triangle", "arm r", &arm, "θ", "J", "900 N.m/rad", "50/22 mm, stroke 80 mm"],
    );
    contains_all(&texts(FOUR_BAR, &[]), &["four-bar", "arm r"]);
    contains_all(&texts(TABLE, &[]), &["table", "arm r", "θ0"]);
}

/// The gas at the setting of rest: between both ends in proportion to the setting.
#[test]
fn adjusted_gas_is_stated_at_rest() {
    for (setting, volume) in [("0", "3.5 mL"), ("0.5", "8.85 mL"), ("1", "14.2 mL")] {
        let set = format!("line.accumulator.adjustment.setting={setting}");
        let gas = format!("{volume}, 15 bar");
        let at = format!("at setting {setting} of");
        let found = texts(ADJUSTED, &[&set]);
        contains_all(&found, &[&gas, &at, "3.5 mL to 14.2 mL"]);
    }
    contains_all(&texts(SWITCHED, &[]), &["14.2 mL, 15 bar", "valve, setting 1"]);
}

#[test]
fn a_telescopic_piston_lists_its_stages_and_a_motor_its_symbols() {
    contains_all(&texts(TELESCOPIC, &[]), &["50/22 mm, 500 mm in 3 stages"]);
    let found = texts(TURNING, &[]);
    contains_all(&found, &["θ", "J", "Te", "Tref", "0.005 kg.m2"]);
    assert!(!found.iter().any(|text| ["xp", "xL", "M", "Fe", "Fref"].contains(&text.as_str())), "{found:?}");
}
