use phea_dynamics::order::median;

use crate::estimate::Estimate;

/// A straight line through points.
#[derive(Clone, Copy)]
pub(in crate::identify) struct StraightLine {
    /// Zero of the line.
    pub(in crate::identify) zero: Estimate,
    pub(in crate::identify) slope: Estimate,
}

/// Straight line through points; points far from the others' line do not count.
pub(in crate::identify) fn straight_line(points: &[(f64, f64)]) -> Option<StraightLine> {
    const FEWEST: usize = 5;
    let fitted = |points: &[(f64, f64)]| -> Option<StraightLine> {
        let count = points.len() as f64;
        let [x, y] = [points.iter().map(|(x, _)| x).sum::<f64>(), points.iter().map(|(_, y)| y).sum::<f64>()]
            .map(|sum| sum / count);
        let square: f64 = points.iter().map(|(at, _)| (at - x) * (at - x)).sum();
        let product: f64 = points.iter().map(|(at, value)| (at - x) * (value - y)).sum();
        let slope = product / square;
        let rest = |(at, value): &(f64, f64)| value - y - slope * (at - x);
        let residual: f64 = points.iter().map(|point| rest(point) * rest(point)).sum();
        let noise = (residual / (count - 2.0)).sqrt();
        let away = y / slope;
        let of_zero = noise / slope.abs() * (1.0 / count + away * away / square).sqrt();
        (points.len() >= FEWEST && square > 0.0 && slope != 0.0).then(|| StraightLine {
            zero: Estimate::of(x - away, of_zero),
            slope: Estimate::of(slope, noise / square.sqrt()),
        })
    };
    let StraightLine { zero, slope } = fitted(points)?;
    let away = |(x, y): &(f64, f64)| (y - slope.value * (x - zero.value)).abs();
    let usual = median(points.iter().map(away).collect());
    let near: Vec<(f64, f64)> = points.iter().filter(|point| away(point) <= 4.0 * usual).copied().collect();
    fitted(&near)
}
