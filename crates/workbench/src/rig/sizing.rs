use phea_hydraulics::line::{Member, Stiffening};
use phea_hydraulics::servovalve::{Direction, control_coefficients};

use super::assembly::{expansion_at, hose};
use super::{Rig, RigError};
use crate::catalogue::HoseEntry;
use crate::project::Project;
use crate::sizing::{HoseOption, SizingProblem};
