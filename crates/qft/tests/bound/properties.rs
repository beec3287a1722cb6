//! Bounds against the closed loops of every plant, computed individually.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::bound::{BoundFunction, TemplateFill};
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};
use phea_qft::template::{Resolution, Template, TemplatePoint};

use super::random::{Numbers, random_requirements, random_template};

/// Distance to a limit below which a closed loop counts as satisfying it, dB.
const TOLERANCE_DB: f64 = 1e-9;

fn response(template: &Template, point: &TemplatePoint, nominal_loop: Complex64) -> LoopResponse {
    LoopResponse {
        plant: point.response / point.sensor,
        load_motion: point.load_motion,
        controller: nominal_loop / template.nominal,
        prefilter: Complex64::new(1.0, 0.0),
        sensor: point.sensor,
    }
}

/// The worst margin of these plants, dB; for tracking that of the spread.
fn worst_db<'a>(
    template: &Template,
    points: impl Iterator<Item = &'a TemplatePoint>,
    requirement: &Requirement,
    nominal_loop: Complex64,
) -> f64 {
    let margin = |requirement: &Requirement, point: &TemplatePoint| {
        let specification = Specification {
            requirement: requirement.clone(),
            frequencies_rad_per_s: vec![1.0],
            band_rad_per_s: [1.0, 1.0],
        };
        specification.margin_db(&response(template, point, nominal_loop), 1.0).unwrap()
    };
    let (Some(lower), upper) = requirement.limits() else {
        return points.map(|point| margin(requirement, point)).fold(f64::INFINITY, f64::min);
    };
    // margin to both limits, added: upper/lower over max|T|/min|T|
    let above = Requirement::tracking(Limit::Constant(1e-200), upper.clone());
    let below = Requirement::tracking(lower.clone(), Limit::Constant(1e200));
    let start = [f64::INFINITY; 2];
    let [above_db, below_db] = points.fold(start, |[above_db, below_db], point| {
        [above_db.min(margin(&above, point)), below_db.min(margin(&below, point))]
    });
    above_db + below_db
}

#[test]
fn outside_of_a_bound_every_plant_meets_the_limit_and_inside_one_does_not() {
    let mut numbers = Numbers(0x9E37_79B9_7F4A_7C15);
    let mut counts = [[0; 6]; 2];
    for trial in 0..250 {
        let template = random_template(&mut numbers);
        for (kind, requirement) in random_requirements(&mut numbers, &template).into_iter().enumerate() {
            let function = BoundFunction::new(&template, &requirement, TemplateFill::Points).unwrap();
            for _ in 0..8 {
                let nominal_loop = numbers.polar([0.01, 100.0], [-std::f64::consts::TAU, 0.0]);
                let phase = portable::argument(nominal_loop);
                let forbidden = function.forbidden(phase).contains(portable::magnitude(nominal_loop));
                let worst = worst_db(&template, template.points.iter(), &requirement, nominal_loop);
                let agrees = if forbidden { worst < TOLERANCE_DB } else { worst > -TOLERANCE_DB };
                assert!(agrees, "trial {trial}, {requirement:?} at {nominal_loop}: {forbidden}, {worst} dB");
                counts[usize::from(forbidden)][kind] += 1;
            }
        }
    }
    assert!(counts.iter().flatten().all(|&count| count > 100), "{counts:?}");
}

/// A family that fills a circle of the q-plane, represented by plants on its rim and one in its
/// middle.
fn disc(numbers: &mut Numbers) -> (Template, Vec<TemplatePoint>) {
    let one = Complex64::new(1.0, 0.0);
    let sensor = numbers.polar([0.5, 2.0], [-1.0, 0.0]);
    let center = numbers.polar([0.5, 2.0], [-3.0, 3.0]);
    let radius = portable::magnitude(center) * numbers.between(0.05, 0.8);
    let nominal = numbers.polar([0.1, 10.0], [-3.0, 3.0]);
    let plant = |inverse: Complex64| TemplatePoint {
        member: None,
        values: vec![],
        response: nominal / inverse,
        load_motion: one,
        sensor,
    };
    let corners = 14;
    let rim: Vec<Complex64> = (0..corners)
        .map(|corner| {
            let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(corners);
            center + radius * Complex64::new(portable::cos(angle), portable::sin(angle))
        })
        .collect();
    let template = Template {
        frequency_rad_per_s: 1.0,
        nominal,
        points: vec![plant(center)],
        outlines: vec![rim.iter().map(|&inverse| nominal / inverse).collect()],
        resolution: Resolution::Members,
    };
    let mut members: Vec<TemplatePoint> = rim.iter().map(|&inverse| plant(inverse)).collect();
    for (from, to) in rim.iter().zip(rim.iter().cycle().skip(1)) {
        for step in 1..200 {
            members.push(plant(from + (to - from) * f64::from(step) / 200.0));
        }
        let inner = [numbers.next(), numbers.next(), numbers.next()];
        let third = rim[(inner[2] * 14.0) as usize];
        members.push(plant(
            (from * inner[0] + third * inner[1] + center * inner[2]) / inner.iter().sum::<f64>(),
        ));
    }
    (template, members)
}

