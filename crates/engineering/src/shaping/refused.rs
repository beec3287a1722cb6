//! A change that cannot be made, with the part of its text that is the reason.

use std::ops::Range;

use phea_qft::manual_shaping::{EditError, ElementPattern, PassError};

use super::change::RequestedChange;
use crate::quantity::QuantityError;

/// A change that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{}` cannot be done", .requested.option_with_text())]
pub struct RefusedChange {
    /// Requested change.
    pub requested: RequestedChange,
    /// Bytes of its text that are the reason.
    pub part: Range<usize>,
    /// Reason for the rejection.
    pub reason: ChangeProblem,
}

/// Reason why a change cannot be made.
#[derive(Clone, Debug, PartialEq)]
pub enum ChangeProblem {
    /// The list of elements does not permit it.
    Edit(EditError),
    /// No element passes the requested point.
    Pass(PassError),
    /// The element that is to be solved for is disabled.
    Disabled,
    /// The nominal plant was not measured at the requested frequency.
    NotMeasured,
    /// The text of an element is not an inline table.
    NotAnElement,
    /// No equals sign separates the two parts of the text.
    NoEqualsSign,
    /// The text is not the number of an element.
    NotANumberOfAnElement(String),
    /// There is no element of this number.
    NoElement {
        /// Number as written.
        number: String,
        /// Number of elements.
        count: usize,
    },
    /// `through` is missing.
    NoPoint,
    /// `at` is missing.
    NoFrequency,
    /// A kind of element, or another word, that is not among [`solved_kinds`](super::solved_kinds).
    NotSolved(String),
    /// A kind of element without a number.
    WithoutNumber(String),
    /// The text between the kind of an element and the point does not begin with `with`.
    NotUnderstood(String),
    /// The number of a key cannot be given for this element.
    NotGiven {
        /// Key of the number.
        key: String,
        /// Kind of the element.
        pattern: ElementPattern,
    },
    /// The text is neither a magnitude in dB nor a phase in degrees.
    NotACoordinate(String),
    /// Magnitude or phase is given twice.
    CoordinateGivenTwice,
    /// The text is not a finite number.
    NotANumber(String),
    /// The text is not an angular frequency.
    Frequency(QuantityError),
}
