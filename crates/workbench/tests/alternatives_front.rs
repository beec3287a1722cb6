//! Fronts over a swept number, among them the front over the length of a hose in the book.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{AlternativesRequest, Request};

use serde_json::Value;

use super::alternatives::{BOOK, LOOP, is_in_line, json_of, rows_of_the_book};
use super::run_command::{HOSE, answer};

const FIGURE: &str = include_str!("../../../book/src/images/hose_length_front.svg");
/// Settings that the book passes to the command.
const BY_VOLUME: &str =
    r#"alternative=[{ name = "by volume", recentre = true, set = { "line.compliance" = "by_volume" } }]"#;
const COLUMNS: &str = "swept,disturbance_peak_n,stiffness_minimum_n_per_m:less";
const SWEEP: &str = "line.length=0.5 m..4 m";

/// Table, figure and findings of the book are those of the command that it states.
#[test]
#[ignore = "eighteen designs"]
fn soak_the_book_agrees_with_the_front() {
    for stated in [BY_VOLUME, COLUMNS, SWEEP] {
        assert!(BOOK.contains(stated), "{stated}");
    }
    let request = Request::Alternatives(AlternativesRequest {
        files: true,
        front: Some(COLUMNS.to_string()),
        sweep: Some(SWEEP.to_string()),
        points: Some(8),
        ..AlternativesRequest::default()
    });
    let found = answer(HOSE, &[BY_VOLUME], &[], &request);
    let rows: Vec<String> =
        rows_of_the_book(7).into_iter().filter(|row| !row.starts_with("alternative")).collect();
    assert_eq!(rows.len(), 16);
    let missing: Vec<&String> = rows.iter().filter(|row| !is_in_line(row, &found.text())).collect();
    assert!(missing.is_empty(), "{missing:#?}\n{}", found.text());
    let drawn = found.files.iter().find(|file| file.name == "front.svg").unwrap();
    assert!(drawn.bytes == FIGURE.as_bytes(), "the figure of the book is not the one that is drawn");
    let json = json_of(&found);
    let points = json["front"]["points"].as_array().unwrap();
    let of = |name: &str, length: f64| {
        let here = points.iter().find(|point| point["alternative"] == name && point["value"] == length);
        here.unwrap()["disturbance_peak_n"].as_f64().unwrap()
    };
    let by_volume = |length: f64| of("by volume", length);
    // the findings, to the digits of the book
    assert_eq!((by_volume(0.5) - by_volume(1.0)).round(), 251.0);
    assert_eq!((by_volume(1.0) - by_volume(1.5)).round(), 108.0);
    assert_eq!((100.0 * (1.0 - by_volume(1.5) / by_volume(0.5))).round(), 19.0);
    assert_eq!((100.0 * (by_volume(1.0) / by_volume(1.5) - 1.0)).round(), 7.0);
    assert!(by_volume(2.5) > by_volume(1.5));
}

pub(crate) fn front(columns: &str, sweep: &str) -> Request {
    Request::Alternatives(AlternativesRequest {
        files: true,
        front: Some(columns.to_string()),
        sweep: Some(sweep.to_string()),
        points: Some(2),
        ..AlternativesRequest::default()
    })
}

/// Dominance of the points, compared with its definition; identical bytes from two threads at once.
#[test]
fn a_front_consists_of_the_undominated_rows() {
    let request = front("high_frequency_gain_db,swept:more", "plant.delay=1 ms..20 ms");
    let run = || answer(LOOP, &[], &[], &request);
    let [found, again] = std::thread::scope(|scope| {
        let both = [scope.spawn(run), scope.spawn(run)];
        both.map(|one| one.join().unwrap())
    });
    assert_eq!(found.json, again.json);
    assert_eq!(found.text(), again.text());
    let json = json_of(&found);
    let points = json["front"]["points"].as_array().unwrap();
    assert_eq!(points.len(), 6);
    let numbers = |point: &Value| {
        let comparable = point["comparable"] == true;
        let number = |key: &str| point[key].as_f64().filter(|_| comparable);
        Some([number("high_frequency_gain_db")?, -number("swept")?])
    };
    let mut on_front = 0;
    for point in points {
        let dominated = |other: &&Value| match (numbers(point), numbers(other)) {
            (Some(own), Some(other)) => {
                other.iter().zip(own).all(|(other, own)| *other <= own) && other != own
            }
            _ => false,
        };
        let dominating = points.iter().filter(dominated).count();
        assert_eq!(point["dominated_by"].as_array().unwrap().len(), dominating);
        assert_eq!(point["on_front"] == true, numbers(point).is_some() && dominating == 0);
        on_front += usize::from(point["on_front"] == true);
    }
    assert!((1..points.len()).contains(&on_front), "{on_front}");
    let csv = found.files.iter().find(|file| file.name == "front.csv").unwrap();
    assert_eq!(csv.bytes.iter().filter(|byte| **byte == b'\n').count(), 1 + points.len());
    assert!(found.files.iter().any(|file| file.name == "front.svg"));
}

/// Feasibility as a column is the relaxation: 0 if all specifications are satisfied; the points
/// that miss some are compared by it.
#[test]
fn a_front_may_go_over_feasibility() {
    let text = LOOP.replace("limit = 2", "limit = 1.5")
        + "[[specification]]\nkind = \"sensitivity\"\nlimit = 0.2\nfrequencies = [1]\n";
    let found = json_of(&answer(
        &text,
        &[
            "design.maximum_order=1",
            "alternative=[{ name = \"faster\", set = { \"plant.denominator\" = \"s + 3\" } }]",
        ],
        &[],
        &front("feasible,swept:more", "plant.delay=1 ms..1 s"),
    ));
    let points = found["front"]["points"].as_array().unwrap();
    let of = |point: &Value| (point["feasible"].as_bool().unwrap(), point["relaxation_db"].as_f64().unwrap());
    let all: Vec<(bool, f64)> = points.iter().map(of).collect();
    assert!(all.iter().all(|(feasible, relaxation)| *feasible == (*relaxation == 0.0)), "{all:?}");
    assert!(
        all.iter().any(|(feasible, _)| *feasible) && all.iter().any(|(feasible, _)| !feasible),
        "{all:?}"
    );
    assert!(points.iter().all(|point| point["comparable"] == true));
    // more delay and more relaxation: neither dominates the other
    let ends = |on_front: bool| points.iter().filter(|point| point["on_front"] == on_front).count();
    assert!(ends(true) >= 2, "{found}");
}

/// A request that is rejected before anything is designed.
#[test]
fn an_impossible_front_has_its_reason() {
    let refused = |columns: &str, sweep: &str| {
        crate::run_command::try_answer(LOOP, &[], &[], &front(columns, sweep)).unwrap_err().to_string()
    };
    let delay = "plant.delay=1 ms..20 ms";
    let spelled = refused("ordr,swept", delay);
    assert_eq!(spelled, "--front ordr,swept: there is no column `ordr`; did you mean `order`?");
    assert!(refused("order", delay).contains("two or three columns"));
    assert!(refused("colour_of_the_oil,swept", delay).contains("; there are relaxation_db, order,"));
    assert!(refused("order,order:more", delay).contains("`order` is listed twice"));
    assert!(refused("order:best,swept", delay).contains("neither `less` nor `more`"));
    assert!(refused("order,swept", "plant.dely=1..2").contains("did you mean `plant.delay`?"));
}
