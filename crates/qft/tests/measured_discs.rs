//! Measured plants known within discs: verdicts hold for every response within them, and the turns
//! below the first point are those of the integrators visible despite noise.

#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{argument, exp, log10, magnitude, pow};
use phea_dynamics::random::{normal, stream, uniform};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, MeasuredFamily, MeasuredPlant};
use phea_qft::prefilter::tracking_extremes;
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::stability::{Instability, Irresolution, MemberStability, StabilityStatus, member_stability};
use phea_qft::template::{TemplateOptions, template};
use phea_qft::verification::{
    Audit, AuditProblem, Remark, SpecificationFinding, TOLERANCE_DB, TrackingJudgement, Verdict,
    audit_specifications,
};

/// A closed loop as a function of plant and gain.
type Closed = fn(Complex64, f64) -> Complex64;

fn unity() -> Compensation {
    around(1.0)
}

fn around(gain: f64) -> Compensation {
    let feedback = Compensator::new(vec![Element::Gain(gain)]);
    let controller = Controller { feedback, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn function(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

fn measured(frequencies: &[f64], response: impl Fn(f64) -> Complex64) -> MeasuredPlant {
    MeasuredPlant {
        name: "bench".into(),
        frequencies_rad_per_s: frequencies.to_vec(),
        command: frequencies.iter().map(|&w| response(w)).collect(),
        disturbance: None,
        radii: vec![],
        unstable_poles: 0,
        integrators: None,
        is_resolved: false,
    }
}

fn family(plant: MeasuredPlant) -> Family {
    Family::Measured(MeasuredFamily::new(vec![plant]).unwrap())
}

fn judged(family: &Family, loop_of: &Compensation, specifications: &[Specification]) -> Audit {
    let problem = AuditProblem {
        family,
        compensation: loop_of,
        specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    audit(&problem, &mut unwatched).unwrap()
}

fn specification(requirement: Requirement, band: [f64; 2]) -> Specification {
    Specification { requirement, frequencies_rad_per_s: vec![band[0]], band_rad_per_s: band }
}

/// Plant k (s/z + 1)^(m - 1 or 0)/(s^m (s/60 + 1)(s/80 + 1)) with random sign and gain.
fn drawn(state: &mut u64, integrators: usize) -> TransferFunction {
    let sign = if uniform(state) < 0.25 { -1.0 } else { 1.0 };
    let crossover = exp(3.5 * uniform(state));
    let (zero, size) = match integrators {
        0 => (None, 1.0 + crossover / 5.0),
        1 => (None, crossover),
        _ => (Some(crossover / (1.5 + 4.0 * uniform(state))), crossover),
    };
    let gain = zero.map_or(size, |zero: f64| size * zero);
    let numerator = zero.map_or(vec![sign * gain], |zero: f64| vec![sign * gain / zero, sign * gain]);
    let mut denominator = vec![1.0 / 4800.0, 140.0 / 4800.0, 1.0];
    denominator.extend(vec![0.0; integrators]);
    function(&numerator, &denominator)
}

/// Sixty measurements with noise of 3 % in every row: none gets a false verdict, of stability or of
/// a limit, and at least fifty get one. The truth is given by the poles and the closed form.
#[test]
fn noise_makes_no_verdict_false_and_leaves_few_undecided() {
    let frequencies = logarithmic_grid(0.1, 300.0, 200).unwrap();
    let (noise, rows) = (0.03, 200.0);
    // 1 - 0.05/n puts each row inside, with 95 % probability all of them
    let wide = noise * (rows / 0.05_f64).ln().sqrt();
    let (mut resolved, mut outcomes) = (0, [0; 3]);
    for draw in 0..60 {
        let mut state = stream(29, draw);
        let plant = drawn(&mut state, draw as usize % 3);
        let closed = plant.numerator().sum(&plant.denominator());
        let is_stable = closed.roots().unwrap().iter().all(|root| root.re < 0.0);
        let dense = logarithmic_grid(0.1, 300.0, 20_000).unwrap();
        let ratio = |w: &f64| {
            let open = plant.at_frequency(*w);
            magnitude(open / (1.0 + open))
        };
        let peak = dense.iter().map(ratio).fold(0.0, f64::max);
        let wanted_db = 24.0 * (uniform(&mut state) - 0.5);
        let limit = peak * pow(10.0, wanted_db / 20.0);
        let mut record = measured(&frequencies, |w| plant.at_frequency(w));
        record.radii = record.command.iter().map(|one| wide * magnitude(*one)).collect();
        for response in &mut record.command {
            let error = Complex64::new(normal(&mut state), normal(&mut state));
            *response *= 1.0 + error * noise / 2.0_f64.sqrt();
        }
        let requirement = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit));
        let found = judged(&family(record), &unity(), &[specification(requirement, [0.1, 300.0])]);
        match found.stability.verdict {
            Verdict::Met => assert!(is_stable, "draw {draw}: {found:?}"),
            Verdict::Violated => assert!(!is_stable, "draw {draw}: {found:?}"),
            Verdict::NotProven => {}
        }
        match found.verdict {
            Verdict::Met => {
                assert!(is_stable && wanted_db > -TOLERANCE_DB, "draw {draw}: {wanted_db} {found:?}")
            }
            Verdict::Violated => assert!(!is_stable || wanted_db < 0.0, "draw {draw}: {wanted_db} {found:?}"),
            Verdict::NotProven => {}
        }
        resolved += usize::from(found.verdict != Verdict::NotProven);
        outcomes[found.verdict as usize] += 1;
    }
    let [met, _, violated] = outcomes;
    assert!(resolved >= 50 && met >= 10 && violated >= 10, "{outcomes:?}");
}

/// Closed loops over a disc: the worst and the certain margin correspond to the greatest and the
/// least magnitude of plants sampled within it.
#[test]
fn a_disc_has_the_verdict_of_its_plants() {
    // ORIGIN: analytic, images and supports of a circle, sampled
    let frequencies = [0.5, 1.0, 2.0];
    for (centre, radius, gain) in [
        (Complex64::new(0.3, -1.1), 0.2, 1.0),
        (Complex64::new(-0.4, -0.2), 0.35, 1.3),
        (Complex64::new(2.0, 0.5), 1.9, 0.7),
        (Complex64::new(-3.0, 0.4), 0.5, 2.0),
    ] {
        let mut plant = measured(&frequencies, |_| centre);
        plant.radii = vec![radius; 3];
        let plants: Vec<Complex64> = (0..20_000)
            .map(|one| {
                let angle = std::f64::consts::TAU * f64::from(one) / 20_000.0;
                centre + radius * Complex64::new(angle.cos(), angle.sin())
            })
            .collect();
        let kinds: [(ClosedLoop, Closed); 4] = [
            (ClosedLoop::RobustStability, |p, g| p * g / (1.0 + p * g)),
            (ClosedLoop::Sensitivity, |p, g| 1.0 / (1.0 + p * g)),
            (ClosedLoop::PlantInputDisturbance, |p, g| p / (1.0 + p * g)),
            (ClosedLoop::ControlEffort, |p, g| g / (1.0 + p * g)),
        ];
        for (kind, closed) in kinds {
            let sizes: Vec<f64> = plants.iter().map(|&plant| magnitude(closed(plant, gain))).collect();
            let most = sizes.iter().copied().fold(0.0, f64::max);
            let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
            let family = family(plant.clone());
            let with = |limit: f64| {
                let requirement = Requirement::at_most(kind, Limit::Constant(limit));
                finding(&family, &around(gain), specification(requirement, [0.5, 2.0]))
            };
            let met = with(most * 1.0001);
            assert_eq!(met.verdict, Verdict::Met, "{kind:?} {met:?}");
            let margin_db = met.worst.as_ref().unwrap().margin_db;
            assert!((margin_db - 20.0 * log10(1.0001)).abs() < 1e-5, "{kind:?} {margin_db}");
            let open = with(most * 0.999);
            assert_eq!(open.verdict, Verdict::NotProven, "{kind:?} {open:?}");
            assert!(open.remarks.iter().any(|one| matches!(one, Remark::OpenWithinDiscs { .. })));
            if least > 0.0 {
                assert_eq!(with(least * 1.001).verdict, Verdict::NotProven);
                assert_eq!(with(least * 0.999).verdict, Verdict::Violated, "{kind:?}");
            }
        }
        let extremes = tracking_extremes(&around(gain), &[around(gain).measured(&plant)], &[1.0]).unwrap()[0];
        let sizes = plants.iter().map(|&plant| magnitude(plant * gain / (1.0 + plant * gain)));
        let [least, most] =
            sizes.fold([f64::INFINITY, 0.0], |[a, b]: [f64; 2], one| [a.min(one), b.max(one)]);
        assert!((extremes.greatest / most - 1.0).abs() < 1e-6 && (extremes.least / least - 1.0).abs() < 1e-4);
    }
}

fn finding(family: &Family, compensation: &Compensation, one: Specification) -> SpecificationFinding {
    let problem = AuditProblem {
        family,
        compensation,
        specifications: &[one],
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    audit_specifications(&problem, &mut unwatched).unwrap().0.remove(0)
}

/// The template of a disc is a polygon around it, and its bound forbids every loop that any plant
/// of the disc forbids.
#[test]
fn the_template_of_a_disc_encloses_it() {
    // ORIGIN: analytic, images and supports of a circle, sampled
    let (centre, radius) = (Complex64::new(0.8, -0.9), 0.25);
    let mut plant = measured(&[0.5, 1.0, 2.0], |_| centre);
    plant.radii = vec![radius; 3];
    let built = template(&family(plant), &unity(), 1.0, &TemplateOptions::default()).unwrap().template;
    assert_eq!(built.nominal, centre);
    let [outline] = &built.outlines[..] else { panic!("{:?}", built.outlines) };
    for one in 0..360 {
        let angle = f64::from(one).to_radians();
        let direction = Complex64::new(angle.cos(), angle.sin());
        // the support of the polygon in every direction is that of the disc, or slightly more
        let along = |point: &Complex64| ((point - centre) * direction.conj()).re;
        let reach = outline.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
        assert!(reach >= radius * (1.0 - 1e-12) && reach < 1.021 * radius, "{one} {reach}");
    }
}

fn found(plant: &MeasuredPlant) -> MemberStability {
    member_stability(&unity().measured(plant), &unity())
}

/// A row with an error of up to a tenth changes neither integrators nor sign: a double integrator
/// with positive feedback still has one unstable pole, with negative feedback none, for any such
/// row; likewise with one integrator and with none.
#[test]
fn one_row_is_no_evidence_of_an_integrator() {
    let frequencies = logarithmic_grid(0.1, 300.0, 200).unwrap();
    let lead =
        |sign: f64| function(&[4.0 * sign, 20.0 * sign], &[1.0 / 4800.0, 140.0 / 4800.0, 1.0, 0.0, 0.0]);
    let cases = [
        (lead(1.0), 0),
        (lead(-1.0), 1),
        (function(&[5.0], &[0.01, 1.0, 0.0]), 0),
        (function(&[-5.0], &[0.01, 1.0, 0.0]), 1),
        (function(&[30.0], &[0.2, 1.0]), 0),
        (function(&[-30.0], &[0.2, 1.0]), 1),
    ];
    for (plant, unstable) in cases {
        for row in [0, 1, 2, 5] {
            for decibel in [-0.8, -0.7, 0.7, 0.8] {
                let mut record = measured(&frequencies, |w| plant.at_frequency(w));
                record.command[row] *= pow(10.0, decibel / 20.0);
                let expected = match unstable {
                    0 => StabilityStatus::Stable,
                    count => StabilityStatus::Unstable(Instability::Poles { count }),
                };
                assert_eq!(found(&record).status, expected, "{plant:?} {row} {decibel}");
            }
        }
    }
}

/// Too few rows to show the slope allow no conclusion; a statement decides, and one that the slope
/// contradicts is rejected.
#[test]
fn integrators_are_shown_or_stated() {
    let double = function(&[4.0, 20.0], &[1.0 / 4800.0, 140.0 / 4800.0, 1.0, 0.0, 0.0]);
    let frequencies = logarithmic_grid(0.1, 300.0, 30).unwrap();
    let mut sparse = measured(&frequencies, |w| double.at_frequency(w));
    for (row, response) in sparse.command.iter_mut().enumerate() {
        *response *= if row % 2 == 0 { 1.1 } else { 0.9 };
    }
    let StabilityStatus::NotResolved(Irresolution::LowEnd { slope: Some([low, high]), .. }) =
        found(&sparse).status
    else {
        panic!("{:?}", found(&sparse));
    };
    assert!(low < -2.0 && -2.0 < high, "{low} {high}");
    sparse.integrators = Some(2);
    assert_eq!(found(&sparse).status, StabilityStatus::Stable);
    // the phase distinguishes even from odd numbers
    sparse.integrators = Some(1);
    assert!(matches!(found(&sparse).status, StabilityStatus::NotResolved(Irresolution::LowEnd { .. })));
    let dense = logarithmic_grid(0.1, 300.0, 200).unwrap();
    let mut record = measured(&dense, |w| double.at_frequency(w));
    for stated in [0, 4] {
        record.integrators = Some(stated);
        let status = found(&record).status;
        let contradicted = matches!(status, StabilityStatus::NotResolved(Irresolution::Integrators { .. }));
        assert!(contradicted, "{stated} {status:?}");
    }
}

/// A disc that contains -1 leaves stability open; otherwise the results are the least distance and
/// the least delay of its plants.
#[test]
fn stability_is_that_of_every_plant_of_the_discs() {
    // ORIGIN: analytic, images and supports of a circle, sampled
    let frequencies = logarithmic_grid(0.01, 100.0, 400).unwrap();
    let (gain, radius) = (2.0, 0.1);
    let mut record = measured(&frequencies, |w| gain / Complex64::new(0.0, w));
    record.radii = record.command.iter().map(|one| radius * magnitude(*one)).collect();
    let stable = found(&record);
    assert_eq!(stable.status, StabilityStatus::Stable);
    let plants = |w: f64| {
        (0..720).map(move |one| {
            let angle = f64::from(one).to_radians() / 2.0;
            gain / Complex64::new(0.0, w) * (1.0 + radius * Complex64::new(angle.cos(), angle.sin()))
        })
    };
    let all = || frequencies.iter().flat_map(|&w| plants(w));
    let distance = all().map(|open| magnitude(1.0 + open)).fold(f64::INFINITY, f64::min);
    let nearest = stable.closest_approach.unwrap().distance;
    assert!(nearest <= distance && nearest > distance - 1e-4, "{nearest} {distance}");
    // frequencies w where |L| = 1 is possible, and the least angle to -1 there, by sampling the
    // disc
    let delay = frequencies
        .iter()
        .filter_map(|&w| {
            let angles = (0..40_000).filter_map(|one| {
                let angle = std::f64::consts::TAU * f64::from(one) / 40_000.0;
                let on_circle = Complex64::new(angle.cos(), angle.sin());
                let inside = magnitude(on_circle - gain / Complex64::new(0.0, w)) <= radius * gain / w;
                let lag = argument(-on_circle).rem_euclid(std::f64::consts::TAU);
                inside.then_some(lag)
            });
            angles.reduce(f64::min).map(|lag| lag / w)
        })
        .fold(f64::INFINITY, f64::min);
    let margin = stable.critical_delay.unwrap().delay_s;
    assert!((margin / delay - 1.0).abs() < 2e-3 && margin < delay * 1.0001, "{margin} {delay}");

    let critical = function(&[6.0], &[1.0, 3.0, 3.0, 1.0]);
    let mut record = measured(&logarithmic_grid(0.01, 100.0, 400).unwrap(), |w| critical.at_frequency(w));
    assert_eq!(found(&record).status, StabilityStatus::Stable);
    record.radii = record.command.iter().map(|one| 0.4 * magnitude(*one)).collect();
    let status = found(&record).status;
    assert!(matches!(status, StabilityStatus::NotResolved(Irresolution::Confidence { .. })), "{status:?}");
}
