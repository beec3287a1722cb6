//! Stiffness over the stroke: the thesis' numbers, closed forms, and the inverse problems.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::EntrainedAir;
use phea_hydraulics::line::{Hose, Line, StiffeningMember};
use phea_hydraulics::reference_rig::{USEFUL_AREA, components, cylinder, hose, hose_line, pipe_line};
use phea_hydraulics::stiffness::{
    LineLength, StiffnessModel, StrokeStiffness, chamber_compliance, hose_length_by_volume,
    hose_length_uniform, hydraulic_stiffness, line_fraction_for_stiffness, model_difference,
    stiffness_from_hose_length,
};
use phea_hydraulics::stroke::ActuatorStroke;

const FLUID_MODULUS: f64 = 1.45e9;

/// `value` is the printed number, to half the unit of its last digit
fn check(what: &str, value: f64, printed: f64, last_digit: f64) {
    assert!((value - printed).abs() <= 0.5 * last_digit, "{what}: {value} is not {printed}");
}

fn over_stroke(model: StiffnessModel, line: &Line, member: StiffeningMember) -> StrokeStiffness {
    chamber_compliance(model, [FLUID_MODULUS; 2], &cylinder(), [line, line], member).over_stroke()
}

#[test]
fn modulus_chain_of_the_thesis() {
    // ORIGIN: thesis 6.4.1 and Table A.1, recomputed by comparisons/recompute_rig.py
    check("A_u", USEFUL_AREA, 1.58336e-3, 1e-8);
    check("beta_hoSS", hose().static_modulus(), 6.363e7, 1e4);
    check("beta_e", hose_line().effective_modulus(FLUID_MODULUS, StiffeningMember::Nominal), 2.609e8, 1e5);
}

#[test]
fn stiffness_of_hose_and_pipe_in_both_models() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py; thesis 6.4.1 prints 2.24e6, and Table 6.3
    // 4.11e6
    let uniform = over_stroke(StiffnessModel::Uniform, &hose_line(), StiffeningMember::Nominal);
    check("uniform centre", uniform.minimum, 2.233e6, 1e3);
    check("uniform ends", uniform.maximum, 4.109e6, 1e3);
    check("uniform centre, thesis", uniform.minimum, 2.24e6, 2.0 * 1e4);
    check("uniform ends, thesis", uniform.maximum, 4.11e6, 2.0 * 1e4);
    let by_volume = over_stroke(StiffnessModel::ByVolume, &hose_line(), StiffeningMember::Nominal);
    check("by volume centre", by_volume.minimum, 4_630_311.5, 0.1);
    check("by volume ends", by_volume.maximum, 4_944_558.5, 0.1);
    let pipe = over_stroke(StiffnessModel::Uniform, &pipe_line(), StiffeningMember::Nominal);
    check("pipe centre", pipe.minimum, 1.71e7, 1e5);
    check("pipe ends", pipe.maximum, 1.24e8, 1e6);
    assert!((uniform.minimum_position - 0.25).abs() < 1e-15);
}

#[test]
fn stiffening_interval_brackets_the_nominal() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py, r_beta 4 and 5
    let least = |model, member| over_stroke(model, &hose_line(), member).minimum;
    check("r_beta 4", least(StiffnessModel::Uniform, StiffeningMember::Minimum), 1.85e6, 1e4);
    check("r_beta 5", least(StiffnessModel::Uniform, StiffeningMember::Maximum), 2.23e6, 1e4);
    let members = [StiffeningMember::Minimum, StiffeningMember::Nominal, StiffeningMember::Maximum];
    let [softest, nominal, stiffest] = members.map(|member| least(StiffnessModel::ByVolume, member));
    assert!(softest < nominal && nominal <= stiffest);
}

/// ORIGIN: analytic, thesis (6.18) and (6.19) as printed.
#[test]
fn extremes_are_the_closed_forms_of_the_symmetric_cylinder() {
    let line = hose_line();
    let (modulus, volume) = (line.effective_modulus(FLUID_MODULUS, StiffeningMember::Nominal), line.volume());
    let (a, l) = (USEFUL_AREA, 0.5);
    let range = over_stroke(StiffnessModel::Uniform, &line, StiffeningMember::Nominal);
    let minimum = 4.0 * modulus * a * a / (a * l + 2.0 * volume);
    let maximum = modulus * a * a * (a * l + 2.0 * volume) / (volume * (a * l + volume));
    assert!((range.minimum / minimum - 1.0).abs() < 1e-14);
    assert!((range.maximum / maximum - 1.0).abs() < 1e-14);
}

#[test]
fn models_agree_when_the_line_is_as_stiff_as_the_fluid() {
    let difference = model_difference(
        [FLUID_MODULUS; 2],
        &cylinder(),
        [&pipe_line(), &pipe_line()],
        [None; 2],
        StiffeningMember::Nominal,
    );
    assert!((difference.minimum_ratio - 1.0).abs() < 1e-14);
    assert!((difference.maximum_ratio - 1.0).abs() < 1e-14);
    let hose = model_difference(
        [FLUID_MODULUS; 2],
        &cylinder(),
        [&hose_line(), &hose_line()],
        [None; 2],
        StiffeningMember::Nominal,
    );
    assert!(hose.minimum_ratio > 2.0 && hose.maximum_ratio > 1.2 && hose.line_compliance_fraction > 0.7);
}

