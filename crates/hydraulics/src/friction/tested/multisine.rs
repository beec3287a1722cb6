use std::iter;

use phea_dynamics::portable;

/// A force over the rows of a recording that is a sum of sines. Units: N, rad/s.
///
/// ```text
/// F(t) = F_0 + sum over k of (a_k cos(omega_k t) + b_k sin(omega_k t))        t = 0 at the first row
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MultisineForce {
    /// How many rows there are.
    pub rows: usize,
    /// omega of each sine.
    pub frequencies: Vec<f64>,
    /// F_0; then a and b of each sine.
    pub sizes: Vec<f64>,
}

impl MultisineForce {
    /// The force at equal distances in s from the first row.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::MultisineForce;
    /// let half_turn = std::f64::consts::PI;
    /// let force = MultisineForce { rows: 2, frequencies: vec![half_turn], sizes: vec![10.0, 3.0, 0.0] };
    /// let along = force.along(2, 1.0);
    /// assert!((along[0] - 13.0).abs() < 1e-12 && (along[1] - 7.0).abs() < 1e-12);
    /// ```
    pub fn along(&self, count: usize, distance: f64) -> Vec<f64> {
        let shapes = self.shapes(count, distance);
        let sum = |shapes: &[f64]| shapes.iter().zip(&self.sizes).map(|(shape, size)| shape * size).sum();
        shapes.chunks_exact(self.frequencies.len() * 2 + 1).map(sum).collect()
    }

    /// What each size is multiplied by, time after time.
    pub fn shapes(&self, count: usize, distance: f64) -> Vec<f64> {
        let of = |time: f64| {
            let sines = self.frequencies.iter().flat_map(move |frequency| {
                let angle = frequency * time;
                [portable::cos(angle), portable::sin(angle)]
            });
            iter::once(1.0).chain(sines)
        };
        (0..count).flat_map(|index| of(index as f64 * distance)).collect()
    }
}
