//! Table `[family]`: the examined plants of the box, or measured plants.

use super::Uncertain;
use phea_quantity::{FORCE, LENGTH, RATIO, VELOCITY};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Members of the family. By default the grid of `[uncertainty]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredFamily {
    /// True for the grid, in addition to the other members.
    pub grid: bool,
    /// True for all corners of the box.
    pub vertices: bool,
    /// Random points of the box.
    pub random: Option<Random>,
    /// Plants by their parameters: name and value, in file order.
    pub cases: Vec<Case>,
    /// Groups of parameters that are fully correlated.
    pub correlation: Vec<Correlation>,
    /// Operating points of the rig, limited by the flow of the pump.
    pub operating_region: Option<OperatingRegion>,
    /// Ranges of the linear model that region and directions replace, only for comparison.
    pub replaces: Vec<Uncertain>,
    /// Files with measured frequency responses, the nominal plant first; paths are relative to the
    /// project file.
    pub measured: Vec<String>,
    /// Open-loop poles of each measured plant in the right half plane.
    pub unstable_poles: u32,
    /// Poles less zeros of each measured plant at the origin; if absent, derived from its slope.
    pub integrators: Option<u32>,
}

/// Ranges of the operating point: the plants are correlated through the resulting pressures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OperatingRegion {
    /// Piston position, m.
    pub position: Option<[f64; 2]>,
    /// Force held by the pressures, N.
    pub load_force: Option<[f64; 2]>,
    /// Velocity, m/s; limited to what the pump can supply.
    pub velocity: Option<[f64; 2]>,
    /// Points of the grid over each range.
    pub points: u32,
}

/// Random points of the box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Random {
    /// Number of points.
    pub count: u32,
    /// Seed.
    pub seed: u32,
}

/// Parameters that are fully correlated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Correlation {
    /// Names of uncertain parameters.
    pub parameters: Vec<String>,
    /// Parameters among them that fall while the others rise.
    pub opposed: Vec<String>,
}

/// Plant of an explicit family.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Name and value, SI.
    pub parameters: Vec<(String, f64)>,
}

impl DeclaredFamily {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.flag(plain("grid", "The grid of [uncertainty], in addition to other members."), &mut self.grid);
        v.flag(plain("vertices", "All corners of the box."), &mut self.vertices);
        v.table(plain("random", "Points of the box drawn at random."), &mut self.random, Random::visit);
        v.tables(plain("cases", "Plants by their parameters."), &mut self.cases, Case::visit);
        let k = plain("correlation", "Groups of parameters that are fully correlated.");
        v.tables(k, &mut self.correlation, Correlation::visit);
        let k = plain("operating_region", "The operating points that the rig visits.");
        v.table(k, &mut self.operating_region, OperatingRegion::visit);
        let k = plain("replaces", "Ranges that the region and the directions replace, to compare with them.");
        Uncertain::visit_all(k, &mut self.replaces, v);
        let k = plain("measured", "Files with measured frequency responses, the nominal plant first.");
        v.texts(k, &mut self.measured);
        let doc = "Open-loop poles of each measured plant in the right half plane.";
        v.count(
            key("unstable_poles", &RATIO, doc).not_negative().at_most(1000.0).or(0.0),
            &mut self.unstable_poles,
        );
        let doc = "Integrators of each measured plant; absent: what the slope of its response shows.";
        let k = key("integrators", &RATIO, doc).not_negative().at_most(1000.0);
        v.optional_count(k, &mut self.integrators);
    }
}

impl OperatingRegion {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k =
            key("position", &LENGTH, "Least and greatest position of the piston.").of_motion().not_negative();
        v.pair(k, &mut self.position);
        v.pair(
            key("load_force", &FORCE, "Least and greatest force that the pressures hold.").of_motion(),
            &mut self.load_force,
        );
        let k = key("velocity", &VELOCITY, "Least and greatest velocity, before `supply.flow` limits them.")
            .of_motion();
        v.pair(k, &mut self.velocity);
        let k = key("points", &RATIO, "Points of the grid over each of them.").at_least(2.0).at_most(1000.0);
        v.count(k.or(3.0), &mut self.points);
    }
}

impl Random {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.count(key("count", &RATIO, "How many points.").at_least(1.0).at_most(1e6), &mut self.count);
        v.count(key("seed", &RATIO, "What the draw begins with.").not_negative(), &mut self.seed);
    }
}

impl Correlation {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.texts(plain("parameters", "Names of uncertain parameters."), &mut self.parameters);
        v.texts(plain("opposed", "Those of them that fall while the others rise."), &mut self.opposed);
    }
}

impl Case {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("parameter", &RATIO, "Value of an uncertain parameter.");
        v.numbers(k, |number| number, &mut self.parameters);
    }
}
