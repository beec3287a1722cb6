//! A structure without factors that have almost no effect.

use phea_dynamics::portable;

use super::{Structure, StructureFactor};

impl Structure {
    /// The structure without real zeros and poles beyond a corner, rad/s, and its x, with equal
    /// gain at low frequency; `None` if it has no such roots.
    ///
    /// ```text
    /// (s/z + 1)(s/z' + 1) -> s/z + 1    for z' beyond the corner,      z, z' = w (zeta -+ sqrt(zeta^2 - 1))
    /// ```
    ///
    /// # Example
    /// A pair of zeros at 2 and 200 rad/s: beyond 100 rad/s the second one is omitted.
    /// ```
    /// use phea_dynamics::portable::ln;
    /// use phea_qft::loop_shaping::{Structure, StructureFactor};
    /// let pair = StructureFactor::ZeroPair { natural_frequency: [1.0, 1e3], damping_ratio: [0.1, 30.0] };
    /// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts: vec![pair] };
    /// let x = [3.0, 20.0, 5.05].map(ln); // k, w, zeta: (s/2 + 1)(s/200 + 1)
    /// let (shorter, x) = structure.without_roots_beyond(100.0, &x).ok_or("it has one")?;
    /// assert_eq!(shorter.parts, [StructureFactor::RealZero { frequency: [1.0, 1e3] }]);
    /// assert!((x[0] - ln(3.0)).abs() < 1e-12 && (x[1] - ln(2.0)).abs() < 1e-12);
    /// assert_eq!(structure.without_roots_beyond(300.0, &[3.0, 20.0, 5.05].map(ln)), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn without_roots_beyond(&self, corner_rad_per_s: f64, x: &[f64]) -> Option<(Structure, Vec<f64>)> {
        let mut numbers = self.numbers(x).into_iter();
        let mut cache = vec![numbers.next()?];
        let mut parts = Vec::new();
        let mut is_shorter = false;
        for part in &self.parts {
            let own: Vec<f64> = numbers.by_ref().take(part.ranges().count()).collect();
            let slow = part.roots_up_to(corner_rad_per_s, &own);
            is_shorter |= !matches!(slow, SlowRoots::All);
            match slow {
                SlowRoots::All => {
                    parts.push(part.clone());
                    cache.extend(own);
                }
                SlowRoots::One(single, frequency) => {
                    parts.push(single);
                    cache.push(frequency);
                }
                SlowRoots::None => {}
            }
        }
        let shorter = Structure { parts, ..self.clone() };
        let x = shorter.of_free(cache.into_iter().map(portable::ln));
        is_shorter.then_some((shorter, x))
    }
}

/// Remainder of a factor.
enum SlowRoots {
    All,
    /// A single root, and its frequency.
    One(StructureFactor, f64),
    None,
}

impl StructureFactor {
    /// The roots of a factor with these numbers up to a corner, rad/s.
    fn roots_up_to(&self, corner: f64, numbers: &[f64]) -> SlowRoots {
        let (single, pair) = match *self {
            StructureFactor::RealZero { .. } | StructureFactor::RealPole { .. } => (self.clone(), false),
            StructureFactor::ZeroPair { natural_frequency: frequency, .. } => {
                (StructureFactor::RealZero { frequency }, true)
            }
            StructureFactor::PolePair { natural_frequency: frequency, .. } => {
                (StructureFactor::RealPole { frequency }, true)
            }
            StructureFactor::Fixed(_) | StructureFactor::Notch { .. } => return SlowRoots::All,
        };
        match (pair, numbers) {
            (false, [frequency]) if *frequency > corner => SlowRoots::None,
            (true, [natural, damping]) if *damping >= 1.0 => {
                // their product is w^2: the slow one is not a difference of large numbers
                let fast = natural * (damping + (damping * damping - 1.0).sqrt());
                let slow = natural * natural / fast;
                match (fast > corner, slow > corner) {
                    (false, _) => SlowRoots::All,
                    (true, false) => SlowRoots::One(single, slow),
                    (true, true) => SlowRoots::None,
                }
            }
            _ => SlowRoots::All,
        }
    }
}
