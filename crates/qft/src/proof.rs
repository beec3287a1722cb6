//! Proof: the result of an audit, found by searching, is proven for every plant of the box and
//! every frequency of the band, as a certificate that a sceptic can check.
//!
//! ```text
//! loop and box -> polynomials in s and the variables -> control points -> tree of leaves -> certificate        the prover, not trusted
//!                                                            certificate -> polynomials -> control points -> checked        the checker
//! ```
//!
//! Every claim is |V(jw, p)| <= |U(jw, p)| with two polynomials, see the table in `claimed`. Over a
//! box of plants and a panel of frequencies both are weighted means of their control points, with
//! equal weights for both. A leaf is proven by one direction d:
//!
//! ```text
//! Re(conj(d) U_k) >= |d| |V_k| for every control point   ->   |V| <= |U| on the whole leaf
//! ```
//!
//! A loop is stable if n + c, the numerator of 1 + L, has no zero on the imaginary axis or at
//! infinity for any plant of the box, and the roots for one plant are to the left of the axis:
//! roots move continuously, so none can cross.

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

/// Results of a proof about a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// All claims that hold; `None` if no certificate can state such a loop.
    pub certificate: Option<Certificate>,
    /// Claim that every plant is stable.
    pub stability: ClaimStatus,
    /// Claims that each specification is satisfied, in order.
    pub specifications: Vec<SpecificationProof>,
}

/// Results of a proof about a specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationProof {
    /// Claim that every plant satisfies it, up to the tolerance.
    pub claim_status: ClaimStatus,
    /// Lower bound on the greatest ratio of closed loop to limit, dB: this value is reached
    /// somewhere.
    pub least_db: Option<f64>,
    /// Upper bound on this ratio, dB.
    pub most_db: Option<f64>,
    /// Point where the least value is reached.
    pub worst: Option<SpecificationMargin>,
}

/// Status of a claim.
#[derive(Clone, Debug, PartialEq)]
pub enum ClaimStatus {
    /// The claim holds for every plant and every frequency.
    Proven,
    /// The claim is contradicted by at least one plant, at one frequency.
    Refuted,
    /// The claim is neither proven nor refuted.
    NotProven(NotProven),
}

impl ClaimStatus {
    /// The verdict on the claim.
    pub fn verdict(&self) -> Verdict {
        match self {
            ClaimStatus::Proven => Verdict::Met,
            ClaimStatus::NotProven(_) => Verdict::NotProven,
            ClaimStatus::Refuted => Verdict::Violated,
        }
    }
}

/// Reason why a claim is neither proven nor refuted.
#[derive(Clone, Debug, PartialEq)]
pub enum NotProven {
    /// The plants were measured: no claim is possible between two of them.
    Measured,
    /// The loop is sampled, and no bound was found on the images of the plant: its response does
    /// not fall with the frequency, or only at too high a frequency.
    Images,
    /// The band extends beyond half of the sampling frequency.
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
    /// The loop is not shown to be stable, so that closed loops are meaningless.
    Unstable,
    /// The budget of leaves did not suffice; this part remains.
    Budget(ProofRegion),
    /// The ratio grows, and no maximum was found.
    Unbounded,
    /// The search found no plant of the box that could be shown to be stable or unstable.
    NoStableMember,
    /// The search has found a violation of a claim that seems to be proven.
    Contradicted,
    /// The checker, which rounds outwards, could not confirm the prover's result.
    Rounding,
}
