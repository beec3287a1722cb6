//! The hydraulic transmission between force sensor and load: the linear plant compared with the
//! machine, the line in segments with the distributed one, its stiffness in slow motions, ledgers
//! and passivity.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::portable::pow;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::impedance::{
    AsymptoteKind, impedance_asymptotes, open_loop_impedance, port, through_oil,
};
use phea_hydraulics::line::{
    Conduit, DynamicLine, LaminarFriction, Line, LineModel, Pipe, PipeWall, Segments, StiffeningMember,
};
use phea_hydraulics::linear::{LinearParameters, transfer_functions};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{INDICATORS, Machine, MachineOptions, StartValues};
use phea_hydraulics::operating_point::{Condition, operating_point};
use phea_hydraulics::plant::{
    LinearElement, LinearLoad, LinearPlant, LinearSeries, PlantInMotion, SeriesOutput,
};
use phea_hydraulics::reference_rig::{components, hose_line, nominal_plant};
use phea_hydraulics::series::{ForceFrom, SeriesElement, SeriesSpring, Transmission};
use phea_hydraulics::servovalve::Servovalve;
use phea_hydraulics::signal::{Signal, SignalPart};
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::{Motion, check, machine_of};
use super::series::{
    closes_at_any_state, drawn_with, is_the_machine, responds_as_its_polynomials, stays_passive,
    velocity_is_that_of_the_machine,
};

fn rig(transmission: Transmission) -> Components {
    let series = Some(SeriesElement::Transmission(transmission));
    Components { series, ..components(hose_line(), StiffnessModel::ByVolume) }
}

fn pipe(bore: f64, length: f64) -> Line {
    Line::Pipe { pipe: Pipe { bore, wall: PipeWall::Rigid }, length }
}

