//! The front over the length of a hose that the book shows.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{AlternativesRequest, Request};

use super::alternatives::{BOOK, parsed, rows_of_the_book, stands_in};
use super::ask::{HOSE, answer};

const FIGURE: &str = include_str!("../../../book/src/images/hose_length_front.svg");
/// What the book passes to the command.
const BY_VOLUME: &str =
    r#"alternative=[{ name = "by volume", recentre = true, set = { "line.compliance" = "by_volume" } }]"#;
const COLUMNS: &str = "swept,disturbance_peak_n,stiffness_minimum_n_per_m:less";
const SWEEP: &str = "line.length=0.5 m..4 m";

/// Table, figure and findings of the book are those of the command that it states.
#[test]
#[ignore = "eighteen designs"]
fn soak_the_book_says_what_the_front_shows() {
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
    let missing: Vec<&String> = rows.iter().filter(|row| !stands_in(row, &found.text)).collect();
    assert!(missing.is_empty(), "{missing:#?}\n{}", found.text);
    let drawn = found.files.iter().find(|file| file.name == "front.svg").unwrap();
    assert!(drawn.bytes == FIGURE.as_bytes(), "the figure of the book is not the one that is drawn");
    let json = parsed(&found);
    let points = json["front"]["points"].as_array().unwrap();
    let of = |name: &str, length: f64| {
        let here = points.iter().find(|point| point["alternative"] == name && point["value"] == length);
        here.unwrap()["disturbance_peak_n"].as_f64().unwrap()
    };
    let by_volume = |length: f64| of("by volume", length);
    // the findings, to the digits of the book
    assert_eq!((by_volume(0.5) - by_volume(1.0)).round(), 188.0);
    assert_eq!((by_volume(2.0) - by_volume(2.5)).round(), 80.0);
    assert_eq!((100.0 * (1.0 - by_volume(2.5) / by_volume(0.5))).round(), 27.0);
}