fn asymmetric() -> Cylinder {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    Cylinder { area_a, area_b, ..cylinder() }
}

#[test]
fn softest_position_of_an_asymmetric_cylinder_is_found_exactly() {
    let line = pipe_line();
    let chambers = chamber_compliance(
        StiffnessModel::ByVolume,
        [FLUID_MODULUS; 2],
        &asymmetric(),
        [&line, &line],
        StiffeningMember::Nominal,
    );
    let range = chambers.over_stroke();
    // ORIGIN: recomputed by comparisons/recompute_rig.py (bounded minimisation)
    check("least stiffness", range.minimum, 1.9185810e7, 1.0);
    check("its position", range.minimum_position, 0.2662174, 2e-7);
    check("greatest stiffness, A end", range.maximum, 1.8887781e8, 10.0);
    for step in 0..=1000 {
        let stiffness = hydraulic_stiffness(&chambers, 0.5 * f64::from(step) / 1000.0);
        assert!((range.minimum..=range.maximum).contains(&stiffness));
    }
}

#[test]
fn softest_position_leaves_the_stroke_when_one_line_is_long() {
    let long = Line::Volume { volume: 0.1, effective_bulk_modulus: 1.45e9 };
    let short = Line::Volume { volume: 1e-5, effective_bulk_modulus: 1.45e9 };
    let at = |lines| {
        chamber_compliance(
            StiffnessModel::ByVolume,
            [FLUID_MODULUS; 2],
            &cylinder(),
            lines,
            StiffeningMember::Nominal,
        )
        .over_stroke()
    };
    // the stiffness with chamber B as the only spring is least when that chamber is largest: at the
    // A end
    assert_eq!((at([&long, &short]).minimum_position, at([&long, &short]).maximum_position), (0.0, 0.5));
    assert_eq!((at([&short, &long]).minimum_position, at([&short, &long]).maximum_position), (0.5, 0.0));
}

#[test]
fn lengths_undo_stiffnesses_in_both_models() {
    let effective = hose_line().effective_modulus(FLUID_MODULUS, StiffeningMember::Nominal);
    let metre = hose().compliance_per_length(FLUID_MODULUS, StiffeningMember::Nominal);
    let (bore, stroke) = (12.7e-3, 0.5);
    for length in [0.3, 1.5, 12.0] {
        let line = Line::Hose { hose: hose(), length };
        for model in [StiffnessModel::Uniform, StiffnessModel::ByVolume] {
            let stiffness = over_stroke(model, &line, StiffeningMember::Nominal).minimum;
            let closed = match model {
                StiffnessModel::Uniform => {
                    hose_length_uniform(stiffness, USEFUL_AREA, stroke, bore, effective)
                }
                StiffnessModel::ByVolume => {
                    hose_length_by_volume(stiffness, USEFUL_AREA, stroke, metre, FLUID_MODULUS)
                }
            };
            assert!((closed / length - 1.0).abs() < 1e-12);
            let solved = line_fraction_for_stiffness(
                model,
                FLUID_MODULUS,
                &cylinder(),
                [&Line::Hose { hose: hose(), length: 1.0 }; 2],
                StiffeningMember::Nominal,
                stiffness,
            );
            let LineLength::Length(solved) = solved else { panic!("{solved:?}") };
            assert!((solved / length - 1.0).abs() < 1e-12);
        }
        // ORIGIN: analytic, (6.26) is the inverse of (6.25)
        let stiffness = stiffness_from_hose_length(length, USEFUL_AREA, stroke, bore, effective);
        let back = hose_length_uniform(stiffness, USEFUL_AREA, stroke, bore, effective);
        assert!((back / length - 1.0).abs() < 1e-12);
    }
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    let length = hose_length_by_volume(2.24e6, USEFUL_AREA, stroke, metre, FLUID_MODULUS);
    check("by volume, 2.24e6 N/m", length, 3.64, 0.01);
}

