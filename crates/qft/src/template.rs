//! Templates: what the responses of a family look like at one frequency.

use num_complex::Complex64;

/// The response of the family at one frequency: points that are plants, and the region that they fill.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// P0 H0, the nominal plant with its sensor.
    pub nominal: Complex64,
    /// Plants, the nominal one first.
    pub points: Vec<TemplatePoint>,
    /// Closed polygons of responses P H (the last point joins the first) around the region whose interior is known to be filled; more
    /// than one where the family falls into pieces, empty for a family without anything between its members.
    pub outlines: Vec<Vec<Complex64>>,
    /// How well the region is known.
    pub resolution: Resolution,
}

/// One plant of a template.
#[derive(Clone, Debug, PartialEq)]
pub struct TemplatePoint {
    /// Index of the member in its family; `None` for a plant that refinement added.
    pub member: Option<usize>,
    /// Its parameters; empty for a measured plant.
    pub values: Vec<f64>,
    /// P H, delay and hold within it.
    pub response: Complex64,
    /// Pd; zero where there is no such path.
    pub load_motion: Complex64,
    /// H
    pub sensor: Complex64,
}

/// How far neighbouring plants of a template lie apart.
#[derive(Clone, Debug, PartialEq)]
pub enum Resolution {
    /// Neighbours are closer than the tolerance everywhere.
    Resolved {
        /// Largest distance of two neighbours, degrees.
        phase_deg: f64,
        /// Largest distance of two neighbours, dB.
        magnitude_db: f64,
    },
    /// The budget of plants was spent; an undamped resonance inside the family never closes.
    NotResolved {
        /// Largest distance of two neighbours, degrees.
        phase_deg: f64,
        /// Largest distance of two neighbours, dB.
        magnitude_db: f64,
        /// Parameters of the plant beside the widest gap.
        near: Vec<f64>,
    },
    /// Nothing lies between the members.
    Members,
}
