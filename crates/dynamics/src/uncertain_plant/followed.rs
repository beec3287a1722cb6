//! Second recording of a plant's coefficients, which polynomials track.

use super::{PlantEquations, UncertainPlant};
use crate::expression::Expression;

impl UncertainPlant {
    /// Plant with a second recording of its coefficients that polynomials track: one whose
    /// operations are smooth over the box. A recording with other powers of s is ignored.
    ///
    /// # Example
    /// A root found by Newton's method, and in closed form:
    /// ```
    /// use phea_dynamics::scalar::Scalar;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
    /// let with = |gain: for<'a> fn(phea_dynamics::expression::Recorded<'a>) -> phea_dynamics::expression::Recorded<'a>| {
    ///     let square = UncertainParameter { name: "k".into(), nominal: 2.0, minimum: 1.0, maximum: 3.0 };
    ///     UncertainPlant::record(vec![square], move |p| PlantCoefficients {
    ///         command: RationalCoefficients { numerator: vec![gain(p[0])], denominator: vec![1.0.into()] },
    ///         disturbance: None,
    ///         dead_time_s: 0.0.into(),
    ///         rate: None,
    ///     })
    /// };
    /// let plant = with(|k| k.sqrt())?.with_followed(&with(|k| (k / 1.4.into() + 1.4.into()) * 0.5.into())?);
    /// let [exact, followed] = [plant.expression(), plant.followed_expression()].map(|one| one.map(|one| one.number(&[2.0])));
    /// assert!((exact.ok_or("rational")? - followed.ok_or("rational")?).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_followed(mut self, other: &UncertainPlant) -> UncertainPlant {
        if let (PlantEquations::Rational(own), Some(other)) = (&mut self.equations, other.recorded())
            && own.command == other.command
            && own.disturbance == other.disturbance
            && own.rate == other.rate
        {
            own.followed = Some(other.coefficients.clone());
        }
        self
    }

    /// Recorded coefficients that polynomials track, in the order of
    /// [`UncertainPlant::expression`].
    pub fn followed_expression(&self) -> Option<&Expression> {
        self.recorded().map(|recorded| recorded.followed.as_deref().unwrap_or(&*recorded.coefficients))
    }
}
