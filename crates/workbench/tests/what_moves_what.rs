//! Keys of the project and the parts that they move: every key changed on several rigs, and the
//! corresponding table of the guide.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

mod linear;
mod rigs;
mod unused;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use num_complex::Complex64;
use phea_workbench::catalogue::Catalogue;
use phea_workbench::engineering::rig::{ResolvedParameter, Rig};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::ControlledMachine;
use phea_workbench::engineering::sizing::{Question, Sizing, size, sizing_problem};
use phea_workbench::project::{self, KeyEntry, LINEAR_PARAMETERS, Loaded, Project};
use phea_workbench::source::Memory;

use linear::linear_parameters_follow_from_what_is_listed;
use rigs::{absent_tables, is_within, others, rigs};
use unused::unmoved_keys_are_used;

const GUIDE: &str = include_str!("../../../book/src/guide/what_moves_what.md");
/// Tables that declare the rig and its loop; the others state its requirements.
const TABLES: [&str; 17] = [
    "fluid",
    "supply",
    "valve",
    "cylinder",
    "motor",
    "line",
    "cross_port",
    "port_valves",
    "load",
    "force_sensor",
    "velocity_sensor",
    "series",
    "linkage",
    "operating_point",
    "linear",
    "controller",
    "prefilter",
];
/// Parts that a key may move, in the order of the columns.
const PARTS: [&str; 5] = ["sizing", "plant", "loop", "sensor", "machine"];

fn loaded(text: &str, settings: &[String]) -> Option<Loaded> {
    let source = Memory::default().with("rig.toml", text);
    project::read(&source, "rig.toml", settings, &[]).ok()
}

/// Computed parts of a project: one text for each part, `None` for a part that it does not have or
/// that is not requested; and the parameters of its linear model.
fn computed(
    project: &Project,
    requested: [bool; PARTS.len()],
) -> ([Option<String>; PARTS.len()], Vec<ResolvedParameter>) {
    let setup = Setup::new(project).unwrap();
    let sizing = || sizing_problem(&setup, &Catalogue::default()).ok();
    let plant = || {
        let rig = setup.rig().ok().map(Rig::in_loop)?;
        let load = |w: f64| match &rig.in_motion {
            Some(plant) => plant.response(Complex64::new(0.0, w))[1],
            None => rig.plant.coefficients().disturbance.unwrap().at_frequency(w),
        };
        let at = |w: f64| format!("{:?} {:?}", rig.response(w), load(w));
        Some([0.3, 20.0, 400.0, 1000.0, 3000.0].map(at).concat())
    };
    let closed = || {
        let compensation = setup.compensation(setup.controller.as_ref()?).ok()?;
        Some(format!("{compensation:?} {:?}", setup.prefilter))
    };
    // the machine of a bench is after its rig, and before the additions of a scenario
    let machine = || {
        let all = format!("{:?}", ControlledMachine::new(&setup).ok()?);
        Some(all[all.find(", machine: ").unwrap()..].to_string())
    };
    let parts: [&dyn Fn() -> Option<String>; PARTS.len()] = [
        // a warning about a valve is not a result
        &|| {
            sizing().map(|problem| {
                format!("{:?}", Sizing { port_valves: vec![], ..size(&problem, Question::Both) })
            })
        },
        &plant,
        &closed,
        &|| Some(format!("{:?}", setup.sensor)),
        &machine,
    ];
    let found = std::array::from_fn(|index| requested[index].then(parts[index]).flatten());
    (found, setup.rig().map(|rig| rig.parameters.clone()).unwrap_or_default())
}

/// Effects of changing a key, as far as tested.
#[derive(Default)]
struct Changes {
    parts: BTreeSet<&'static str>,
    /// Largest relative change of each derived parameter of the linear model.
    linear: BTreeMap<&'static str, f64>,
}

impl Changes {
    /// True if no further effect of a key can be found.
    fn are_known(&self, path: &str, requested: [bool; PARTS.len()]) -> bool {
        requested == [false; PARTS.len()] && sources(path).all(|name| self.linear.contains_key(name))
    }
}

type Moved = BTreeMap<String, Changes>;

/// The parameters of the linear model that are listed as derived from a path.
fn sources(path: &str) -> impl Iterator<Item = &'static str> {
    let from = LINEAR_PARAMETERS.iter().filter(move |parameter| parameter.follows_from(path));
    from.map(|parameter| parameter.key.name)
}

/// Keys of the tables above that are changed one at a time.
fn keys() -> Vec<KeyEntry> {
    project::keys()
        .into_iter()
        .filter(|entry| TABLES.iter().any(|table| entry.path.starts_with(&format!("{table}."))))
        .filter(|entry| !entry.path.contains("[]") && !entry.path.contains("NAME"))
        .collect()
}

