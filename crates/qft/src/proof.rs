//! Proof: the result that an audit found by searching is shown for every plant of the box and every
//! frequency of the band, as a certificate that a sceptic can check again.
//!
//! ```text
//! loop and box -> polynomials in s and the variables -> control points -> tree of leaves -> certificate        the prover, not trusted
//!                                                            certificate -> polynomials -> control points -> checked        the checker
//! ```
//!
//! Every claim is |V(jw, p)| <= |U(jw, p)| with two polynomials, see the table of `claimed`. Over a
//! box of plants and a panel of frequencies both are means of their control points, with the same
//! weights. A leaf is shown by one direction d:
//!
//! ```text
//! Re(conj(d) U_k) >= |d| |V_k| for every control point   ->   |V| <= |U| on the whole leaf
//! ```
//!
//! A loop is stable where n + c, the numerator of 1 + L, has no zero on the imaginary axis nor at
//! infinity for any plant of the box, and the roots of one plant lie to the left of it: roots move
//! continuously, so none can cross.

mod bounds;
mod certificate;
mod checker;
mod claimed;
mod comparison;
mod count;
mod dead_time;
mod direction;
mod hurwitz;
mod images;
mod model;
mod modelling;
mod over_panel;
mod panels;
mod part;
mod patch;
mod points;
mod polynomial;
mod prove;
mod sampling;
mod statement;
mod supremum;
mod walk;

pub use certificate::{
    Certificate, CertificateMember, CertificateSide, CertifiedPlant, Claim, ControlLaw, FrequencyPanel, LEAF,
    Late, LimitOf, LimitedLoop, ParameterSegment, PoleCount, Quotient, RollOffBound, Sampling, Sections,
    StableBox,
};
pub use checker::{CertificateNumber, Rejection, check};
pub use comparison::{CertificateDifference, differences};
pub use prove::{ProofOptions, prove};
pub use walk::ProofRegion;

use crate::verification::{SpecificationMargin, Verdict};

/// What was shown about a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// All claims that hold; `None` where nothing can be stated about such a loop.
    pub certificate: Option<Certificate>,
    /// That every plant is stable.
    pub stability: Standing,
    /// That every specification is satisfied, in their order.
    pub specifications: Vec<SpecificationProof>,
}

/// What was shown about a specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationProof {
    /// Whether it is satisfied by every plant, up to the tolerance.
    pub standing: Standing,
    /// Lower bound of the greatest ratio of closed loop to limit, dB: this value is reached
    /// somewhere.
    pub least_db: Option<f64>,
    /// Upper bound of this ratio, dB.
    pub most_db: Option<f64>,
    /// Where the least is reached.
    pub worst: Option<SpecificationMargin>,
}

/// Whether a claim is shown.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// For every plant and every frequency.
    Proven,
    /// At least one plant, at one frequency, contradicts it.
    Refuted,
    /// Neither.
    NotProven(NotProven),
}

impl Standing {
    /// The verdict on the claim.
    pub fn verdict(&self) -> Verdict {
        match self {
            Standing::Proven => Verdict::Met,
            Standing::NotProven(_) => Verdict::NotProven,
            Standing::Refuted => Verdict::Violated,
        }
    }
}

/// Why a claim is neither shown nor refuted.
#[derive(Clone, Debug, PartialEq)]
pub enum NotProven {
    /// The plants were measured: nothing can be claimed between two of them.
    Measured,
    /// The loop is sampled, and no bound was found on the images of the plant: its response does
    /// not fall with the frequency, or too late.
    Images,
    /// The band lies beyond half of the sampling frequency.
    BeyondSampling,
    /// The load's velocity is fed forward.
    RateFedForward,
    /// A sampled controller feeds an inner signal back.
    InnerFeedback,
    /// Waves travel in the plant, which has no polynomials.
    Waves,
    /// The coefficients of the plant are not polynomials in its parameters.
    NotPolynomial,
    /// The box has too many variables.
    TooManyVariables,
    /// The limit is a table without two points in the band.
    TableLimit,
    /// There is no prefilter: the spread of a family is not a ratio at one plant.
    Spread,
    /// The loop is not shown to be stable, so that closed loops have no meaning.
    Unstable,
    /// This number of leaves did not suffice; this part remains.
    Budget(ProofRegion),
    /// The ratio grows, and no maximum was found.
    Unbounded,
    /// No plant of the box could be shown to be stable or unstable.
    NoStableMember,
    /// The search has found a violation of what seems to be proven.
    Contradicted,
    /// The checker, which rounds outwards, could not confirm what the prover found.
    Rounding,
}
