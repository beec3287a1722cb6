//! Loop shaping by hand: edits of a controller as values, elements solved so that the loop passes
//! through a required point, and the resulting margins of every plant.
//!
//! ```text
//! elements -> edit -> elements -> G(j w) -> margin of every specification at every design frequency -> edit -> ...
//! ```
//!
//! Elements are added one after the other until the nominal loop satisfies the bounds at every
//! design frequency (thesis, section 3.1.4). The templates do not depend on the controller: they
//! are built once, and each edit costs only the margins.

mod chart;
mod edit;
mod passing;
mod reach;

pub use chart::{DesignChart, DesignMargin, DesignPoint};
pub use edit::{Edit, EditError, apply};
pub use passing::{NeededCoordinate, PassError, WantedPoint, pass_through};
pub use reach::{ElementPattern, Reach};
