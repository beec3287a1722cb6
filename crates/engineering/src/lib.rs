//! Procedures of an engineer: a project becomes a rig, and each procedure returns its result as
//! values.
//!
//! ```text
//! Project -> setup::Setup { rig, controller, prefilter, sensor, timing }
//! Setup   -> sizing, linearize                                consequences of the rig
//! Setup   -> family -> robust::RobustProblem -> audit, shaping, design (-> trial on the machine -> repair)
//! Setup   -> simulate::ControlledMachine -> simulate, campaign the nonlinear model
//! Setup   -> bench                                            static tests of the valve
//! Project -> alternatives                                     one project with other values, compared
//! files   -> identify                                         the valve that explains recorded tests
//! files   -> response                                         frequency responses from recorded signals
//! files   -> line_test                                        the bulk modulus of a blocked line from recordings
//! files   -> friction                                         the friction that explains recorded runs
//! ```
//!
//! Results are values; the workbench turns them into text, JSON and figures.

pub mod alternatives;
pub mod audit;
pub mod bench;
pub mod campaign;
pub mod caveat;
mod common_position;
pub mod csv;
pub mod deployed;
pub mod design;
pub mod estimate;
pub mod family;
mod followed;
pub mod friction;
pub mod identify;
pub mod identify_error;
pub mod impossible;
mod impossible_steps;
pub mod limit_kind;
pub mod line_choice;
pub mod line_test;
pub mod linear_loop;
pub mod linear_step;
pub mod linearize;
pub mod number_table;
pub mod option;
pub mod parts;
pub mod plant_names;
pub mod replaced;
pub mod response;
pub mod rig;
pub mod robust;
pub mod setup;
pub mod shaping;
pub mod side_by_side;
pub mod simulate;
pub mod sizing;
pub mod specification;
pub mod table;
mod tendency;
pub mod trial;

pub(crate) use phea_project::{self as project, catalogue, source};
pub(crate) use phea_quantity::{self as quantity, spelling};
