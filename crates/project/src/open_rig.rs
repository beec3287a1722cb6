//! Declared rig with some of its numbers open, as a family of plants needs it.

use super::{DeclaredActuator, DeclaredOperatingPoint, TableNumber, operating_point};
use phea_table::OpenTable;

/// Declared actuator and its operating point, the numbers at some paths open.
///
/// # Example
/// ```
/// use phea_project::{OpenRig, STARTER, read};
/// use phea_project::source::Memory;
/// let project = read(&Memory::default().with("p.toml", STARTER), "p.toml", &[], &[])?.project;
/// let actuator = project.actuator.as_ref().unwrap();
/// let point = &project.operating_point;
/// let open = OpenRig::new(actuator, point, &["cylinder.stroke".to_string(), "line.length".to_string()]);
/// let longer = open.actuator(&[0.7, 2.0]);
/// assert_eq!((longer.cylinder.stroke, longer.line.b.length()), (0.7, Some(2.0)));
/// assert_eq!(longer.cylinder.moving_mass, actuator.cylinder.moving_mass);
/// # Ok::<(), phea_project::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct OpenRig {
    actuator: OpenTable,
    operating_point: OpenTable,
}

impl OpenRig {
    /// The rig with the numbers at these paths open; a path that it lacks is ignored.
    pub fn new(
        actuator: &DeclaredActuator,
        operating_point: &DeclaredOperatingPoint,
        paths: &[String],
    ) -> OpenRig {
        OpenRig {
            actuator: OpenTable::new(actuator, paths, |rig, visitor| rig.visit(visitor)),
            operating_point: OpenTable::new(operating_point, paths, |point, visitor| {
                operating_point::visit_as_table(point, visitor)
            }),
        }
    }

    /// The actuator with these values of its open numbers, in the order of their paths.
    pub fn actuator<S: TableNumber>(&self, open: &[S]) -> DeclaredActuator<S> {
        self.actuator.over(open, |rig: &mut DeclaredActuator<S>, visitor| rig.visit(visitor))
    }

    /// The operating point with these values of its open numbers, in the order of their paths.
    pub fn operating_point<S: TableNumber>(&self, open: &[S]) -> DeclaredOperatingPoint<S> {
        self.operating_point.over(open, |point, visitor| operating_point::visit_as_table(point, visitor))
    }
}
