use num_complex::Complex64;
use phea_dynamics::portable::{argument, atan, ln, magnitude};
use phea_dynamics::watch::Watch;
use phea_qft::family::Spacing::{Linear, Logarithmic};
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::template::{Resolution, Template, TemplateError, TemplateOptions, Templates};

use super::support::{
    apart, beyond, built, coefficients, family, from_rim, logarithmic_area, plain_loop, polar, winding,
};

fn motor() -> UncertainFamily {
    family(&[("k", 1.0, 10.0, Logarithmic), ("a", 1.0, 10.0, Logarithmic)], 3, |p| {
        coefficients(vec![p[0] * p[1]], vec![1.0.into(), p[1], 0.0.into()])
    })
}

/// Neighbours on every outline are within the tolerance, and as close as the resolution states.
fn assert_resolved(template: &Template) {
    let options = TemplateOptions::default();
    let Resolution::Resolved { phase_deg, magnitude_db } = template.resolution else {
        panic!("{:?}", template.resolution)
    };
    assert!(phase_deg <= options.phase_deg && magnitude_db <= options.magnitude_db + 1e-6);
    let widest =
        TemplateOptions { phase_deg: phase_deg + 1e-6, magnitude_db: magnitude_db + 1e-6, ..options };
    for outline in &template.outlines {
        for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            assert!(apart(*from, *to, &widest) <= 2_f64.sqrt());
        }
    }
}

/// Plant k a/(s(s+a)): a follows from the phase, -90 deg - atan(w/a), then k from the magnitude;
/// one of the two is at an end along the whole outline, and the area between the four arcs is ln(k
/// ratio) times the range of phase.
#[test]
fn a_motor_is_bounded_by_four_arcs() {
    for frequency in [0.1, 1.0, 10.0, 100.0] {
        let template = built(&motor(), frequency).template;
        assert_resolved(&template);
        assert_eq!(template.outlines.len(), 1);
        for point in template.points.iter().filter(|point| point.member.is_none()) {
            let a = frequency * point.response.im / point.response.re;
            assert!((a / point.values[1] - 1.0).abs() < 1e-9);
            let at_an_end = |value: f64| (value - 1.0).abs() < 1e-9 || (value - 10.0).abs() < 1e-9;
            assert!(at_an_end(point.values[0]) || at_an_end(point.values[1]));
        }
        let area = ln(10.0) * (atan(frequency) - atan(frequency / 10.0));
        let found = logarithmic_area(&template.outlines[0]);
        assert!((found / area - 1.0).abs() < 2e-3, "{frequency}: {found} for {area}");
    }
}

#[test]
fn members_come_first_and_the_nominal_plant_before_them() {
    let family = motor();
    let built = built(&family, 2.0);
    let members = family.members();
    assert_eq!(built.template.points[0].response, built.template.nominal);
    for (index, values) in members.iter().enumerate() {
        let point = &built.template.points[index];
        assert_eq!((point.member, &point.values), (Some(index), values));
        assert_eq!(point.response, family.plant().response(values, 2.0).unwrap());
    }
    assert!(built.template.points.iter().skip(members.len()).all(|point| point.member.is_none()));
    // members, edges, one centre; then slopes along the outline and probes
    assert!(built.evaluations < 1_000, "{}", built.evaluations);
}

#[test]
fn a_gain_is_a_segment() {
    let family = family(&[("k", 1.0, 100.0, Logarithmic)], 2, |p| {
        coefficients(vec![p[0]], vec![1.0.into(), 0.0.into()])
    });
    let template = built(&family, 0.5).template;
    assert_resolved(&template);
    let [outline] = &template.outlines[..] else { panic!("one segment") };
    assert!(outline.iter().all(|response| response.re.abs() < 1e-9));
    let highest = outline.iter().map(|response| -response.im).fold(0.0, f64::max);
    let lowest = outline.iter().map(|response| -response.im).fold(f64::INFINITY, f64::min);
    assert!((highest - 200.0).abs() < 1e-9 && (lowest - 2.0).abs() < 1e-9);
    assert!(logarithmic_area(outline) < 1e-12);
}

