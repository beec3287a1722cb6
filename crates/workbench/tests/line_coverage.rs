//! Coverage of the truth by the intervals of an identified line.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::print_stdout, reason = "how often and how wide is worth reading")]

use crate::run_command::{HOSE, load};
use phea_hydraulics::line::{Conduit, Line, Stiffening, StiffeningMember};
use phea_workbench::engineering::estimate::Estimate;
use phea_workbench::engineering::line_test::{
    KnownLine, LineIdentification, LineRecord, LineRun, LineSeries, NotIdentifiableLine, RiseRecord,
    VolumeSource, clean_line_runs, identify_line, recorded,
};
use phea_workbench::engineering::response::{ResponseSettings, SampledPair};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::{Bench, Loaded};

/// A hose whose wall creeps, with one pressure in it.
pub(crate) const CREEPING: [&str; 5] = [
    "line.model=\"creeping\"",
    "line.relaxation_time=\"20 ms\"",
    "bench.line.frequencies=[\"0.5 Hz\", \"60 Hz\"]",
    "bench.line.rise_sample_time=\"100 ms\"",
    "bench.line.periods=5",
];

/// A hose with waves and an elastic wall.
pub(crate) const WAVES: [&str; 8] = [
    "line.model=\"transmission_line\"",
    "bench.line.frequencies=[\"4 Hz\", \"200 Hz\"]",
    "bench.line.period=\"250 ms\"",
    "bench.line.periods=5",
    "bench.line.lines=12",
    "bench.line.rise_time=\"4 s\"",
    "bench.line.standstill=\"1 s\"",
    "bench.line.rise_sample_time=\"20 ms\"",
];

const SETTINGS: ResponseSettings =
    ResponseSettings { period: None, settling: None, segment: None, coherence: 0.0 };

/// Number required of an identification, and its true value.
type Sought = (&'static str, fn(&LineIdentification) -> &Result<Estimate, NotIdentifiableLine>, f64);

/// Each 95 % interval covers the truth as often as a binomial distribution allows.
#[test]
fn intervals_of_a_creeping_hose_cover_the_truth() {
    // ORIGIN: analytic, 40 trials at 95 %: 33 or more with a probability of 99.7 %
    check(40, &CREEPING, &of_creeping, 33..=40);
}

#[test]
fn intervals_of_a_hose_with_waves_cover_the_truth() {
    // ORIGIN: analytic, 40 trials at 95 %: 33 or more with a probability of 99.7 %
    check(40, &WAVES, &of_waves, 33..=40);
}

#[test]
fn intervals_from_a_flow_meter_cover_the_truth() {
    let loaded = project(&CREEPING);
    let known = known(&loaded);
    let truth = known.volume() / compliance(&known, 1.0);
    // ORIGIN: analytic, 40 trials at 95 %: 33 or more with a probability of 99.7 %
    check_metered(40, &loaded, truth, 33..=40);
}

/// Coverage over four hundred recordings, by `cargo xtask ci soak`.
#[test]
#[ignore = "takes a minute"]
fn soak_four_hundred_intervals_of_a_line_cover_the_truth() {
    // ORIGIN: analytic, 400 trials at 95 %: 380 expected, three standard deviations to either side
    let allowed = 366..=391;
    check(400, &CREEPING, &of_creeping, allowed.clone());
    check(400, &WAVES, &of_waves, allowed.clone());
    let loaded = project(&CREEPING);
    let known = known(&loaded);
    let truth = known.volume() / compliance(&known, 1.0);
    check_metered(400, &loaded, truth, allowed);
}

pub(crate) fn project(settings: &[&str]) -> Loaded {
    load(HOSE, &[settings, &["bench.line.side=\"a\""]].concat(), &[])
}

pub(crate) fn known(loaded: &Loaded) -> KnownLine {
    let setup = Setup::new(&loaded.project).unwrap();
    KnownLine::of(&setup, loaded.project.bench.line.unwrap().side).unwrap()
}

/// dV/dp of the declared line with another r_beta, in m3/Pa.
pub(crate) fn compliance(known: &KnownLine, stiffening: f64) -> f64 {
    let Line::Hose { mut hose, length } = known.line else { panic!("no hose") };
    hose.dynamic_stiffening = Stiffening::certain(stiffening);
    let line = Line::Hose { hose, length };
    line.compliance(known.fluid.modulus_at(known.pressure), StiffeningMember::Nominal)
}

fn of_creeping(known: &KnownLine) -> Vec<Sought> {
    vec![
        ("modulus at rest", |found| &found.effective_bulk_modulus, known.volume() / compliance(known, 1.0)),
        ("dynamic modulus", |found| &found.dynamic_bulk_modulus, known.volume() / compliance(known, 5.0)),
        ("dynamic stiffening", |found| &found.dynamic_stiffening, 5.0),
        ("relaxation time", |found| &found.relaxation_time, 20e-3),
    ]
}

fn of_waves(known: &KnownLine) -> Vec<Sought> {
    let member = StiffeningMember::Nominal;
    let conduit = Conduit::of_line(&known.line, &known.fluid, known.pressure, member).unwrap();
    vec![
        ("modulus at rest", |found| &found.effective_bulk_modulus, conduit.effective_bulk_modulus),
        ("dynamic modulus", |found| &found.dynamic_bulk_modulus, conduit.effective_bulk_modulus),
        // the wall of a line with waves is as stiff at rest as in motion
        ("dynamic stiffening", |found| &found.dynamic_stiffening, 1.0),
        ("wave speed", |found| &found.wave_speed, conduit.speed()),
    ]
}

/// Record of a run, as input of the identification.
pub(crate) fn record(run: &LineRun) -> LineRecord {
    let (file, pressures) = (run.series.name().to_string(), run.pressures.clone());
    match run.series {
        LineSeries::PressureRise => LineRecord::Rise(RiseRecord {
            file,
            source: VolumeSource::Volume,
            times: run.times.clone(),
            volumes: run.inputs.clone(),
            pressures,
        }),
        LineSeries::FrequencyResponse => LineRecord::Response(SampledPair {
            reference: None,
            recorded_loop: None,
            controller: None,
            operating_point: None,
            resampled: None,
            file,
            signals: ["flow", "pressure"],
            units: ["m3/s", "Pa"],
            time_step: run.times[1] - run.times[0],
            input: run.inputs.clone(),
            output: pressures,
        }),
    }
}

/// The identifications of this number of recordings of one line, by as many threads as there are
/// processors.
fn study<T: Send>(repetitions: u32, of: impl Fn(u32) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u32);
    std::thread::scope(|scope| {
        let of = &of;
        let fraction = |first: u32| {
            let own = (1..=repetitions).filter(move |seed| seed % threads == first);
            scope.spawn(move || own.map(of).collect::<Vec<T>>())
        };
        let running: Vec<_> = (0..threads).map(fraction).collect();
        running.into_iter().flat_map(|one| one.join().unwrap()).collect()
    })
}

