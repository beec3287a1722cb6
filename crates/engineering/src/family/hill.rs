//! Maximum of a result over the box of a family, from a start in it.

use std::collections::BTreeMap;

use phea_dynamics::expression::Expression;
use phea_dynamics::random;
use phea_qft::family::UncertainFamily;

/// First and least step of the search for an extreme, as fractions of each range.
const STEPS: [f64; 2] = [0.25, 1e-5];
/// Least distance within which the crest of a coefficient is searched for, number of points of a
/// scan to either side, and number of ternary steps from there on.
const NEAR: f64 = 0.02;
const SCANNED: f64 = 8.0;
const THIRDS: usize = 25;
/// Ratio that bounds the rise of a crest between the points of a scan: at most this times the step
/// from the highest of them down to its lower neighbour; a concave crest rises by at most that
/// step.
const RISE: f64 = 4.0;
/// Relative difference that counts as rounding.
pub(super) const SAME: f64 = 1e-9;
/// Seed of random draws.
pub(super) const SEED: u64 = 1;

/// A result over the box, to be maximised with this sign.
pub(super) struct Hill<'f> {
    family: &'f UncertainFamily,
    expression: &'f Expression,
    sign: f64,
    /// Coordinate that has a crest.
    along: Option<usize>,
    /// Bound of the rise of a crest between the points of a scan, see [`RISE`].
    rise: f64,
}

/// Known crests by the values that determine them: those of the parameters, the start of the
/// search, and its range.
type Crests = BTreeMap<Vec<u64>, Crest>;

/// Knowledge of the crest near a point.
#[derive(Clone, Copy)]
enum Crest {
    /// Upper bound of its height.
    UpTo(f64),
    /// Position and height of the crest.
    At { fraction: f64, height: f64 },
}