#[test]
fn two_gains_in_series_are_a_segment_too() {
    let family = family(&[("k", 1.0, 2.0, Linear), ("m", 1.0, 3.0, Linear)], 2, |p| {
        coefficients(vec![p[0] * p[1]], vec![1.0.into(), 1.0.into()])
    });
    let template = built(&family, 1.0).template;
    assert_resolved(&template);
    let options = TemplateOptions::default();
    for gain in [1.0, 2.5, 6.0] {
        let response = gain / Complex64::new(1.0, 1.0);
        assert!(from_rim(&template.outlines, response, &options) < 1e-3);
    }
}

/// A lag too short to matter bends k/s by 3e-8 degrees at most: the polygons of its faces are as
/// thin as rounding errors, and the template is the segment of k.
// ORIGIN: analytic, 1/(w (T w + 1)) next to k/w
#[test]
fn a_parameter_that_hardly_moves_the_plant_leaves_a_segment() {
    let family = family(&[("k", 1.0, 100.0, Logarithmic), ("T", 0.0, 1e-9, Linear)], 3, |p| {
        coefficients(vec![p[0]], vec![p[1], 1.0.into(), 0.0.into()])
    });
    let template = built(&family, 0.5).template;
    assert_resolved(&template);
    let outlines = || template.outlines.iter().flatten();
    assert!(outlines().all(|response| response.re.abs() < 1e-9 * magnitude(*response)));
    let highest = outlines().map(|response| -response.im).fold(0.0, f64::max);
    let lowest = outlines().map(|response| -response.im).fold(f64::INFINITY, f64::min);
    assert!((highest - 200.0).abs() < 1e-6 && (lowest - 2.0).abs() < 1e-6, "{lowest} to {highest}");
}

/// The watch is consulted at each plant; if it returns false there is no template.
#[test]
fn a_template_calls_its_progress_callback_at_each_plant() {
    let (family, options) = (Family::Uncertain(motor()), TemplateOptions::default());
    let around = plain_loop();
    let at = |watch: Watch<'_>| {
        Templates::new(&family, &around, &[1.0], options).next_watched(watch).expect("one frequency")
    };
    let mut calls = 0;
    let whole = at(&mut |_| {
        calls += 1;
        true
    });
    assert_eq!(whole.map(|built| built.evaluations), Ok(calls));
    for last in [1, calls / 2, calls] {
        let mut left = last;
        let stopped = at(&mut |_| {
            left -= 1;
            left > 0
        });
        assert!(matches!(stopped, Err(TemplateError::Stopped(_))) && left == 0, "{last}: {left}");
    }
}

/// Image -(x^2 + y^2) - 1 with x, y from -1 to 1: the edges of the box extend from -3 to -2, and
/// its middle is -1.
#[test]
fn a_line_reaches_beyond_the_edges_of_the_box() {
    let family = family(&[("x", -1.0, 1.0, Linear), ("y", -1.0, 1.0, Linear)], 2, |p| {
        coefficients(vec![-(p[0] * p[0] + p[1] * p[1] + 1.0.into())], vec![1.0.into()])
    });
    let template = built(&family, 1.0).template;
    assert_resolved(&template);
    let highest = template.outlines.iter().flatten().map(|response| response.re).fold(-9.0, f64::max);
    let lowest = template.outlines.iter().flatten().map(|response| response.re).fold(0.0, f64::min);
    assert!((lowest + 3.0).abs() < 1e-12 && (-1.06..=-1.0).contains(&highest), "{lowest} to {highest}");
    assert!(template.outlines.iter().flatten().all(|response| response.im.abs() < 1e-12));
}

