//! What is claimed of a loop, and what shows it: everything that a checker needs, and nothing else.

use phea_dynamics::expression::Expression;

use crate::specification::ClosedLoop;

/// A claim about every plant of a box at every frequency of a band, with its proof.
///
/// Numbers mean the decimals that they print as, the shortest that read back as them.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The plant, as recorded operations on its parameters.
    pub plant: CertifiedPlant,
    /// G.
    pub feedback: Quotient,
    /// F.
    pub prefilter: Quotient,
    /// H.
    pub sensor: Quotient,
    /// What is claimed.
    pub claims: Vec<Claim>,
}

impl Certificate {
    /// Leaves of all trees.
    pub fn leaves(&self) -> usize {
        let panels = self.claims.iter().flat_map(|claim| match claim {
            Claim::Stable { panels, .. } | Claim::Limited { panels, .. } => panels.as_slice(),
            Claim::Unstable { .. } | Claim::Reached { .. } => &[],
        });
        // a tree of n leaves has n - 1 halvings of one byte each
        panels.map(|panel| (panel.tree.len() + 1) / 6).sum()
    }
}

/// The plant of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct CertifiedPlant {
    /// Its parameters.
    pub parameters: Vec<CertifiedParameter>,
    /// Number of variables t in [0, 1] that span the box.
    pub variables: usize,
    /// Coefficients of P, and of Pd where there is one, in the order of `lengths`.
    pub coefficients: Expression,
    /// Numbers of coefficients, highest power first: numerator and denominator of P, the same of Pd.
    pub lengths: Vec<usize>,
}

/// A parameter: `low + (high - low) t` of the variable with this index.
#[derive(Clone, Debug, PartialEq)]
pub struct CertifiedParameter {
    /// Its name.
    pub name: String,
    /// Its value where the variable is 0.
    pub low: f64,
    /// Its value where the variable is 1.
    pub high: f64,
    /// Which variable moves it; `None` where it is `low` always.
    pub variable: Option<usize>,
}

/// A quotient of polynomials in s, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Quotient {
    /// Numerator.
    pub numerator: Vec<f64>,
    /// Denominator.
    pub denominator: Vec<f64>,
}

impl Quotient {
    /// A number.
    pub fn constant(value: f64) -> Quotient {
        Quotient { numerator: vec![value], denominator: vec![1.0] }
    }
}

/// One claim.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// All poles of the loop with every plant, and of the prefilter, have negative real parts: at these variables they have, and on the
    /// way to every other plant none crosses the boundary of stability.
    Stable {
        /// Variables of one plant.
        member: Vec<f64>,
        /// From zero to infinity without a gap.
        panels: Vec<Panel>,
    },
    /// The plant of these variables has a pole without negative real part in the loop.
    Unstable {
        /// Its variables.
        member: Vec<f64>,
    },
    /// A closed loop is within `ratio` times its limit.
    Limited {
        /// What is limited.
        limited: Limited,
        /// The greatest ratio.
        ratio: f64,
        /// Over the band without a gap.
        panels: Vec<Panel>,
    },
    /// A closed loop is at least `ratio` times its limit somewhere.
    Reached {
        /// What is limited.
        limited: Limited,
        /// The ratio.
        ratio: f64,
        /// Where, rad/s.
        frequency_rad_per_s: f64,
        /// With which plant.
        member: Vec<f64>,
    },
}

/// A closed loop with its limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Limited {
    /// The closed loop.
    pub closed_loop: ClosedLoop,
    /// Which side is limited.
    pub side: Side,
    /// The limit is the magnitude of this.
    pub limit: Quotient,
    /// From and to, rad/s.
    pub band_rad_per_s: [f64; 2],
}

/// On which side of a magnitude its limit lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The ratio is that of the magnitude to its limit.
    Upper,
    /// The ratio is that of the limit to the magnitude.
    Lower,
}

/// A panel of frequencies and the tree of boxes that covers it with the box of the plants.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// rad/s
    pub from: f64,
    /// rad/s; may be infinite.
    pub to: f64,
    /// In order: an axis across which the box is halved, 0 being that of the frequency, then the lower half, then the upper one; or
    /// [`LEAF`] with the direction that shows the claim there, two numbers of 16 bits, the greater byte first.
    pub tree: Vec<u8>,
}

/// Stands before the direction of a leaf.
pub const LEAF: u8 = 255;
