//! Functions of time: their derivatives, ends and breaks.
#![cfg(test)]

use phea_dynamics::portable;
use phea_dynamics::simulation::{Harmonic, Profile, ProfileError, schroeder_phases};

fn harmonic(amplitude: f64, frequency_rad_per_s: f64, phase_rad: f64) -> Harmonic {
    Harmonic { amplitude, frequency_rad_per_s, phase_rad }
}

fn every_kind() -> Vec<(&'static str, Profile)> {
    let times = [0.0, 0.1, 0.25, 0.3, 0.6, 0.61];
    let values = [1.0, 1.5, 1.4, 1.4, -2.0, -1.0];
    vec![
        ("constant", Profile::constant(3.0)),
        ("steps", Profile::steps(1.0, &[(0.1, -2.0), (0.4, 5.0)]).unwrap()),
        ("smooth step", Profile::smooth_step(0.1, 0.3, -2.0).unwrap()),
        ("first order", Profile::first_order(0.1, 0.05, 5.0).unwrap()),
        ("sine", Profile::sine(0.1, 2.0, 30.0).unwrap()),
        ("rising chirp", Profile::chirp(0.1, 0.5, 2.0, [5.0, 60.0]).unwrap()),
        ("falling chirp", Profile::chirp(0.1, 0.5, 2.0, [60.0, 5.0]).unwrap()),
        ("table", Profile::table(&times, &values).unwrap()),
        ("ramp", Profile::ramp(0.1, 0.3, 5.0).unwrap()),
        (
            "multisine",
            Profile::multisine(0.1, &[harmonic(2.0, 30.0, 0.3), harmonic(1.0, 50.0, -2.0)]).unwrap(),
        ),
        (
            "sum",
            Profile::sum(&[
                Profile::ramp(0.1, 0.3, 5.0).unwrap(),
                Profile::sine(0.2, 2.0, 30.0).unwrap().held_from(0.5),
                Profile::table(&times, &values).unwrap().begun_at(0.05),
            ]),
        ),
    ]
}

/// Derivatives of every piece agree with its values, beyond its ends as well.
#[test]
fn derivatives_are_central_differences() {
    let step = 1e-5;
    for (name, profile) in every_kind() {
        for index in 0..140 {
            let time_s = 0.005 * f64::from(index) + 0.0017;
            let piece = profile.piece(time_s);
            let [before, here, after] = [-step, 0.0, step].map(|shift| piece.at(time_s + shift));
            let rate = (after.value - before.value) / (2.0 * step);
            let acceleration = (after.rate - before.rate) / (2.0 * step);
            assert!((rate - here.rate).abs() < 1e-5 * (1.0 + here.rate.abs()), "{name} at {time_s}");
            let tolerance = 1e-4 * (1.0 + here.acceleration.abs());
            assert!((acceleration - here.acceleration).abs() < tolerance, "{name} at {time_s}");
            assert_eq!((here.value, here.rate), (profile.value(time_s), profile.rate(time_s)));
            assert_eq!(here.acceleration, profile.acceleration(time_s));
        }
    }
}

#[test]
fn a_smooth_step_starts_and_ends_at_rest() {
    let motion = Profile::smooth_step(3.0, 0.1, 5e-3).unwrap();
    let rise = motion.piece(3.0);
    let [start, end] = [rise.at(3.0), rise.at(3.1)];
    assert_eq!((start.value, start.rate, start.acceleration), (0.0, 0.0, 0.0));
    // t - 3 is rounded: the remainder at the end is rounding
    assert!((end.value - 5e-3).abs() < 1e-15 && end.rate.abs() < 1e-13 && end.acceleration.abs() < 1e-10);
    assert_eq!((motion.value(3.1), motion.rate(3.1), motion.acceleration(3.1)), (5e-3, 0.0, 0.0));
    assert_eq!((motion.value(2.0), motion.value(1e6)), (0.0, 5e-3));
    assert_eq!(motion.longest_step(), None);
}

#[test]
fn a_first_order_step_covers_an_equal_fraction_in_each_time_constant() {
    let motion = Profile::first_order(1.0, 0.05, 5e-3).unwrap();
    assert_eq!((motion.value(1.0), motion.rate(1.0)), (0.0, 5e-3 / 0.05));
    assert!((motion.value(1.05) - 5e-3 * (1.0 - portable::exp(-1.0))).abs() < 1e-15);
    assert_eq!(motion.value(1e3), 5e-3);
    assert_eq!(motion.breaks(), [1.0]);
}