#[test]
fn a_dead_time_is_an_arc() {
    let family = family(&[("T", 0.1, 0.5, Linear)], 2, |p| {
        let mut plant = coefficients(vec![3.0.into()], vec![1.0.into()]);
        plant.dead_time_s = p[0];
        plant
    });
    let template = built(&family, 4.0).template;
    assert_resolved(&template);
    let [outline] = &template.outlines[..] else { panic!("one arc") };
    for response in outline {
        assert!((magnitude(*response) - 3.0).abs() < 1e-12);
        assert!((-2.0 - 1e-12..=-0.4 + 1e-12).contains(&argument(*response)));
    }
    // 1.6 rad forwards and as many backwards in steps of at most 2 degrees
    assert!(outline.len() as f64 >= 2.0 * 1.6_f64.to_degrees() / 2.0);
}

fn gain_and_dead_time() -> UncertainFamily {
    family(&[("k", 1.0, 2.0, Logarithmic), ("T", 0.1, 1.0, Linear)], 3, |p| {
        let mut plant = coefficients(vec![p[0]], vec![1.0.into()]);
        plant.dead_time_s = p[1];
        plant
    })
}

/// Plant k e^(-sT) over 4.5 rad of phase: a curved strip around the origin, of area ln 2 times 4.5
/// in the logarithmic plane.
#[test]
fn a_bent_strip_has_its_hollow() {
    let template = built(&gain_and_dead_time(), 5.0).template;
    assert_resolved(&template);
    let [outline] = &template.outlines[..] else { panic!("one strip") };
    assert!((logarithmic_area(outline) / (ln(2.0) * 4.5) - 1.0).abs() < 1e-3);
    assert_eq!(winding(outline, Complex64::new(0.0, 0.0)), 0);
    assert_eq!(winding(outline, polar(0.9, -2.5)), 0);
    assert_eq!(winding(outline, polar(1.5, 0.2)), 0);
    for phase in [-0.6, -2.5, -4.9] {
        assert_eq!(winding(outline, polar(1.5, phase)).abs(), 1);
    }
}

/// A strip over 18 rad of phase closes to a ring: its interior stays empty, and no part is covered
/// twice.
#[test]
fn more_than_a_turn_is_a_ring() {
    let template = built(&gain_and_dead_time(), 20.0).template;
    assert_resolved(&template);
    let covered = |response: Complex64| -> i32 {
        template.outlines.iter().map(|outline| winding(outline, response).abs()).sum()
    };
    for step in 0..36 {
        let phase = f64::from(step) * 0.1745;
        assert_eq!(covered(polar(1.4, phase)), 1);
        assert_eq!(covered(polar(0.98, phase)), 0);
        assert_eq!(covered(polar(2.02, phase)), 0);
    }
}

/// Plant k/((s+a)(s+b)): the forty plants on four edges of the box, as chosen in a published
/// example, form the rim of the template.
#[test]
fn the_edge_plants_of_a_published_example_are_the_rim() {
    let ranges = [("k", 1.0, 10.0, Logarithmic), ("a", 1.0, 5.0, Logarithmic), ("b", 20.0, 30.0, Linear)];
    let family = family(&ranges, 3, |p| coefficients(vec![p[0]], vec![1.0.into(), p[1] + p[2], p[1] * p[2]]));
    let options = TemplateOptions::default();
    for frequency in [0.1, 5.0, 10.0, 100.0] {
        let template = built(&family, frequency).template;
        assert_resolved(&template);
        for step in 0..10 {
            let part = f64::from(step) / 9.0;
            let (k, a) = (1.0 + 9.0 * part, 1.0 + 4.0 * part);
            for values in [[10.0, a, 20.0], [1.0, a, 30.0], [k, 5.0, 30.0], [k, 1.0, 20.0]] {
                let response = family.plant().response(&values, frequency).unwrap();
                let distance = from_rim(&template.outlines, response, &options);
                assert!(distance < 0.05, "{frequency} rad/s, {values:?}: {distance} from the rim");
                assert!(beyond(&template.outlines, response, &options) < 0.05);
            }
        }
    }
}