impl<'f> Hill<'f> {
    /// The objective of an expression with one result, with a crest along one coordinate, if there
    /// is one.
    pub(super) fn new(
        family: &'f UncertainFamily,
        expression: &'f Expression,
        sign: f64,
        along: Option<usize>,
    ) -> Hill<'f> {
        Hill { family, expression, sign, along, rise: RISE }
    }

    fn height(&self, fractions: &[f64]) -> f64 {
        self.sign * self.expression.number(&self.family.values(fractions))
    }

    /// Point reached by steps along each coordinate, and along all of them together, while they
    /// increase the value, with decreasing length. After each step the coordinate `along` moves to
    /// the best place nearby: a coefficient has a crest where the spool is at null, and steps away
    /// from it decrease the value.
    pub(super) fn climb(&self, fractions: Vec<f64>) -> Vec<f64> {
        let [mut step, least] = STEPS;
        let mut crests = Crests::new();
        let start = self.at_crest(fractions.clone(), 1.0, f64::NEG_INFINITY, &mut crests);
        let (mut fractions, mut best) = start.unwrap_or((fractions, f64::NEG_INFINITY));
        let mut state = random::stream(SEED, 1);
        while step > least {
            let mut higher = false;
            let axes = fractions.len();
            for direction in 0..2 * axes {
                let course: Vec<f64> = (0..axes)
                    .map(|axis| match direction < axes {
                        true => f64::from(u8::from(axis == direction)),
                        false => 2.0 * random::uniform(&mut state) - 1.0,
                    })
                    .collect();
                for side in [-step, step] {
                    let moved = fractions.iter().zip(&course);
                    let next =
                        moved.map(|(fraction, course)| (fraction + side * course).clamp(0.0, 1.0)).collect();
                    let wanted = best + SAME * best.abs();
                    if let Some(found) = self.at_crest(next, step, wanted, &mut crests) {
                        ((fractions, best), higher) = (found, true);
                    }
                }
            }
            if !higher {
                step *= 0.5;
            }
        }
        fractions
    }

    /// The point with the coordinate `along` at the best place nearby, and the height there, if it
    /// is more than `wanted`. Many steps end at a corner of the box, or move a coordinate on which
    /// the result does not depend: such points are searched once.
    fn at_crest(
        &self,
        mut fractions: Vec<f64>,
        step: f64,
        wanted: f64,
        crests: &mut Crests,
    ) -> Option<(Vec<f64>, f64)> {
        let start = self.along.and_then(|axis| Some((axis, *fractions.get(axis)?)));
        let Some((axis, middle)) = start else {
            let height = self.height(&fractions);
            return (height > wanted).then_some((fractions, height));
        };
        let within = step.max(NEAR);
        let values = self.family.values(&fractions);
        let felt = values.iter().enumerate().filter(|(index, _)| self.expression.depends_on(*index));
        let key = felt.map(|(_, value)| *value).chain([middle, within]).map(f64::to_bits).collect();
        let known = crests.entry(key).or_insert(Crest::UpTo(f64::INFINITY));
        if matches!(known, Crest::UpTo(height) if *height > wanted) {
            *known = self.crest(&fractions, axis, within, wanted);
        }
        match *known {
            Crest::At { fraction, height } if height > wanted => {
                fractions[axis] = fraction;
                Some((fractions, height))
            }
            _ => None,
        }
    }

    /// Crest along one coordinate within a distance: by a scan, then by ternary search around its
    /// best point, if that may reach more than `wanted`.
    fn crest(&self, fractions: &[f64], axis: usize, within: f64, wanted: f64) -> Crest {
        let middle = fractions[axis];
        let heights = |places: &[f64]| -> Vec<f64> {
            let at = |place: &f64| {
                let mut moved = fractions.to_vec();
                moved[axis] = place.clamp(0.0, 1.0);
                self.family.values(&moved)
            };
            let points: Vec<Vec<f64>> = places.iter().map(at).collect();
            self.expression.numbers(&points).into_iter().map(|number| self.sign * number).collect()
        };
        let spacing = within / SCANNED;
        let mut places = vec![middle - within];
        while let Some(next) =
            places.last().map(|last| last + spacing).filter(|next| *next <= middle + within)
        {
            places.push(next);
        }
        places.push(middle);
        let scanned = heights(&places);
        let (between, at_middle) = (&scanned[..scanned.len() - 1], scanned[scanned.len() - 1]);
        let mut best = (at_middle, middle);
        for (&height, &place) in between.iter().zip(&places) {
            if height > best.0 {
                best = (height, place);
            }
        }
        // two places, one of which is a step or more beyond the crest, also at an end of the box
        let beside = [-1.0, 1.0].map(|side| match best.1 + side * spacing {
            place if (0.0..=1.0).contains(&place) => place,
            _ => best.1 - 2.0 * side * spacing,
        });
        let falls = heights(&beside).into_iter().map(|height| best.0 - height);
        let [least, most] = falls
            .fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], fall| [least.min(fall), most.max(fall)]);
        let reach = if least < 0.0 { f64::INFINITY } else { best.0 + self.rise * most };
        if reach <= wanted {
            return Crest::UpTo(reach);
        }
        let [mut low, mut high] = [best.1 - spacing, best.1 + spacing];
        for _ in 0..THIRDS {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            let is_rising = matches!(heights(&thirds)[..], [first, second] if first < second);
            if is_rising {
                low = thirds[0];
            } else {
                high = thirds[1];
            }
        }
        let found = 0.5 * (low + high);
        let height = heights(&[found]);
        match height[..] {
            [height] if height > best.0 => Crest::At { fraction: found.clamp(0.0, 1.0), height },
            _ => Crest::At { fraction: best.1.clamp(0.0, 1.0), height: best.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::scalar::Scalar;
    use phea_dynamics::uncertain_plant::{
        PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
    };
    use phea_qft::family::{Coordinate, Extent, Spacing};

    use super::*;

    const NAMES: [&str; 3] = ["first", "second", "across"];

    /// A family over the unit cube.
    fn cube() -> UncertainFamily {
        let unit =
            |name: &str| UncertainParameter { name: name.into(), nominal: 0.5, minimum: 0.0, maximum: 1.0 };
        let plant = UncertainPlant::record(NAMES.map(unit).to_vec(), |values| PlantCoefficients {
            command: RationalCoefficients { numerator: values.to_vec(), denominator: vec![1.0.into()] },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        });
        let along = |index| Coordinate {
            parameters: vec![index],
            opposed: vec![],
            spacing: vec![Spacing::Linear],
            points: 2,
        };
        UncertainFamily::new(plant.unwrap(), (0..3).map(along).collect(), vec![], Extent::Box).unwrap()
    }

    /// The crest of a random hill: its position, its fall to both sides, and its rise along the
    /// crest.
    ///
    /// ```text
    /// h(x, y, v) = a x + b y - f(|v - c|),     c = c_0 + c_x x + c_y y in (0, 1)
    /// f(d) = k d^(1/4), k d^(1/2), k d, k d^2, or k d^2/(d^2 + w^2)
    /// ```
    struct DrawnCrest {
        rise: [f64; 2],
        place: [f64; 3],
        fall: f64,
        width: f64,
        kind: usize,
    }

    impl DrawnCrest {
        fn drawn(number: u64) -> DrawnCrest {
            let mut state = random::stream(SEED, number);
            let mut between = |low: f64, high: f64| low + (high - low) * random::uniform(&mut state);
            DrawnCrest {
                rise: [between(-1.0, 1.0), between(-1.0, 1.0)],
                place: [between(0.35, 0.65), between(-0.15, 0.15), between(-0.15, 0.15)],
                fall: between(0.5, 20.0),
                width: between(0.05, 0.5),
                kind: number as usize % 5,
            }
        }

        fn expression(&self) -> Expression {
            Expression::record(&NAMES, |values| {
                let [x, y, v] = [values[0], values[1], values[2]];
                let crest = x.times(self.place[1]) + y.times(self.place[2]) + self.place[0].into();
                let distance = (v - crest).abs();
                let shape = match self.kind {
                    0 => distance.sqrt().sqrt(),
                    1 => distance.sqrt(),
                    2 => distance,
                    3 => distance.squared(),
                    _ => distance.squared() / (distance.squared() + (self.width * self.width).into()),
                };
                vec![x.times(self.rise[0]) + y.times(self.rise[1]) - shape.times(self.fall)]
            })
        }

        /// Height of the maximum, which is a corner of x and y, on the crest.
        fn height(&self) -> f64 {
            self.rise.iter().map(|rise| rise.max(0.0)).sum()
        }
    }

    #[test]
    fn a_crest_that_cannot_rise_is_left_and_the_highest_place_is_found() {
        let family = cube();
        for number in 0..50 {
            let crest = DrawnCrest::drawn(number);
            let expression = crest.expression();
            let pruned = Hill::new(&family, &expression, 1.0, Some(2));
            let whole = Hill { rise: f64::INFINITY, ..Hill::new(&family, &expression, 1.0, Some(2)) };
            for start in [[0.5; 3], [0.1, 0.9, 0.2]] {
                let found = pruned.climb(start.to_vec());
                assert_eq!(found, whole.climb(start.to_vec()), "hill {number}");
                // the steeper the sides, the lower is a place with equally many correct digits
                let near = match crest.kind {
                    0 => continue,
                    1 => 1e-2 * crest.fall,
                    _ => 1e-4 * crest.fall,
                };
                let height = pruned.height(&found);
                assert!(
                    (height - crest.height()).abs() < near,
                    "hill {number}: {height} of {}",
                    crest.height()
                );
            }
        }
    }
}