#[test]
fn a_chirp_ends_at_its_final_frequency_and_remains_at_its_final_value() {
    let (duration, frequencies) = (2.0, [10.0, 50.0]);
    let chirp = Profile::chirp(1.0, duration, 3.0, frequencies).unwrap();
    // the phase is the mean frequency times the duration
    let end = 3.0 * portable::sin(0.5 * (10.0 + 50.0) * duration);
    assert!((chirp.value(3.0) - end).abs() < 1e-12 && chirp.value(9.0) == chirp.value(3.0));
    let last = chirp.piece(2.0).at(3.0);
    let amplitude = portable::hypot(last.value, last.rate / 50.0);
    assert!((amplitude - 3.0).abs() < 1e-12);
    assert_eq!(chirp.breaks(), [1.0, 3.0]);
    assert_eq!(chirp.longest_step(), Some(0.5 * std::f64::consts::PI / 50.0));
    let falling = Profile::chirp(1.0, duration, 3.0, [50.0, 10.0]).unwrap();
    assert_eq!(falling.longest_step(), chirp.longest_step());
}

#[test]
fn a_table_passes_through_its_points_and_preserves_its_shape() {
    let times = [0.0, 0.3, 0.4, 1.0, 1.7];
    let values = [0.0, 1.0, 8.0, 8.5, 8.5];
    let table = Profile::table(&times, &values).unwrap();
    assert_eq!(table.breaks(), times);
    for (time_s, value) in times.iter().zip(values) {
        assert_eq!(table.value(*time_s), value);
    }
    assert_eq!((table.value(-1.0), table.value(5.0), table.rate(5.0)), (0.0, 8.5, 0.0));
    let sampled: Vec<f64> = (0..=1700).map(|index| table.value(1e-3 * f64::from(index))).collect();
    assert!(sampled.windows(2).all(|pair| pair[1] - pair[0] > -1e-14), "rising points, rising curve");
    for inner in &times[1..4] {
        let jump = table.rate(*inner) - table.rate(inner - 1e-9);
        assert!(jump.abs() < 1e-5, "the velocity jumps by {jump} at {inner}");
    }
}

#[test]
fn a_table_on_a_line_is_the_line_and_on_a_fine_grid_the_function() {
    let line = Profile::table(&[0.0, 1.0, 4.0], &[1.0, 3.0, 9.0]).unwrap();
    let two = Profile::table(&[0.0, 4.0], &[1.0, 9.0]).unwrap();
    for time_s in [0.2, 1.5, 3.9] {
        for table in [&line, &two] {
            assert!((table.value(time_s) - (1.0 + 2.0 * time_s)).abs() < 1e-14);
            assert!((table.rate(time_s) - 2.0).abs() < 1e-14);
        }
    }
    // away from extreme points halving the grid divides the error by eight: the slopes are of
    // second order
    let error = |count: i32| {
        let times: Vec<f64> = (0..=count).map(|index| 3.0 * f64::from(index) / f64::from(count)).collect();
        let values: Vec<f64> = times.iter().map(|time_s| portable::exp(*time_s)).collect();
        let table = Profile::table(&times, &values).unwrap();
        let errors = (0..=1000).map(|index| 3e-3 * f64::from(index));
        errors.map(|time_s| (table.value(time_s) - portable::exp(time_s)).abs()).fold(0.0, f64::max)
    };
    assert!(error(80) < 0.14 * error(40) && error(40) < 1e-3, "{} {}", error(40), error(80));
}

#[test]
fn invalid_functions_of_time_are_refused() {
    let positive = |result: Result<Profile, ProfileError>| match result {
        Err(ProfileError::OutOfRange { value, .. }) => value,
        other => panic!("{other:?}"),
    };
    assert_eq!(positive(Profile::smooth_step(0.0, 0.0, 1.0)), 0.0);
    assert_eq!(positive(Profile::first_order(0.0, -1.0, 1.0)), -1.0);
    assert_eq!(positive(Profile::sine(0.0, f64::INFINITY, 1.0)), f64::INFINITY);
    assert_eq!(positive(Profile::chirp(0.0, 1.0, 1.0, [1.0, -3.0])), -3.0);
    let steps = Profile::steps(0.0, &[(1.0, 2.0), (1.0, 3.0)]);
    assert_eq!(steps, Err(ProfileError::TimeOrder { index: 1, time_s: 1.0 }));
    assert!(matches!(Profile::steps(0.0, &[(f64::NAN, 2.0)]), Err(ProfileError::TimeOrder { index: 0, .. })));
    assert_eq!(Profile::table(&[0.0], &[1.0]), Err(ProfileError::Count { times: 1, values: 1 }));
    assert_eq!(Profile::table(&[0.0, 1.0], &[1.0]), Err(ProfileError::Count { times: 2, values: 1 }));
}

