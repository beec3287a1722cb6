//! Tests that begin after other cycles: the spool still has their memory.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::valve_identification::{TRUTH, identified, recorded};

/// The files without their first rows: the remaining ones begin with the memory of the removed
/// ones.
fn cut(files: &[(String, String)], fraction: f64) -> Vec<(String, String)> {
    let of = |(name, text): &(String, String)| {
        let rows = text.lines().count() - 1;
        let gone = (fraction * rows as f64) as usize;
        let left: Vec<&str> = text.lines().take(1).chain(text.lines().skip(1 + gone)).collect();
        (name.clone(), left.join("\n"))
    };
    files.iter().map(of).collect()
}

/// The lag of the spool after the removed commands, in V.
///
/// ORIGIN: analytic, the command draws it in each direction to half the width of 128 mV, over a
/// travel of the width.
fn lag_after(text: &str, fraction: f64) -> f64 {
    let commands: Vec<f64> =
        text.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse().unwrap()).collect();
    let gone = (fraction * commands.len() as f64) as usize;
    commands[..=gone].windows(2).fold(0.0, |lag, pair| {
        let way = pair[1] - pair[0];
        let end = 0.064 * way.signum();
        end + (lag - end) * phea_dynamics::portable::exp(-way.abs() / 0.128)
    })
}

/// A test of two cycles without its beginning: its memory is found, the truth is in the intervals,
/// and no misfit remains.
#[test]
fn a_test_after_other_cycles_is_explained() {
    let mut held = 0;
    // the second is cut just after a reversal of the command: the lag is still that of the
    // direction before
    for (seed, fraction) in (1..).zip([0.1, 0.13, 0.25, 0.45]) {
        let seed = format!("bench.seed={seed}");
        let files = recorded(&["bench.cycles=2", "bench.duration=\"480 s\"", &seed]);
        let (_, gain) = files.iter().find(|(name, _)| name.starts_with("pressure_gain")).unwrap();
        let found = identified(&cut(&files, fraction));
        assert_eq!(found["misfits"].as_array().unwrap().len(), 0, "{fraction}: {}", found["misfits"]);
        let tests = found["tests"].as_array().unwrap();
        let test = tests.iter().find(|one| one["file"].as_str().unwrap().starts_with("pressure_gain"));
        let memory_v = test.unwrap()["memory_at_start_v"].as_f64().unwrap();
        let lag = lag_after(gain, fraction);
        assert!((memory_v - lag).abs() < 4e-3, "{fraction}: {memory_v} for {lag}");
        for (path, truth) in TRUTH {
            let interval = found.pointer(&format!("{path}/confidence_95")).unwrap();
            let [low, high] = [0, 1].map(|end| interval[end].as_f64().unwrap());
            let middle = 0.5 * (low + high);
            assert!((truth - middle).abs() < 1.5 * (high - low), "{fraction} {path}: {truth} {low} {high}");
            held += usize::from((low..=high).contains(&truth));
        }
    }
    // ORIGIN: analytic, 48 intervals of 95 %: 41 or more with a probability of 99.8 %
    assert!(held >= 41, "{held} of 48");
}

/// A test that begins at rest without memory has none.
#[test]
fn a_first_test_has_no_memory() {
    let found = identified(&recorded(&[]));
    for test in found["tests"].as_array().unwrap() {
        assert_eq!(test["memory_at_start_v"], 0.0, "{test}");
    }
}