#[track_caller]
fn check(
    repetitions: u32,
    settings: &[&str],
    sought: &dyn Fn(&KnownLine) -> Vec<Sought>,
    allowed: std::ops::RangeInclusive<usize>,
) {
    let loaded = project(settings);
    let known = known(&loaded);
    let clean = clean_line_runs(&Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap();
    let found = study(repetitions, |seed| {
        let bench = Bench { seed, ..loaded.project.bench };
        let mut runs = clean.clone();
        runs.iter_mut().for_each(|run| recorded(run, &bench));
        let records = runs.iter().map(record).collect();
        identify_line(records, known.clone(), &SETTINGS, &mut |_| true).unwrap()
    });
    let mut wrong = Vec::new();
    for (name, of, truth) in sought(&known) {
        let numbers =
            || found.iter().map(|one| of(one).as_ref().unwrap_or_else(|why| panic!("{name}: {why:?}")));
        let covered = numbers().filter(|one| one.interval[0] <= truth && truth <= one.interval[1]).count();
        let widths = numbers().map(|one| (one.interval[1] - one.interval[0]) / 2.0 / truth);
        let width = 100.0 * widths.sum::<f64>() / found.len() as f64;
        println!("{name:20} {truth:.5e} covered {covered} of {repetitions}, half width {width:.3} %");
        if !allowed.contains(&covered) {
            wrong.push(name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// A pressure rise whose volume is the integral of a flow that a meter reads with noise and a zero
/// error.
#[track_caller]
fn check_metered(repetitions: u32, loaded: &Loaded, truth: f64, allowed: std::ops::RangeInclusive<usize>) {
    let known = known(loaded);
    let clean = clean_line_runs(&Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap();
    let rise = clean.iter().find(|run| run.series == LineSeries::PressureRise).unwrap();
    let found = study(repetitions, |seed| {
        let mut state = phea_dynamics::random::stream(3, u64::from(seed));
        let mut run = rise.clone();
        let bench = Bench { seed, ..loaded.project.bench };
        recorded(&mut run, &bench);
        // a tenth of the flow that displaces 15 mL in 20 s
        let [noise, zero] = [8e-8, 5e-9];
        let mut sum = 0.0;
        for (row, value) in run.inputs.iter_mut().enumerate() {
            let step = 0.1 * (zero + noise * phea_dynamics::random::normal(&mut state));
            sum += if row > 0 { step } else { 0.0 };
            *value = rise.inputs[row] + sum;
        }
        let LineRecord::Rise(rise) = record(&run) else { panic!("no rise") };
        let rise = RiseRecord { source: VolumeSource::Flow, ..rise };
        let found =
            identify_line(vec![LineRecord::Rise(rise)], known.clone(), &SETTINGS, &mut |_| true).unwrap();
        found.effective_bulk_modulus.unwrap()
    });
    let covered = found.iter().filter(|one| one.interval[0] <= truth && truth <= one.interval[1]).count();
    println!("by a flow meter: covered {covered} of {repetitions}");
    assert!(allowed.contains(&covered), "{covered} of {repetitions}");
}