/// Edges in the q-plane are straight for all kinds except the control effort, whose edges are
/// straight in the plane of P: there the members omit the edges between the corners.
#[test]
fn a_filled_bound_serves_the_whole_region_and_forbids_only_what_a_plant_of_it_forbids() {
    let mut numbers = Numbers(0xD1B5_4A32_D192_ED03);
    let mut counts = [0; 3];
    for trial in 0..60 {
        let (template, members) = disc(&mut numbers);
        for requirement in random_requirements(&mut numbers, &template) {
            if matches!(requirement.closed_loop(), ClosedLoop::LoadMotion | ClosedLoop::ControlEffort) {
                continue;
            }
            let [points, filled] = [TemplateFill::Points, TemplateFill::Filled]
                .map(|fill| BoundFunction::new(&template, &requirement, fill).unwrap());
            for _ in 0..12 {
                let nominal_loop = numbers.polar([0.05, 20.0], [-std::f64::consts::TAU, 0.0]);
                let (gain, phase) = (portable::magnitude(nominal_loop), portable::argument(nominal_loop));
                // slightly away from the plant with 1 + L = 0, whose closed loops are undefined
                let response = -template.nominal / nominal_loop * (1.0 + 1e-6);
                let itself = TemplatePoint { response, ..members[0].clone() };
                let is_inside = inside(&template.outlines[0], template.nominal, -nominal_loop);
                let all = members.iter().chain(template.points.iter()).chain(is_inside.then_some(&itself));
                let worst = worst_db(&template, all, &requirement, nominal_loop);
                let forbidden = filled.forbidden(phase).contains(gain);
                // Between the members on an edge, 1/200 of it apart, the distance to -L0 changes by
                // less than 0.02 dB unless -L0 is on it.
                let agrees = if forbidden { worst < 0.05 } else { worst > -TOLERANCE_DB };
                assert!(agrees, "trial {trial}, {requirement:?} at {nominal_loop}: {forbidden}, {worst} dB");
                let by_points = points.forbidden(phase).contains(gain);
                assert!(forbidden || !by_points, "a filled template forbids what its plants do");
                counts[usize::from(forbidden) + usize::from(by_points)] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
}

/// True if a point is within a convex polygon, whose corners are P0/q.
fn inside(outline: &[Complex64], nominal: Complex64, point: Complex64) -> bool {
    let corners: Vec<Complex64> = outline.iter().map(|corner| nominal / corner).collect();
    corners.iter().zip(corners.iter().cycle().skip(1)).all(|(from, to)| {
        let (side, way) = (to - from, point - from);
        side.re * way.im - side.im * way.re > 0.0
    })
}

/// Control effort |G/(1 + L)| over a square of the plane of P, sampled densely.
#[test]
fn a_filled_bound_of_the_control_effort_serves_the_region_in_the_plane_of_the_plant() {
    let mut numbers = Numbers(0x1234_5678_9ABC_DEF1);
    let one = Complex64::new(1.0, 0.0);
    let corners = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)].map(|(re, im)| Complex64::new(re, im));
    let plant =
        |response| TemplatePoint { member: None, values: vec![], response, load_motion: one, sensor: one };
    let template = Template {
        frequency_rad_per_s: 1.0,
        nominal: corners[0],
        points: vec![plant(corners[0])],
        outlines: vec![corners.to_vec()],
        resolution: Resolution::Members,
    };
    let grid = (0_u8..=100).flat_map(|row| (0_u8..=100).map(move |column| (row, column)));
    let step = |index: u8| 1.0 + f64::from(index) / 50.0;
    let members: Vec<TemplatePoint> =
        grid.map(|(row, column)| plant(Complex64::new(step(row), step(column)))).collect();
    let mut counts = [0; 2];
    for _ in 0..60 {
        let requirement =
            Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(numbers.factor(0.05, 5.0)));
        let function = BoundFunction::new(&template, &requirement, TemplateFill::Filled).unwrap();
        for _ in 0..5 {
            let nominal_loop = numbers.polar([0.05, 5.0], [-std::f64::consts::TAU, 0.0]);
            let worst = worst_db(&template, members.iter(), &requirement, nominal_loop);
            let phase = portable::argument(nominal_loop);
            let forbidden = function.forbidden(phase).contains(portable::magnitude(nominal_loop));
            let agrees = if forbidden { worst < 0.05 } else { worst > -TOLERANCE_DB };
            assert!(agrees, "{requirement:?} at {nominal_loop}: {forbidden}, {worst} dB");
            counts[usize::from(forbidden)] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
}
