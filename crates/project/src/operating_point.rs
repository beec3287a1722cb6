//! Table `[operating_point]`: the operating point of the linear model; and its numbers if they are
//! uncertain.

use std::collections::BTreeMap;

use super::listing::Listing;
use super::{DeclaredActuator, OperatingRegion, Project, Uncertain, UncertaintyDirection};
use phea_dynamics::uncertain_plant::Spacing;
use phea_quantity::{FORCE, LENGTH, PRESSURE, RATIO, VELOCITY, VOLTAGE};
use phea_table::{Key, TableNumber, Visitor, key, plain};

/// Operating point of the linear model; absent parts are mid stroke and null.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredOperatingPoint<S = f64> {
    /// Position from the end of chamber A, m.
    pub position: Option<S>,
    /// Load pressure p_A - p_B, Pa.
    pub load_pressure: Option<S>,
    /// Load force A_A p_A - A_B p_B, N.
    pub load_force: Option<S>,
    /// Velocity towards the end of chamber B, m/s.
    pub velocity: Option<S>,
    /// Command, V.
    pub command: Option<S>,
    /// Side of null, from -1, the slopes of a spool that retracts the piston, to 1, of one that
    /// extends it.
    pub spool_side: Option<S>,
}

/// Beginning of the paths of its numbers.
const TABLE: &str = "operating_point";

impl<S: TableNumber> DeclaredOperatingPoint<S> {
    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("position", &LENGTH, "Position of the piston; absent: mid stroke.")
            .not_negative()
            .of_motion();
        v.optional(k, &mut self.position);
        let k = key(
            "load_pressure",
            &PRESSURE,
            "p_A - p_B; absent: zero with a command, else what the edges settle at.",
        );
        v.optional(k, &mut self.load_pressure);
        let k = key(
            "load_force",
            &FORCE,
            "Force that the pressures hold, A_A p_A - A_B p_B, friction left aside.",
        )
        .of_motion();
        v.optional(k, &mut self.load_force);
        let k = key("velocity", &VELOCITY, "Steady velocity of the piston and its load; absent: standstill.")
            .of_motion();
        v.optional(k, &mut self.velocity);
        v.optional(
            key(
                "command",
                &VOLTAGE,
                "Command of the valve; absent: null, or the command that holds the load.",
            ),
            &mut self.command,
        );
        v.optional(
            key(
                "spool_side",
                &RATIO,
                "Side of null from which the slopes of a spool at null are taken: 1 above, -1 below, 0 their mean; absent: the family has \
                 all from -1 to 1.",
            )
            .at_least(-1.0)
            .at_most(1.0),
            &mut self.spool_side,
        );
    }
}

/// Visits the table `[operating_point]` of a project.
pub(super) fn visit_as_table<S: TableNumber, V: Visitor<S>>(
    point: &mut DeclaredOperatingPoint<S>,
    v: &mut V,
) {
    v.needed_table(plain(TABLE, ""), point, DeclaredOperatingPoint::visit);
}

impl DeclaredOperatingPoint {
    /// Numbers that may be uncertain, by their names.
    pub(super) fn slot(&mut self, name: &str) -> Option<&mut Option<f64>> {
        match name {
            "position" => Some(&mut self.position),
            "load_pressure" => Some(&mut self.load_pressure),
            "load_force" => Some(&mut self.load_force),
            "velocity" => Some(&mut self.velocity),
            "spool_side" => Some(&mut self.spool_side),
            _ => None,
        }
    }

    /// Number at a path of the project.
    pub(super) fn at_path(&mut self, path: &str) -> Option<&mut Option<f64>> {
        self.slot(path.strip_prefix(TABLE)?.strip_prefix('.')?)
    }
}

/// Numbers of the operating point that may be uncertain, stated or not, by their paths.
pub(super) fn operating_numbers() -> BTreeMap<String, Key> {
    let mut listing = Listing::default();
    let number = Some(0.0);
    let mut all = Some(DeclaredOperatingPoint {
        position: number,
        load_pressure: number,
        load_force: number,
        velocity: number,
        command: None,
        spool_side: number,
    });
    listing.table(plain(TABLE, ""), &mut all, DeclaredOperatingPoint::visit);
    listing.numbers.into_iter().map(|(path, (key, _))| (path, key)).collect()
}

impl Project {
    /// Operating point, with the nominal values of uncertain numbers that are not declared.
    pub fn resolved_operating_point(&self) -> DeclaredOperatingPoint {
        let mut point = self.operating_point.clone();
        for uncertain in self.uncertain_numbers() {
            if let Some(number) = point.at_path(&uncertain.name) {
                *number = number.or(Some(uncertain.nominal));
            }
        }
        point
    }

    /// Numbers of `[uncertainty]`, then those of `[[uncertainty_direction]]`, then those of
    /// `[family.operating_region]`, before the pump limits them.
    ///
    /// # Example
    /// ```
    /// use phea_project::{STARTER, read};
    /// use phea_project::source::Memory;
    /// let text = format!("{STARTER}\n[family.operating_region]\nload_force = [\"-2 kN\", \"5 kN\"]\n");
    /// let project = read(&Memory::default().with("p.toml", text.as_str()), "p.toml", &[], &[])?.project;
    /// let force = project.uncertain_numbers().pop().filter(|last| last.name == "operating_point.load_force");
    /// assert_eq!(force.map(|one| (one.minimum, one.nominal, one.maximum)), Some((-2000.0, 0.0, 5000.0)));
    /// # Ok::<(), phea_project::Refusal>(())
    /// ```
    pub fn uncertain_numbers(&self) -> Vec<Uncertain> {
        let region = self.family.as_ref().and_then(|family| family.operating_region.as_ref());
        let of_region = region.into_iter().flat_map(|region| self.of_region(region));
        let directions = self.directions.iter().map(UncertaintyDirection::as_uncertain);
        self.uncertainty.iter().cloned().chain(directions).chain(of_region).collect()
    }

    /// Uncertain numbers of a region. The nominal value is the declared one; otherwise mid stroke,
    /// no force and standstill, or the nearest value in the region.
    fn of_region(&self, region: &OperatingRegion) -> Vec<Uncertain> {
        let stroke = self.actuator.as_ref().and_then(DeclaredActuator::stroke);
        let middle = stroke.map_or(0.0, |stroke| stroke / 2.0);
        let point = &self.operating_point;
        let numbers = [
            ("position", region.position, point.position, middle),
            ("load_force", region.load_force, point.load_force, 0.0),
            ("velocity", region.velocity, point.velocity, 0.0),
        ];
        let uncertain = |(name, range, declared, usual): (&str, Option<[f64; 2]>, Option<f64>, f64)| {
            let [minimum, maximum] = range?;
            let nearest = usual.max(minimum).min(maximum);
            Some(Uncertain {
                name: format!("{TABLE}.{name}"),
                nominal: declared.unwrap_or(nearest),
                minimum,
                maximum,
                points: region.points,
                spacing: Spacing::Linear,
            })
        };
        numbers.into_iter().filter_map(uncertain).collect()
    }
}
