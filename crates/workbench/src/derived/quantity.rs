/// A quantity that follows from the project.
#[derive(Clone, Debug, PartialEq)]
pub struct Derived {
    /// Chapter of the list, in words.
    pub group: &'static str,
    /// Name, unique, with dots between its parts.
    pub name: String,
    /// Name in words, without its group.
    pub words: String,
    /// Symbol as in the notation, such as `K_H`.
    pub symbol: &'static str,
    /// Value, SI, or the reason why it does not exist.
    pub value: Result<f64, &'static str>,
    /// SI unit.
    pub unit: &'static str,
    /// Equation from which it follows.
    pub equation: &'static str,
    /// The value in use instead, if the project states one.
    pub stated: Option<Stated>,
}

/// A value that the project states for a quantity that also follows from the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// Value, SI.
    pub value: f64,
    /// Table that states it, such as `[linear]`, `[uncertainty]` or `[sizing]`.
    pub place: &'static str,
    /// Bounds, if stated.
    pub bounds: Option<[f64; 2]>,
}

/// Relative difference above which a stated value is called a contradiction: more than rounding to
/// two digits explains.
const CONTRADICTION: f64 = 0.05;

/// Relative tolerance of stated bounds, which are printed to three digits.
const BEYOND_BOUNDS: f64 = 0.01;

impl Derived {
    /// Difference of the stated from the derived value, percent of the latter; zero if both are
    /// zero.
    pub fn difference_percent(&self) -> Option<f64> {
        let (stated, value) = (self.stated.as_ref()?.value, self.value.ok()?);
        Some(if stated == value { 0.0 } else { 100.0 * (stated - value) / value })
    }

    /// True if the stated value is outside the bounds that the project states for it.
    pub fn outside_own_bounds(&self) -> bool {
        let outside = |stated: &Stated| {
            stated.bounds.is_some_and(|[minimum, maximum]| !(minimum..=maximum).contains(&stated.value))
        };
        self.stated.as_ref().is_some_and(outside)
    }

    /// True if the stated value contradicts its own bounds or the derived value.
    pub fn contradicts(&self) -> bool {
        self.outside_own_bounds() || self.contradicts_derived()
    }

    /// True if the derived value contradicts the stated one: it is more than 1 % outside the stated
    /// bounds, or, if there are none, more than 5 % away.
    pub fn contradicts_derived(&self) -> bool {
        let (Some(stated), Ok(value)) = (&self.stated, self.value) else { return false };
        match stated.bounds {
            Some([minimum, maximum]) => {
                let slack = BEYOND_BOUNDS * value.abs();
                value < minimum - slack || value > maximum + slack
            }
            None => (stated.value - value).abs() > CONTRADICTION * value.abs(),
        }
    }
}