/// Processes the rigs one by one, with as many threads as there are processors.
fn on_every_rig(take: impl Fn(&str, &[String]) + Sync) {
    let rigs = Mutex::new(rigs().into_iter());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let Some((text, settings)) = rigs.lock().unwrap().next() else { break };
                    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
                    take(&text, &settings);
                }
            });
        }
    });
}

/// Changes each key of one rig, and adds the parts that it moves.
fn try_keys(text: &str, settings: &[String], keys: &[KeyEntry], moved: &Mutex<Moved>) {
    let Some(own) = loaded(text, settings) else { panic!("{settings:?}") };
    let (before, derived) = computed(&own.project, [true; PARTS.len()]);
    let absent = absent_tables(keys, &own.project);
    for entry in keys.iter().filter(|entry| !is_within(entry, &absent)) {
        // parts that are known to move are not tested again
        let requested = {
            let moved = moved.lock().unwrap();
            let known = moved.get(&entry.path);
            let open = |index: usize| {
                before[index].is_some() && known.is_none_or(|row| !row.parts.contains(PARTS[index]))
            };
            let requested = std::array::from_fn(open);
            if known.is_some_and(|known| known.are_known(&entry.path, requested)) {
                continue;
            }
            requested
        };
        let (others, one_is_enough) = others(entry, &own.project);
        for other in others {
            let changed = [settings, &[format!("{}={other}", entry.path)]].concat();
            let Some(other) = loaded(text, &changed).filter(|other| other.project != own.project) else {
                continue;
            };
            let (after, now) = computed(&other.project, requested);
            let mut moved = moved.lock().unwrap();
            let row = moved.entry(entry.path.clone()).or_default();
            for ((part, before), after) in PARTS.iter().zip(&before).zip(after) {
                if before.is_some() && after.is_some() && *before != after {
                    row.parts.insert(part);
                }
            }
            for (was, is) in derived.iter().zip(&now).filter(|(was, is)| was.derived != is.derived) {
                let change = ((is.derived - was.derived) / was.derived).abs();
                row.linear.entry(was.name).and_modify(|most| *most = most.max(change)).or_insert(change);
            }
            if one_is_enough {
                break;
            }
        }
    }
}

/// The row of a key, without the reason.
fn row(key: &str, moves: &BTreeSet<&str>) -> String {
    let cells: Vec<&str> = PARTS.iter().map(|part| if moves.contains(part) { "x" } else { "" }).collect();
    format!("| `{key}` | {} |", cells.join(" | "))
}

/// The guide's table agrees with the computed effects, key by key; for a key that moves nothing it
/// states the reason, and a command must answer differently because of it.
#[test]
fn the_table_of_the_guide_is_correct() {
    let keys = keys();
    let moved = Mutex::new(Moved::new());
    on_every_rig(|text, settings| try_keys(text, settings, &keys, &moved));
    let moved = moved.into_inner().unwrap();
    let untried: BTreeSet<&str> =
        keys.iter().map(|entry| entry.path.as_str()).filter(|path| !moved.contains_key(*path)).collect();
    // items that begin with keys; their explanation follows a colon
    let items = GUIDE.split("\n- `").skip(1).filter_map(|item| item.split_once(':')).map(|(keys, _)| keys);
    let apart: BTreeSet<&str> =
        items.flat_map(|keys| keys.split('`').step_by(2)).filter(|key| !key.is_empty()).collect();
    assert_eq!(untried, apart, "keys that are not changed one by one");
    let guide_rows: BTreeMap<&str, &str> = GUIDE
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| (line.split('`').nth(1).unwrap(), line))
        .collect();
    let mut wrong: Vec<String> = Vec::new();
    let mut still: BTreeSet<&str> = BTreeSet::new();
    for (key, Changes { parts, .. }) in &moved {
        let expected = row(key, parts);
        let reason = guide_rows.get(key.as_str()).and_then(|line| line.strip_prefix(&expected));
        let reason = reason.map(|reason| reason.trim_matches([' ', '|']));
        match reason {
            None if parts.is_empty() => wrong.push(format!("{expected} why?")),
            None => wrong.push(expected),
            Some("") if parts.is_empty() => wrong.push(format!("{expected} why?")),
            Some(_) if parts.is_empty() => drop(still.insert(key)),
            Some(_) => {}
        }
    }
    let gone: Vec<&&str> = guide_rows.keys().filter(|key| !moved.contains_key(**key)).collect();
    assert!(wrong.is_empty() && gone.is_empty(), "{}\nnot tried: {gone:?}", wrong.join("\n"));
    linear_parameters_follow_from_what_is_listed(&moved, &keys);
    unmoved_keys_are_used(&still, &keys);
}
