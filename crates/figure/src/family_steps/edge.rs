//! Future extreme of a response as an edge of a band.

/// Edge of the band that a limit's response allows: the response itself until it is farthest out,
/// then its farthest future value. `outwards` is 1 for the upper limit and -1 for the lower.
pub(super) fn settling(mut points: Vec<(f64, f64)>, outwards: f64) -> Vec<(f64, f64)> {
    points.retain(|point| point.0.is_finite() && point.1.is_finite());
    let mut reach = f64::NEG_INFINITY;
    let farthest = points.iter().map(|point| outwards * point.1).fold(reach, f64::max);
    for point in points.iter_mut().rev() {
        if reach < farthest {
            reach = reach.max(outwards * point.1);
            point.1 = outwards * reach;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_closes_with_what_a_limit_still_reaches() {
        let edge = |values: &[f64], outwards| -> Vec<f64> {
            let points = values.iter().enumerate().map(|(time, value)| (time as f64, *value)).collect();
            settling(points, outwards).into_iter().map(|point| point.1).collect()
        };
        assert_eq!(edge(&[0.0, 1.2, 0.9, 1.05, 1.0], 1.0), [0.0, 1.2, 1.05, 1.05, 1.0]);
        assert_eq!(edge(&[0.0, 0.5, 0.4, 1.0], -1.0), [0.0, 0.4, 0.4, 1.0]);
        assert_eq!(edge(&[0.0, f64::NAN, 1.0], 1.0), [0.0, 1.0]);
    }
}
