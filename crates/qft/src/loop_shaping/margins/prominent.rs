//! Selection of margins: the worst one, and those that may become the worst nearby.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::DECIBELS_PER_NEPER;

/// Largest change of ln G for which a margin may be needed.
const REACH: f64 = 0.5;
/// Factor between a plant's magnitude squared and the worst one's beyond which the plant is not
/// considered, 12 dB.
const WINDOW: f64 = 16.0;
/// Largest number of plants retained for one column and requirement.
const PLANTS_MAXIMUM: usize = 4;
/// Relative difference of two squares whose margins may round to equal numbers, and difference of
/// two c that counts as rounding error.
const ROUNDING: f64 = 1e-9;

/// One margin: `d margin/dx = -(20/ln 10) Re(c d ln G/dx)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MarginCandidate {
    pub(crate) margin_db: f64,
    /// Coefficient c; its negative for a lower limit, the difference of both plants' c for a
    /// spread.
    pub(crate) sensitivity: Complex64,
    /// Index of the plant; in a spread, of the one with the greatest magnitude.
    pub(crate) plant: usize,
    /// The plant with the least magnitude, in a spread.
    pub(crate) other: Option<usize>,
}

impl MarginCandidate {
    fn is_finite(&self) -> bool {
        self.margin_db.is_finite() && self.sensitivity.is_finite()
    }
}

/// The plants of a column under a limit from one side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LimitedPlants<'a> {
    /// Index of each plant.
    pub(crate) plants: &'a [usize],
    /// The square of the limited magnitude of each plant.
    pub(crate) squares: &'a [f64],
    /// The greatest square for an upper limit, the least for a lower one.
    pub(crate) worst: f64,
    /// The square of the limit.
    pub(crate) allowed: f64,
    pub(crate) is_from_above: bool,
}

impl LimitedPlants<'_> {
    /// The plants that are [`prominent`] among those within the window, given c of the plant at
    /// each place.
    ///
    /// ```text
    /// threat > 0   only for   |c - c_worst| > ln(q)/(2 REACH),   ln(q)/2 >= (q - 1)/(q + 1)        q: quotient of the squares, 1 or more
    /// ```
    ///
    /// so that the margins of many plants need not be computed.
    pub(crate) fn prominent(&self, coefficient: impl Fn(usize) -> Complex64) -> Vec<MarginCandidate> {
        let as_bad = |square: f64| (square - self.worst).abs() <= ROUNDING * self.worst;
        let as_bad = self.places().filter(|(_, square)| as_bad(*square));
        let Some(worst) = worst_of(as_bad.map(|(place, _)| self.candidate(place, coefficient(place)))) else {
            return vec![];
        };
        let mut threatening = Vec::with_capacity(self.squares.len());
        for (place, square) in self.places().filter(|(_, square)| self.is_within(*square)) {
            let own = coefficient(place);
            let least = (square - self.worst).abs() / (square + self.worst) / REACH - ROUNDING;
            let is_harmless =
                least > 0.0 && (self.signed(own) - worst.sensitivity).norm_sqr() < least * least;
            if !is_harmless {
                threatening.push(self.candidate(place, own));
            }
        }
        prominent(worst, threatening)
    }

    fn places(&self) -> impl Iterator<Item = (usize, f64)> {
        self.squares.iter().copied().enumerate()
    }

    fn is_within(&self, square: f64) -> bool {
        if self.is_from_above { square * WINDOW >= self.worst } else { square <= self.worst * WINDOW }
    }

    fn signed(&self, coefficient: Complex64) -> Complex64 {
        coefficient * if self.is_from_above { 1.0 } else { -1.0 }
    }

    fn candidate(&self, place: usize, coefficient: Complex64) -> MarginCandidate {
        let square = self.squares[place];
        let room = if self.is_from_above { self.allowed / square } else { square / self.allowed };
        MarginCandidate {
            margin_db: half_decibels(room),
            sensitivity: self.signed(coefficient),
            plant: self.plants[place],
            other: None,
        }
    }
}

