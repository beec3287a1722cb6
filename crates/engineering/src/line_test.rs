//! The effective bulk modulus of a line from recordings of it with its far end blocked.
//!
//! ```text
//! volume or flow, pressure -> RiseFit: compliance at rest by pressure -----------+
//! flow, pressure -> spectrum -> ResponseFit: compliance, creep, inertance ---------+-> moduli, r_beta, wave speed
//! ```
//!
//! The virtual test stand of `[bench.line]` makes such recordings of the line of the project.
//!
//! The oil, the length and the bore are known from a project. A number that the recordings do not
//! determine is reported as such, with the reason.

mod found;
mod known;
mod misfit;
mod not_identifiable;
mod reading;
mod record_error;
mod response_noise;
mod rise;
mod rise_air;
mod rise_noise;
mod shaken;
mod stand;

pub use found::{LineIdentification, identify_line};
pub use known::KnownLine;
pub use misfit::LineMisfit;
pub use not_identifiable::{NotIdentifiableLine, WideQuantity};
pub use reading::{LineRecord, line_records};
pub use rise::{RiseFit, RiseRecord, VolumeSource};
pub use shaken::{CompliancePoint, LineParameters, ResponseFit};
pub use stand::{LineRun, LineSeries, clean_line_runs, line_runs, recorded};