/// Values, breaks and longest step of a sum follow from those of its parts.
#[test]
fn a_sum_is_the_sum_of_its_parts() {
    let every: Vec<Profile> = every_kind().into_iter().map(|(_, profile)| profile).collect();
    let sum = Profile::sum(&every);
    for index in 0..300 {
        let time_s = 0.0025 * f64::from(index);
        let parts = |of: fn(&Profile, f64) -> f64| every.iter().map(|part| of(part, time_s)).sum::<f64>();
        assert!((sum.value(time_s) - parts(Profile::value)).abs() < 1e-12, "{time_s}");
        assert!((sum.rate(time_s) - parts(Profile::rate)).abs() < 1e-9, "{time_s}");
        assert!((sum.value_before(time_s) - parts(Profile::value_before)).abs() < 1e-12, "{time_s}");
    }
    for part in &every {
        assert!(part.breaks().iter().all(|time_s| sum.breaks().contains(time_s)));
    }
    let shortest = every.iter().filter_map(Profile::longest_step).reduce(f64::min);
    assert_eq!(sum.longest_step(), shortest);
    assert_eq!(Profile::sum(&[]), Profile::constant(0.0));
    // a sum of steps is constant between their breaks
    let steps = [(1.0, 3.0), (2.0, 1.0)].map(|step| Profile::steps(0.0, &[step]).unwrap());
    assert_eq!(Profile::sum(&steps), Profile::steps(0.0, &[(1.0, 3.0), (2.0, 4.0)]).unwrap());
}

#[test]
fn a_multisine_of_one_is_a_sine_and_equal_amplitudes_have_the_phases_of_the_closed_form() {
    let phases = schroeder_phases(&[3.0]);
    let one = Profile::multisine(0.5, &[harmonic(3.0, 7.0, phases[0])]).unwrap();
    assert_eq!(one, Profile::sine(0.5, 3.0, 7.0).unwrap());
    let phases = schroeder_phases(&[2.0; 10]);
    for (index, phase) in phases.iter().enumerate() {
        let k = index as f64 + 1.0;
        // ORIGIN: analytic, -pi k (k - 1)/N
        assert!((phase + std::f64::consts::PI * k * (k - 1.0) / 10.0).abs() < 1e-12);
    }
    // for unequal amplitudes, by the double sum itself
    let amplitudes: [f64; 4] = [1.0, 2.0, 0.5, 3.0];
    let power: f64 = amplitudes.iter().map(|a| a * a).sum();
    for (k, phase) in schroeder_phases(&amplitudes).iter().enumerate() {
        let sum: f64 = (0..k).map(|n| (k - n) as f64 * amplitudes[n] * amplitudes[n] / power).sum();
        assert!((phase + 2.0 * std::f64::consts::PI * sum).abs() < 1e-12);
    }
}

#[test]
fn held_and_late_signals_are_constant_outside_their_range() {
    let sine = Profile::sine(0.0, 2.0, 5.0).unwrap();
    let held = sine.clone().held_from(0.3);
    assert_eq!(
        (held.value(0.2), held.value(0.3), held.value(9.0)),
        (sine.value(0.2), sine.value(0.3), sine.value(0.3))
    );
    assert_eq!((held.rate(0.3), held.breaks()), (0.0, vec![0.0, 0.3]));
    let ramp = Profile::ramp(1.0, 1.0, 2.0).unwrap();
    let late = ramp.clone().begun_at(1.5);
    assert_eq!((late.value(1.4), late.value(1.5), late.value(3.0)), (0.0, 1.0, 2.0));
    assert_eq!(late.breaks(), [1.5, 2.0]);
    // a time between two breaks cuts the later one off
    assert_eq!(ramp.held_from(1.5).breaks(), [1.0, 1.5]);
}
