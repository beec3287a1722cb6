//! The plant with the weakest tracking response along a ray, the reference for all others.

use num_complex::Complex64;

use super::quadratic::negative_gains;

/// A plant that may have the greatest r |q + L0| somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CeilingPlant {
    /// Inverse plant ratio q.
    pub(super) inverse: Complex64,
    /// Magnitude |q|.
    pub(super) modulus: f64,
    /// Weight r.
    pub(super) weight: f64,
}

/// The gains along a ray at which one candidate is the greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CeilingPiece {
    pub(super) candidate: CeilingPlant,
    pub(super) window: [f64; 2],
}

/// The candidates that can be the greatest at some gain: with equal weights the corners of the
/// convex hull, since the farthest point is always one of them; otherwise all.
pub(super) fn contenders(mut candidates: Vec<CeilingPlant>) -> Vec<CeilingPlant> {
    if candidates.windows(2).any(|pair| matches!(pair, [a, b] if a.weight != b.weight)) {
        return candidates;
    }
    let order = |a: &CeilingPlant, b: &CeilingPlant| {
        a.inverse.re.total_cmp(&b.inverse.re).then(a.inverse.im.total_cmp(&b.inverse.im))
    };
    candidates.sort_unstable_by(order);
    candidates.dedup_by(|a, b| a.inverse == b.inverse);
    let mut hull = chain(candidates.iter());
    hull.extend(chain(candidates.iter().rev()));
    hull
}

/// One side of the convex hull of sorted points, without its last point if there is more than one.
fn chain<'a>(sorted: impl Iterator<Item = &'a CeilingPlant>) -> Vec<CeilingPlant> {
    let mut side: Vec<CeilingPlant> = Vec::new();
    for candidate in sorted {
        while let [.., before, last] = side.as_slice() {
            let (first, second) = (last.inverse - before.inverse, candidate.inverse - last.inverse);
            if first.re * second.im - first.im * second.re > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(*candidate);
    }
    if side.len() > 1 {
        side.pop();
    }
    side
}

/// The greatest candidate as a function of gain along the ray e^(j phi): consecutive pieces from 0
/// to infinity.
///
/// ```text
/// max over k of r_k^2 |q_k + L0|^2 = r_k^2 (g^2 + 2 c_k g + |q_k|^2)
/// ```
///
/// The two halves are solved separately and then merged; a pair of plants is compared only if each
/// is the greatest in its half.
pub(super) fn greatest(direction: Complex64, candidates: &[CeilingPlant]) -> Vec<CeilingPiece> {
    match candidates {
        [] => Vec::new(),
        [candidate] => vec![CeilingPiece { candidate: *candidate, window: [0.0, f64::INFINITY] }],
        _ => {
            let (left, right) = candidates.split_at(candidates.len() / 2);
            overlay(direction, &greatest(direction, left), &greatest(direction, right))
        }
    }
}

/// The greater of two piecewise functions.
fn overlay(direction: Complex64, ours: &[CeilingPiece], theirs: &[CeilingPiece]) -> Vec<CeilingPiece> {
    let mut pieces: Vec<CeilingPiece> = Vec::new();
    let mut add = |candidate: CeilingPlant, window: [f64; 2]| {
        if window[0] < window[1] {
            match pieces.last_mut() {
                Some(last) if last.candidate == candidate => last.window[1] = window[1],
                _ => pieces.push(CeilingPiece { candidate, window }),
            }
        }
    };
    let (mut ours, mut theirs) = (ours.iter().peekable(), theirs.iter().peekable());
    let mut from = 0.0;
    while let (Some(&&our), Some(&&their)) = (ours.peek(), theirs.peek()) {
        let to = our.window[1].min(their.window[1]);
        for [low, high] in where_greater(direction, &our.candidate, &their.candidate) {
            let (low, high) = (low.clamp(from, to), high.clamp(from, to));
            if low < high {
                add(our.candidate, [from, low]);
                add(their.candidate, [low, high]);
                from = high;
            }
        }
        add(our.candidate, [from, to]);
        from = to;
        if our.window[1] <= to {
            ours.next();
        }
        if their.window[1] <= to {
            theirs.next();
        }
    }
    pieces
}

/// The gains at which the second function is greater than the first.
fn where_greater(direction: Complex64, first: &CeilingPlant, second: &CeilingPlant) -> [[f64; 2]; 2] {
    let along =
        |candidate: &CeilingPlant| candidate.inverse.re * direction.re + candidate.inverse.im * direction.im;
    let (ours, theirs) = (first.weight * first.weight, second.weight * second.weight);
    let a = ours - theirs;
    let b = ours * along(first) - theirs * along(second);
    let (near, far) = (first.weight * first.modulus, second.weight * second.modulus);
    let c = (near - far) * (near + far);
    negative_gains(a, b, c, b * b - a * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(re: f64, im: f64, weight: f64) -> CeilingPlant {
        let inverse = Complex64::new(re, im);
        CeilingPlant { inverse, modulus: phea_dynamics::portable::magnitude(inverse), weight }
    }

    /// Points of a sunflower spiral: no two have the same radius or angle.
    fn scattered(count: u32, weight: impl Fn(f64) -> f64) -> Vec<CeilingPlant> {
        (0..count)
            .map(|index| {
                let (radius, angle) = (f64::from(index).sqrt(), 2.4 * f64::from(index));
                let (re, im) = (
                    radius * phea_dynamics::portable::cos(angle),
                    radius * phea_dynamics::portable::sin(angle),
                );
                candidate(3.0 + re, 1.0 + im, weight(angle))
            })
            .collect()
    }

    fn check(candidates: Vec<CeilingPlant>) {
        let value = |candidate: &CeilingPlant, point: Complex64| {
            candidate.weight * phea_dynamics::portable::magnitude(candidate.inverse + point)
        };
        let contenders = contenders(candidates.clone());
        for degree in (0_i32..360).step_by(7) {
            let angle = f64::from(degree).to_radians();
            let direction =
                Complex64::new(phea_dynamics::portable::cos(angle), phea_dynamics::portable::sin(angle));
            let pieces = greatest(direction, &contenders);
            let mut end = 0.0;
            for piece in &pieces {
                assert_eq!(piece.window[0], end);
                end = piece.window[1];
            }
            assert_eq!(end, f64::INFINITY);
            for step in -60..60 {
                let gain = phea_dynamics::portable::exp(f64::from(step) / 9.0);
                let most = candidates.iter().map(|each| value(each, direction * gain)).fold(0.0, f64::max);
                let piece = pieces.iter().find(|piece| gain < piece.window[1]).unwrap();
                let found = value(&piece.candidate, direction * gain);
                assert!((found / most - 1.0).abs() < 1e-13, "{found} of {most} at {gain}, {degree} degrees");
            }
        }
    }

    #[test]
    fn pieces_are_the_greatest_of_all_with_equal_weights() {
        let candidates = scattered(200, |_| 1.0);
        assert!(contenders(candidates.clone()).len() < 40);
        check(candidates);
        check(vec![candidate(1.0, 0.0, 1.0)]);
        check(vec![candidate(1.0, 0.0, 1.0), candidate(2.0, 0.0, 1.0), candidate(3.0, 0.0, 1.0)]);
    }

    #[test]
    fn pieces_are_the_greatest_of_all_with_different_weights() {
        check(scattered(60, |angle| 1.0 + 0.3 * phea_dynamics::portable::sin(5.0 * angle)));
    }
}