/// Transmission of one to three segments, every third with the soft hose, every other with oil in
/// addition to the line.
pub(super) fn transmission(number: u64) -> Transmission {
    let mut state = stream(81, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let length = spread(0.2, 6.0);
    let line = match (hose_line(), number % 3) {
        (Line::Hose { hose, .. }, 0) => Line::Hose { hose, length },
        _ => pipe(spread(3e-3, 2e-2), length),
    };
    let piston_area = spread(3e-4, 3e-3);
    Transmission {
        piston_area,
        line,
        end_volume: if number.is_multiple_of(2) { spread(1e-6, 1e-4) } else { 0.0 },
        filling_pressure: 3e3 / piston_area,
        segments: 1 + number as usize % 3,
    }
}

fn drawn(number: u64) -> super::series::Drawn {
    drawn_with(SeriesElement::Transmission(transmission(number)), number)
}

/// 200 rigs at 20 frequencies, to 1e-6; prescribed and yielding loads, a velocity fed forward in
/// every other.
#[test]
fn it_is_the_machine_for_small_motions() {
    for number in 0..200 {
        is_the_machine(&drawn(number), number);
    }
}

#[test]
fn the_velocity_of_the_load_is_that_of_the_machine() {
    for number in (2..80).filter(|number| number % 5 > 1) {
        velocity_is_that_of_the_machine(&drawn(number), number);
    }
}

#[test]
fn the_response_is_that_of_the_polynomials() {
    let bounded: usize = (0..80).map(|number| responds_as_its_polynomials(&drawn(number), number)).sum();
    assert!(bounded > 1000, "{bounded}");
}

fn at(polynomial: &[f64], s: Complex64) -> Complex64 {
    polynomial.iter().fold(Complex64::ZERO, |sum, one| sum * s + *one)
}

fn conduit(transmission: &Transmission) -> Conduit {
    let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
    Conduit::of_line(&transmission.line, &fluid, transmission.filling_pressure, StiffeningMember::Nominal)
        .unwrap()
}

/// Modes of a rig whose load is held, as pairs of frequency in rad/s and damping ratio, in addition
/// to those of the valve. ORIGIN: recomputed by comparisons/recompute_transmission.py, eigenvalues
/// of the equations in pressures and flows
#[test]
fn its_modes_are_those_of_pressures_and_flows() {
    let own = Transmission {
        piston_area: 2e-3,
        line: pipe(12e-3, 3.0),
        end_volume: 25e-6,
        filling_pressure: 60e5,
        segments: 3,
    };
    let parameters = LinearParameters { hydraulic_stiffness: 1.71e7, ..nominal_plant() };
    let plain = LinearPlant::of_load_pressure(&parameters, 0.0, LinearLoad::Prescribed);
    let plant = LinearPlant { series: LinearSeries::of_components(&rig(own), 0.0), ..plain };
    let poles = transfer_functions(&plant.coefficients()).unwrap().command.poles().to_vec();
    let size = |pole: &Complex64| pole.norm_sqr().sqrt();
    let expected = [
        (709.271_114, 7.681_063_28e-3),
        (1_529.153_55, 3.311_511_03e-3),
        (1_845.219_57, 2.705_784_48e-3),
        (2_395.040_41, 2.131_874_77e-3),
        (1_099.0, 0.9),
    ];
    for (frequency, damping) in expected {
        let nearest = poles.iter().find(|pole| pole.im > 0.0 && (size(pole) / frequency - 1.0).abs() < 1e-6);
        let Some(pole) = nearest else { panic!("{frequency}: {poles:?}") };
        assert!((-pole.re / size(pole) / damping - 1.0).abs() < 1e-5, "{frequency}: {pole}");
    }
    let slowest = poles.iter().map(|pole| pole.re).fold(f64::NEG_INFINITY, f64::max);
    assert!((slowest / -1.458_292_12 - 1.0).abs() < 1e-6 && poles.len() == 11, "{slowest}: {poles:?}");
}

/// Force held back from the load, in s: `LinearSeries::held_back`.
fn held_back(transmission: Transmission) -> Vec<f64> {
    LinearSeries::of_components(&rig(transmission), 0.0).unwrap().held_back().unwrap()
}

/// Pressure p_rod = b q + ... of a line with segments and a valve: F_s = ... + A^2 s b X_L.
#[test]
fn its_line_is_the_line_in_segments() {
    for number in 0..60 {
        let own = Transmission { segments: 1 + number as usize % 8, ..transmission(number) };
        let segments = Segments::new(&conduit(&own), own.segments, LaminarFriction::Steady).unwrap();
        let found_response = held_back(own);
        for frequency in [0.3, 20.0, 500.0, 4e3] {
            let s = Complex64::new(0.0, frequency);
            let line = DynamicLine::Segments(segments).transfer_matrix(s);
            let expected = line.impedance * s * (own.piston_area * own.piston_area);
            let error = (at(&found_response, s) / expected - 1.0).norm_sqr().sqrt();
            assert!(error < 1e-10, "{number} at {frequency}: {error}");
        }
    }
}

/// The distributed line with steady friction, Z_c sinh(Gamma): the error falls with the square of
/// the number of segments.
#[test]
fn many_segments_are_the_distributed_line() {
    for number in 0..20 {
        let own = transmission(number);
        let conduit = conduit(&own);
        // well below the first wave
        let s = Complex64::new(0.0, 0.8 / conduit.delay());
        let steady = Complex64::new(1.0, 0.0) + 8.0 * conduit.viscous_rate() / s;
        let [[_, impedance], _] = conduit.response(s, steady).transfer_matrix();
        let expected = impedance * s * (own.piston_area * own.piston_area);
        let error = |segments| {
            (at(&held_back(Transmission { segments, ..own }), s) / expected - 1.0).norm_sqr().sqrt()
        };
        let [two, four, eight] = [2, 4, 8].map(error);
        for ratio in [two / four, four / eight] {
            assert!((ratio / 4.0 - 1.0).abs() < 0.1, "{number}: {two} {four} {eight}");
        }
    }
}

/// A transmission without inertia and friction is a spring: in the linear plant at every frequency,
/// and in the machine at rest.
#[test]
fn without_inertia_it_is_a_spring() {
    for segments in [1, 4] {
        let own = Transmission {
            piston_area: 1e-3,
            line: pipe(2e-2, 1e-12),
            end_volume: 2e-5,
            filling_pressure: 40e5,
            segments,
        };
        let stiffness = 1e-6 * 1.45e9 / (4e-5 + std::f64::consts::FRAC_PI_4 * 4e-4 * 1e-12);
        let spring = SeriesElement::Spring(SeriesSpring {
            stiffness,
            damping: None,
            mass: None,
            travel: None,
            force_from: ForceFrom::Sensor,
        });
        for number in 0..10 {
            let one = drawn_with(SeriesElement::Transmission(own), number).plant;
            let other = drawn_with(spring, number).plant;
            for frequency in [1e-2, 3.0, 200.0, 1.3e3, 9e3] {
                let [one, other] = [&one, &other].map(|plant| {
                    let own = plant.coefficients();
                    let s = Complex64::new(0.0, frequency);
                    let ground = own.disturbance.unwrap().at_frequency(frequency);
                    [own.command.at_frequency(frequency), ground, PlantInMotion::lumped(plant).response(s)[0]]
                });
                for (one, other) in one.into_iter().zip(other) {
                    let error = (one / other - 1.0).norm_sqr().sqrt();
                    assert!(error < 1e-9, "rig {number} at {frequency}: {error}");
                }
            }
        }
        let [one, other] = [rig(own), Components { series: Some(spring), ..rig(own) }].map(|parts| {
            let actuator = Actuator::new(parts).unwrap();
            let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
            let point = operating_point(&actuator, 0.2, Condition::Command(0.4)).unwrap();
            let rest = machine.rest(&point).unwrap();
            machine.signals(&rest.state, &rest.inputs)
        });
        let is_shared = |signal: &&Signal| signal.part() != SignalPart::Transmission;
        for signal in Signal::ALL.iter().filter(is_shared) {
            let Some((one, other)) = one.get(*signal).zip(other.get(*signal)) else { continue };
            let size = if signal.name().contains("velocity") { 1.0 } else { one.abs() };
            assert!((one - other).abs() <= 1e-9 * size, "{signal:?}: {one} {other}");
        }
    }
}

/// Stiffness in slow motions, for any line: A^2 over its total compliance.
#[test]
fn slow_motions_meet_all_of_its_compliance() {
    for number in 0..40 {
        let own = Transmission { segments: 1 + number as usize % 8, ..transmission(number) };
        let series = LinearSeries::of_components(&rig(own), 0.0).unwrap();
        let compliance = conduit(&own).compliance() + 2.0 * own.end_volume / 1.45e9;
        let expected = own.piston_area * own.piston_area / compliance;
        assert!((series.stiffness() / expected - 1.0).abs() < 1e-12, "{number}");
        let LinearElement::Oil(column) = series.element else { panic!("{series:?}") };
        assert_eq!(column.pressure(0.0), own.filling_pressure);
    }
}

/// Steady motion: all oil moves at one velocity, and its resistance takes R_0 A^2 v from the force,
/// and R_0 A v from the pressure.
#[test]
fn steady_motion_costs_the_resistance_of_the_line() {
    for number in 0..12 {
        let own = transmission(number);
        let machine = machine_of(rig(own), &MachineOptions::default());
        let velocity = 0.03;
        let start = StartValues {
            position: 0.25,
            velocity,
            pressure_a: 35e5,
            pressure_b: 30e5,
            force: 700.0,
            ..StartValues::default()
        };
        let beginning = machine.start(&start).unwrap();
        let mut rates = vec![0.0; machine.states()];
        machine.rates(&beginning.state, 0.0, &beginning.inputs, &mut rates);
        let scales = machine.scales();
        for (index, (rate, scale)) in rates.iter().zip(&scales).enumerate().skip(6) {
            assert!((rate / scale).abs() < 1e-7, "{number}, state {index}: {rate}");
        }
        let outputs = machine.signals(&beginning.state, &beginning.inputs);
        let resistance = conduit(&own).steady_resistance();
        let lost = resistance * own.piston_area * own.piston_area * velocity;
        let found = outputs.force - outputs.load_force;
        assert!((found / lost - 1.0).abs() < 1e-9, "{number}: {found} {lost}");
        let [rod, load] = outputs.transmission_pressures;
        assert!((rod - own.filling_pressure - 700.0 / own.piston_area).abs() < 1e-6 * rod);
        assert!(((rod - load) / (resistance * own.piston_area * velocity) - 1.0).abs() < 1e-7);
    }
}

/// A pull lowers its pressure, and the oil column separates at vapour pressure: the indicator is
/// zero there. ORIGIN: analytic, F = -A (p_0 + 101,325 Pa).
#[test]
fn a_pull_beyond_its_filling_is_reported() {
    let own = Transmission { piston_area: 1e-3, ..transmission(4) };
    let own = Transmission { filling_pressure: 2e5, ..own };
    let machine = machine_of(rig(own), &MachineOptions::default());
    let place = INDICATORS.iter().position(|name| *name == "cavitation_transmission").unwrap();
    let indicated = |force: f64| {
        let start = StartValues {
            position: 0.25,
            pressure_a: 35e5,
            pressure_b: 35e5,
            force,
            ..StartValues::default()
        };
        let beginning = machine.start(&start).unwrap();
        let mut indicators = [0.0; INDICATORS.len()];
        machine.indicate(&beginning.state, &beginning.inputs, &mut indicators);
        indicators[place]
    };
    // oil that evaporates at 0 Pa absolute
    let tears = -1e-3 * (2e5 + 101_325.0);
    let vapour = components(hose_line(), StiffnessModel::ByVolume).fluid.vapour_pressure_absolute;
    assert!((indicated(0.0) - (2e5 + 101_325.0 - vapour)).abs() < 1e-6);
    assert!(indicated(0.999 * tears + 1e-3 * vapour) > 0.0 && indicated(1.001 * tears) < 0.0);
}

#[test]
fn ledgers_close() {
    let motion = Motion { amplitude: 1.5, bias: 0.4, ground: 0.0, ground_amplitude: 1e-3 };
    let start = StartValues {
        position: 0.25,
        pressure_a: 35e5,
        pressure_b: 30e5,
        force: 500.0,
        ..StartValues::default()
    };
    let sprung = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    for number in 0..6 {
        for load in [Load::Prescribed, sprung] {
            let parts = rig(transmission(number));
            let valve = Servovalve { transition_pressure: 1e5, ..parts.valve };
            let machine = machine_of(Components { valve, load, ..parts }, &MachineOptions::default());
            check(&machine, &motion, &start, 0.1, 5e-6);
        }
    }
    // the rig's lines are in segments
    let parts = rig(transmission(2));
    let model = LineModel::Segments { count: 3, friction: LaminarFriction::Steady, relaxation_time: None };
    let valve = Servovalve { transition_pressure: 1e5, ..parts.valve };
    let machine =
        machine_of(Components { valve, line_models: [model; 2], ..parts }, &MachineOptions::default());
    check(&machine, &motion, &start, 0.1, 5e-6);
}

/// Accounts at any state, including unreachable ones.
#[test]
fn what_is_stored_changes_by_what_enters_and_is_lost() {
    let mut seed = 7;
    for number in 0..40 {
        let own = Transmission { segments: 1 + number as usize % 8, ..transmission(number) };
        let machine = machine_of(rig(own), &MachineOptions::default());
        closes_at_any_state("a transmission", &machine, &mut seed);
    }
}

/// Transmission under any motion of its two ends: from rest, the energy that has entered is never
/// less than the energy returned.
#[test]
fn it_is_passive_under_random_motions_of_its_ports() {
    for number in 0..12 {
        let machine = machine_of(rig(transmission(number)), &MachineOptions::default());
        stays_passive(&machine, 83, number);
    }
}

/// Port of the load with its force fed back: F_L/X_L of the loop, by eliminating the command from
/// both paths.
#[test]
fn the_port_of_a_loop_includes_the_inertia_of_the_oil() {
    use phea_dynamics::linear::{Polynomial, TransferFunction};
    use phea_hydraulics::impedance::closed_loop_port;
    let of = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    let controller = TransferFunction::from_polynomials(&of(&[2e-4, 3e-3]), &of(&[1e-3, 1.0, 0.0])).unwrap();
    for number in (0..30).filter(|number| number % 5 < 2) {
        let plant = drawn(number).plant;
        let shown = closed_loop_port(&plant, &controller).unwrap();
        let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..plant.series.unwrap() };
        let port = LinearPlant { series: Some(on_load), ..plant };
        for frequency in [0.2, 5.0, 80.0, 900.0] {
            let s = Complex64::new(0.0, frequency);
            let of = |plant: &LinearPlant| {
                let own = plant.coefficients();
                [own.command.at_frequency(frequency), own.disturbance.unwrap().at_frequency(frequency)]
            };
            let ([by_command, by_load], [felt, moved]) = (of(&plant), of(&port));
            let loop_gain = controller.at_frequency(frequency);
            let force = moved - felt * loop_gain * by_load / (1.0 + loop_gain * by_command);
            let expected = -force / s;
            let error = (shown.at_frequency(frequency) / expected - 1.0).norm_sqr().sqrt();
            assert!(error < 1e-6, "{number} at {frequency}: {error}");
        }
    }
}

