use num_complex::Complex64;
use phea_qft::family::Spacing::Linear;
use phea_qft::family::UncertainFamily;
use phea_qft::template::{Resolution, TemplateOptions};

use super::support::{
    Random, apart, beyond, built, coefficients, family, from_rim, quadratic_family, random_values, winding,
};

/// Real and imaginary part are quadratic in the parameters: images are folded, and their rim is
/// partly the image of interior points of the box.
#[test]
fn no_random_plant_is_outside() {
    let options = TemplateOptions::default();
    for dimension in 2..=4 {
        for seed in 101..113 {
            let family = quadratic_family(dimension, seed);
            let template = built(&family, 1.0).template;
            assert!(matches!(template.resolution, Resolution::Resolved { .. }));
            for values in random_values(&family, 1500, seed) {
                let response = family.plant().response(&values, 1.0).unwrap();
                let distance = beyond(&template.outlines, response, &options);
                assert!(
                    distance < 0.5,
                    "{dimension} parameters, seed {seed}, {values:?}: {distance} outside"
                );
            }
        }
    }
}

/// The parameters whose response is nearest, by Gauss-Newton within the box from a grid of starts.
fn nearest(family: &UncertainFamily, target: Complex64) -> Complex64 {
    let response = |point: [f64; 2]| family.plant().response(&point, 1.0).unwrap();
    let mut best = response([0.0, 0.0]);
    for start in 0..81 {
        let mut point = [f64::from(start % 9) / 4.0 - 1.0, f64::from(start / 9) / 4.0 - 1.0];
        for _ in 0..20 {
            let here = response(point);
            if (here - target).norm_sqr() < (best - target).norm_sqr() {
                best = here;
            }
            let slope = [
                (response([point[0] + 1e-6, point[1]]) - here) / 1e-6,
                (response([point[0], point[1] + 1e-6]) - here) / 1e-6,
            ];
            let missing = target - here;
            let damping = 1e-6;
            let normal = |first: Complex64, second: Complex64| first.re * second.re + first.im * second.im;
            let (a, b) = (normal(slope[0], slope[0]) + damping, normal(slope[0], slope[1]));
            let c = normal(slope[1], slope[1]) + damping;
            let (right_0, right_1) = (normal(slope[0], missing), normal(slope[1], missing));
            let determinant = a * c - b * b;
            point[0] = (point[0] + (c * right_0 - b * right_1) / determinant).clamp(-1.0, 1.0);
            point[1] = (point[1] + (a * right_1 - b * right_0) / determinant).clamp(-1.0, 1.0);
        }
    }
    best
}

/// Holes narrower than a tolerance count as filled, so that a plant may be half a tolerance away,
/// but no farther.
#[test]
fn every_point_inside_an_outline_is_a_plant() {
    let options = TemplateOptions::default();
    let mut inside = 0;
    for seed in 201..209 {
        let family = quadratic_family(2, seed);
        let outlines = built(&family, 1.0).template.outlines;
        let mut random = Random(seed);
        for _ in 0..60 {
            let pick = |fraction: f64| outlines[0][(fraction * outlines[0].len() as f64) as usize];
            let (first, second) = (pick(random.draw()), pick(random.draw()));
            let response = first + (second - first) * random.draw();
            let filled = outlines.iter().any(|outline| winding(outline, response) != 0);
            if filled && from_rim(&outlines, response, &options) > 0.05 {
                inside += 1;
                let distance = apart(nearest(&family, response), response, &options);
                assert!(distance < 0.5, "seed {seed}: {response} is {distance} from any plant");
            }
        }
    }
    assert!(inside > 200, "{inside}");
}

/// Fold y = 0 for the real part 5 + x and imaginary part y^2 at 1 rad/s, y from -1 to 1: it is
/// inside the box, and the four edges enclose no area.
#[test]
fn a_fold_inside_the_box_is_found() {
    let family = family(&[("x", 0.0, 1.0, Linear), ("y", -1.0, 1.0, Linear)], 2, |p| {
        coefficients(vec![p[1] * p[1], p[0] + 5.0.into()], vec![1.0.into()])
    });
    let outlines = built(&family, 1.0).template.outlines;
    let options = TemplateOptions::default();
    for (real, imaginary) in [(5.5, 0.02), (5.02, 0.5), (5.5, 0.5), (5.5, 0.98)] {
        assert_eq!(beyond(&outlines, Complex64::new(real, imaginary), &options), 0.0);
    }
    for (real, imaginary) in [(5.5, -0.02), (5.5, 1.02), (4.98, 0.5), (6.02, 0.5)] {
        assert!(beyond(&outlines, Complex64::new(real, imaginary), &options) > 0.0);
    }
}
