//! Combinations of functions of time.

use super::Profile;
use super::piece::{PieceShape, ProfilePiece};
use crate::order::sorted_distinct;

impl Profile {
    /// Sum of functions; zero without any. A break of any function is a break of the sum.
    ///
    /// # Example
    /// A sine around a step:
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let step = Profile::steps(0.0, &[(1.0, 4000.0)])?;
    /// let sine = Profile::sine(2.0, 500.0, 10.0)?;
    /// let both = Profile::sum(&[step, sine.clone()]);
    /// assert_eq!((both.value(0.5), both.value(1.5)), (0.0, 4000.0));
    /// assert_eq!(both.value(2.1), 4000.0 + sine.value(2.1));
    /// assert_eq!(both.breaks(), [1.0, 2.0]);
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    #[must_use]
    pub fn sum(profiles: &[Profile]) -> Profile {
        let breaks = sorted_distinct(profiles.iter().flat_map(Profile::breaks).collect());
        let none = ProfilePiece::new(PieceShape::Constant { value: 0.0 });
        let total = |of: &dyn Fn(&Profile) -> ProfilePiece| {
            profiles.iter().fold(none.clone(), |sum, profile| sum.plus(&of(profile)))
        };
        let later = breaks.into_iter().map(|time_s| (time_s, total(&|profile| profile.piece(time_s))));
        Profile { first: total(&|profile| profile.first.clone()), later: later.collect() }
    }

    /// Function that is constant from a time on, at its value there.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let ramp = Profile::ramp(0.0, 2.0, 1.0)?.held_from(0.5);
    /// assert_eq!((ramp.value(0.4), ramp.value(3.0), ramp.rate(3.0)), (0.2, 0.25, 0.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    #[must_use]
    pub fn held_from(mut self, time_s: f64) -> Profile {
        let value = self.value_before(time_s);
        self.later.retain(|(start_s, _)| *start_s < time_s);
        self.later.push((time_s, ProfilePiece::new(PieceShape::Constant { value })));
        self
    }

    /// Function that is zero before a time.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let late = Profile::table(&[1.0, 2.0], &[3.0, 4.0])?.begun_at(1.0);
    /// assert_eq!((late.value(0.9), late.value(1.0), late.value(2.0)), (0.0, 3.0, 4.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    #[must_use]
    pub fn begun_at(self, time_s: f64) -> Profile {
        let holding = self.piece(time_s);
        let after = self.later.into_iter().filter(|(start_s, _)| *start_s > time_s);
        let later = std::iter::once((time_s, holding)).chain(after).collect();
        Profile { later, ..Profile::constant(0.0) }
    }

    /// Value just before a time: at a break, that of the piece which ends there.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let step = Profile::steps(0.0, &[(2.0, 4000.0)])?;
    /// assert_eq!((step.value_before(2.0), step.value(2.0)), (0.0, 4000.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn value_before(&self, time_s: f64) -> f64 {
        let begun = self.later.partition_point(|(start_s, _)| *start_s < time_s);
        self.last_of(begun).at(time_s).value
    }
}