/// Magnitude with this square, dB.
pub(crate) fn half_decibels(squared: f64) -> f64 {
    DECIBELS_PER_NEPER * 0.5 * portable::ln(squared)
}

/// The candidate with the least margin; NaN is ignored.
pub(crate) fn worst_of(all: impl Iterator<Item = MarginCandidate>) -> Option<MarginCandidate> {
    all.filter(MarginCandidate::is_finite).min_by(|one, other| one.margin_db.total_cmp(&other.margin_db))
}

/// The worst candidate, then successively the one that threatens most to become it; NaN is ignored.
pub(crate) fn prominent(worst: MarginCandidate, mut others: Vec<MarginCandidate>) -> Vec<MarginCandidate> {
    others.retain(MarginCandidate::is_finite);
    let mut chosen = Vec::with_capacity(PLANTS_MAXIMUM);
    chosen.push(worst);
    // for each, the square of the distance from the nearest selected one
    let mut distances = vec![f64::INFINITY; others.len()];
    let mut newest = worst;
    while chosen.len() < PLANTS_MAXIMUM {
        let mut most: Option<(f64, MarginCandidate)> = None;
        for (distance, candidate) in distances.iter_mut().zip(&others) {
            *distance = distance.min((candidate.sensitivity - newest.sensitivity).norm_sqr());
            let reach = DECIBELS_PER_NEPER * REACH * distance.sqrt();
            let threat = reach - (candidate.margin_db - worst.margin_db);
            let is_more = most.is_none_or(|(greatest, other)| {
                let as_great = threat == greatest && candidate.margin_db >= other.margin_db;
                threat > greatest || as_great
            });
            if threat > 0.0 && is_more {
                most = Some((threat, *candidate));
            }
        }
        let Some((_, next)) = most else { break };
        newest = next;
        chosen.push(newest);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use phea_dynamics::random::{stream, uniform};

    use super::*;

    /// Selection from all margins within the window, computed.
    fn by_all(plants: &LimitedPlants<'_>, coefficients: &[Complex64]) -> Vec<MarginCandidate> {
        let within = plants.places().filter(|(_, square)| plants.is_within(*square));
        let all: Vec<_> = within.map(|(place, _)| plants.candidate(place, coefficients[place])).collect();
        worst_of(all.iter().copied()).map_or(vec![], |worst| prominent(worst, all))
    }

    /// Squares close together, far apart and equal, and c that are spread or equal.
    #[test]
    fn margins_that_are_not_computed_do_not_matter() {
        let mut state = stream(11, 1);
        let mut several = 0;
        for case in 0..4000 {
            let count = case % 40;
            let [spread, apart] = [6.0, 4.0].map(|most| most * uniform(&mut state));
            let mut square = || portable::exp(spread * (uniform(&mut state) - 0.5));
            let mut squares: Vec<f64> = (0..count).map(|_| square()).collect();
            if case % 3 == 0 && count > 3 {
                (squares[1], squares[3]) = (squares[0], squares[2] * (1.0 + f64::EPSILON));
            }
            if case % 7 == 0 && count > 5 {
                squares[5] = f64::NAN;
            }
            let mut coefficient =
                || Complex64::new(apart * (uniform(&mut state) - 0.5), apart * (uniform(&mut state) - 0.5));
            let coefficients: Vec<Complex64> = (0..count).map(|_| coefficient()).collect();
            let places: Vec<usize> = (0..count).collect();
            for is_from_above in [true, false] {
                let worst = match is_from_above {
                    true => squares.iter().copied().fold(0.0, f64::max),
                    false => squares.iter().copied().fold(f64::INFINITY, f64::min),
                };
                let plants =
                    LimitedPlants { plants: &places, squares: &squares, worst, allowed: 2.0, is_from_above };
                let found = plants.prominent(|place| coefficients[place]);
                assert_eq!(found, by_all(&plants, &coefficients), "{plants:?}");
                several += usize::from(found.len() > 1);
            }
        }
        assert!(several > 2000, "{several}");
    }
}