/// The only impedance at the load above all resonances is that of the oil at its own piston, and
/// the line states the frequency limit.
#[test]
fn the_load_meets_the_oil_at_its_piston_at_high_frequency() {
    for number in (0..40).filter(|number| number % 5 < 2) {
        let plant = drawn(number).plant;
        let LinearElement::Oil(column) = plant.series.unwrap().element else { panic!("{plant:?}") };
        let lines = through_oil(impedance_asymptotes(&nominal_plant(), None), &column);
        let last = lines.last().unwrap();
        assert!(
            last.kind == AsymptoteKind::OilLimit
                && lines.iter().all(|line| line.to <= last.from || line == last)
        );
        let shown = open_loop_impedance(&port(&plant).unwrap()).unwrap();
        let far = 30.0 * last.from.max(3e3);
        let error = (shown.at_frequency(far) / last.at_frequency(far) - 1.0).norm_sqr().sqrt();
        assert!(error < 3e-2, "{number}: {error}");
    }
}

/// Impossible transmissions are rejected with their path.
#[test]
fn impossible_transmissions_are_refused() {
    let own = Transmission {
        piston_area: 0.0,
        line: Line::Volume { volume: 1e-5, effective_bulk_modulus: 1e9 },
        end_volume: -1.0,
        filling_pressure: -2e5,
        segments: 9,
    };
    let refused = Actuator::new(rig(own)).unwrap_err().to_string();
    for named in [
        "series.piston_area",
        "series.line.volume",
        "series.end_volume",
        "series.filling_pressure",
        "series.segments",
    ] {
        assert!(refused.contains(named), "{named}: {refused}");
    }
    assert!(Actuator::new(rig(transmission(1))).is_ok());
}