/// Unequal hoses of one compliance at unequal areas.
///
/// ORIGIN: analytic, the least of A_A^2/C_A + A_B^2/C_B over the stroke
#[test]
fn unequal_lines_divide_the_compliance() {
    let narrow = Hose { bore: 9.5e-3, expansion_slope: 1.1e-12, operating_expansion: 5e-6, ..hose() };
    let (cylinder, member) = (asymmetric(), StiffeningMember::Nominal);
    let mut within = 0;
    for model in [StiffnessModel::Uniform, StiffnessModel::ByVolume] {
        let of = |hose| {
            let line = Line::Hose { hose, length: 1.0 };
            match model {
                StiffnessModel::Uniform => (
                    line.compliance_of_unexpanded(FLUID_MODULUS, member),
                    line.effective_modulus(FLUID_MODULUS, member),
                ),
                StiffnessModel::ByVolume => (line.compliance(FLUID_MODULUS, member), FLUID_MODULUS),
            }
        };
        let [(metre_a, modulus_a), (metre_b, modulus_b)] = [of(hose()), of(narrow)];
        let (area_a, area_b) = (cylinder.area_a, cylinder.area_b);
        let [slope_a, slope_b] = [area_a / modulus_a, area_b / modulus_b];
        let q = area_a / slope_a.sqrt() + area_b / slope_b.sqrt();
        let ActuatorStroke::Limited(stroke) = cylinder.stroke else { panic!() };
        let dead = (cylinder.dead_volume_a / area_a, cylinder.dead_volume_b / area_b);
        for stiffness in [0.5e6, 1.5e6, 2.5e6, 4e6, 6e6, 9e6] {
            let common = (q * q / stiffness - stroke - dead.0 - dead.1) / (1.0 / slope_a + 1.0 / slope_b);
            // softest within the stroke
            let from_a = (q / stiffness * area_a * slope_a.sqrt() - common) / slope_a - dead.0;
            if common <= 0.0 || !(0.0..=stroke).contains(&from_a) {
                continue;
            }
            within += 1;
            let lines = [
                Line::Hose { hose: hose(), length: 1.0 },
                Line::Hose { hose: narrow, length: metre_a / metre_b },
            ];
            let [line_a, line_b] = &lines;
            let found = line_fraction_for_stiffness(
                model,
                FLUID_MODULUS,
                &cylinder,
                [line_a, line_b],
                member,
                stiffness,
            );
            let LineLength::Length(fraction) = found else { panic!("{found:?}") };
            assert!((fraction * metre_a / common - 1.0).abs() < 1e-11, "{model:?} {stiffness}: {fraction}");
        }
    }
    assert!(within > 2, "{within}");
}

/// ORIGIN: analytic, thesis (6.25) and (6.26) exactly as printed, with E, epsilon and r_beta.
#[test]
fn printed_forms_of_the_sizing_equations() {
    let pi = std::f64::consts::PI;
    let (a, l, d, e, eps, r) = (USEFUL_AREA, 0.5, 12.7e-3, 1.56e-5, 2.236e-12, 5.0);
    let bracket = pi * d * d + 4.0 * e;
    let stiffness = 2.24e6;
    let printed = 8.0 * a * a * r * FLUID_MODULUS * bracket
        / (pi * d * d * stiffness * (4.0 * eps * FLUID_MODULUS + r * bracket))
        - 2.0 * a * l / (pi * d * d);
    let effective = hose_line().effective_modulus(FLUID_MODULUS, StiffeningMember::Nominal);
    assert!((hose_length_uniform(stiffness, a, l, d, effective) / printed - 1.0).abs() < 1e-13);
    let printed = 8.0 * r * FLUID_MODULUS * a * a * bracket
        / ((4.0 * eps * FLUID_MODULUS + r * bracket) * (2.0 * a * l + pi * d * d * 1.5));
    assert!((stiffness_from_hose_length(1.5, a, l, d, effective) / printed - 1.0).abs() < 1e-14);
}

#[test]
fn no_hose_is_needed_when_the_chambers_are_soft_enough() {
    let solve = |stiffness| {
        let (cylinder, line) = (asymmetric(), hose_line());
        let model = StiffnessModel::ByVolume;
        line_fraction_for_stiffness(
            model,
            FLUID_MODULUS,
            &cylinder,
            [&line; 2],
            StiffeningMember::Nominal,
            stiffness,
        )
    };
    // ORIGIN: analytic, the required stiffness far above 4 beta_0 A/L
    assert!(matches!(solve(1e9), LineLength::NotNeeded { .. }));
    assert_eq!(solve(0.0), LineLength::OutOfReach);
    assert_eq!(solve(f64::NAN), LineLength::OutOfReach);
    let (LineLength::Length(soft), LineLength::Length(stiff)) = (solve(1e6), solve(4e6)) else { panic!() };
    assert!(soft > stiff);
}

#[test]
fn entrained_air_softens_the_chamber_at_lower_pressure() {
    let clean = components(hose_line(), StiffnessModel::ByVolume);
    let air = Some(EntrainedAir { volume_fraction: 0.01, polytropic_exponent: 1.4 });
    let foamy =
        Components { fluid: phea_hydraulics::fluid::Fluid { entrained_air: air, ..clean.fluid }, ..clean };
    let least = |components: Components, pressure: f64| {
        let actuator = Actuator::new(components).unwrap();
        actuator.chamber_compliance([pressure; 2], StiffeningMember::Nominal).over_stroke().minimum
    };
    assert_eq!(least(clean, 10e5), least(clean, 35e5));
    assert!(least(foamy, 10e5) < least(foamy, 35e5) && least(foamy, 35e5) < least(clean, 35e5));
}
