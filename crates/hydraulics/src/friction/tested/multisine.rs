use phea_dynamics::portable;

/// Force over the rows of a recording: a sum of sines on a slowly drifting mean. Units: N, rad/s,
/// s.
///
/// ```text
/// F(t) = F_0 + F_1 tau + F_2 (3 tau^2 - 1)/2 + sum over k of (a_k cos(omega_k t) + b_k sin(omega_k t))
/// tau = 2 t/T - 1                                                             t = 0 at the first row
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MultisineForce {
    /// Number of rows.
    pub rows: usize,
    /// Frequency omega of each sine.
    pub frequencies: Vec<f64>,
    /// Duration T, from the first row to the last.
    pub duration: f64,
    /// Sizes F_0, F_1 and F_2; then a and b of each sine.
    pub sizes: Vec<f64>,
}

/// Number of sizes of a drifting mean.
pub const TRENDS: usize = 3;

/// Factors of these sizes at a position between -1 and 1: the Legendre polynomials.
pub fn trends(place: f64) -> [f64; TRENDS] {
    [1.0, place, 1.5 * place * place - 0.5]
}

impl MultisineForce {
    /// Force at equal distances in s from the first row.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::MultisineForce;
    /// let half_turn = std::f64::consts::PI;
    /// let sizes = vec![10.0, 2.0, 0.0, 3.0, 0.0];
    /// let force = MultisineForce { rows: 2, frequencies: vec![half_turn], duration: 1.0, sizes };
    /// let along = force.along(2, 1.0);
    /// assert!((along[0] - 11.0).abs() < 1e-12 && (along[1] - 9.0).abs() < 1e-12);
    /// ```
    pub fn along(&self, count: usize, distance: f64) -> Vec<f64> {
        self.shapes(count, distance).times(&self.sizes)
    }

    /// Factors of the sizes, at equal distances in s from the first row.
    pub fn shapes(&self, count: usize, distance: f64) -> MultisineShapes {
        let sizes = TRENDS + 2 * self.frequencies.len();
        let mut shapes = Vec::with_capacity(count * sizes);
        for index in 0..count {
            let time = index as f64 * distance;
            shapes.extend(trends(2.0 * time / self.duration - 1.0));
            for frequency in &self.frequencies {
                let angle = frequency * time;
                shapes.extend([portable::cos(angle), portable::sin(angle)]);
            }
        }
        MultisineShapes { sizes, shapes }
    }
}

/// Sines of a multisine force, and the drifting mean, for sizes of 1: common to forces with equal
/// frequencies and duration.
#[derive(Clone, Debug, PartialEq)]
pub struct MultisineShapes {
    sizes: usize,
    shapes: Vec<f64>,
}

impl MultisineShapes {
    /// Force at each time for sizes in N, N.
    pub fn times(&self, sizes: &[f64]) -> Vec<f64> {
        self.rows().map(|row| row.iter().zip(sizes).map(|(shape, size)| shape * size).sum()).collect()
    }

    /// Factors of the sizes, time after time.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.shapes.chunks_exact(self.sizes)
    }

    /// Number of sizes.
    pub fn sizes(&self) -> usize {
        self.sizes
    }

    /// Factors as in [`MultisineShapes::rows`], one after the other.
    pub(super) fn flat(&self) -> &[f64] {
        &self.shapes
    }
}
