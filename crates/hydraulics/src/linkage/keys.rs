//! Table `[linkage]`: a linkage between the rod and a load that turns about a joint.

use crate::linkage::{
    FourBar, LinkageError, LinkageGeometry, LinkageTable, PivotTriangle, ReducedLinkage, STANDARD_GRAVITY,
};
use phea_quantity::{ANGLE, LENGTH, MASS};
use phea_table::{TableNumber, Variants, Visitor, key, plain};

/// Linkage: the angle of the joint grows while the rod extends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredLinkage<S = f64> {
    /// Kind of linkage.
    pub kind: LinkageKind<S>,
    /// Weight of the load; if absent, gravity exerts no torque.
    pub weight: Option<DeclaredWeight<S>>,
}

/// Weight of a load that turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredWeight<S = f64> {
    /// Mass of all parts that turn with the joint, kg.
    pub mass: S,
    /// Distance from the joint to the centre of mass, m.
    pub centre_distance: S,
    /// Angle of the joint at which the centre is level with it and rises, rad.
    pub level_angle: S,
}

/// Kinds of linkages.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkageKind<S = f64> {
    /// Cylinder between two pivots on either side of the joint.
    Triangle(CylinderTriangle<S>),
    /// Cylinder that turns the input link of a four-bar linkage.
    FourBar {
        /// Triangle about the joint of the input link.
        triangle: CylinderTriangle<S>,
        /// Fixed, input and output link, and coupler.
        links: DeclaredLinks<S>,
    },
    /// Measured table.
    Table {
        /// Positions of the piston, m.
        extensions: Vec<S>,
        /// Angles of the joint, rad.
        angles: Vec<S>,
        /// Largest distance of the polynomial from a row, m.
        tolerance: S,
    },
}

/// Triangle of a joint and both pivots of a cylinder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderTriangle<S = f64> {
    /// Distance from the joint to the pivot of the cylinder's body, m.
    pub cylinder_pivot: S,
    /// Distance from the joint to the pivot of the rod, m.
    pub rod_pivot: S,
    /// Distance from pivot to pivot at position zero, m.
    pub retracted_length: S,
    /// Difference between the angle of the geometry and that of the joint, rad.
    pub angle_offset: S,
}

/// Links of a four-bar linkage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredLinks<S = f64> {
    /// Lead of the input link over the triangle's angle, rad.
    pub input_angle: S,
    /// Distance from joint to joint, m.
    pub fixed_link: S,
    /// Length of the input link, m.
    pub input_link: S,
    /// Length of the coupler, m.
    pub coupler: S,
    /// Length of the output link, with which the load turns, m.
    pub output_link: S,
    /// Assembly of the links.
    pub branch: FourBarBranch,
}

/// Assemblies of a coupler with two links.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FourBarBranch {
    /// Coupler and fixed link do not cross.
    #[default]
    Open,
    /// Coupler and fixed link cross.
    Crossed,
}

/// Default tolerance, m.
const TOLERANCE: f64 = 1e-4;

impl<S: Default> Default for LinkageKind<S> {
    fn default() -> Self {
        LinkageKind::Triangle(CylinderTriangle::default())
    }
}

impl DeclaredLinkage {
    /// Reduced form for the equations, over a stroke in m.
    ///
    /// # Errors
    /// Linkage that does not close over the stroke, reaches a dead point in it, or is too rough.
    pub fn reduced(&self, stroke: f64) -> Result<ReducedLinkage, LinkageError> {
        let (geometry, angle_offset) = match &self.kind {
            LinkageKind::Triangle(triangle) => {
                (LinkageGeometry::Triangle(triangle.geometry()), triangle.angle_offset)
            }
            LinkageKind::FourBar { triangle, links } => {
                let four_bar = FourBar {
                    triangle: triangle.geometry(),
                    input_angle: links.input_angle,
                    fixed_link: links.fixed_link,
                    input_link: links.input_link,
                    coupler: links.coupler,
                    output_link: links.output_link,
                    crossed: links.branch == FourBarBranch::Crossed,
                };
                (LinkageGeometry::FourBar(four_bar), triangle.angle_offset)
            }
            LinkageKind::Table { extensions, angles, tolerance } => {
                let table = LinkageTable {
                    extensions: extensions.clone(),
                    angles: angles.clone(),
                    tolerance: *tolerance,
                };
                (LinkageGeometry::Table(table), 0.0)
            }
        };
        let reduced = geometry.reduced(stroke, angle_offset)?;
        let linkage = match self.weight {
            None => reduced.linkage,
            Some(weight) => reduced.linkage.level_at(weight.level_angle).with_moment(weight.moment()),
        };
        Ok(ReducedLinkage { linkage, ..reduced })
    }
}

impl<S: TableNumber> DeclaredLinkage<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("kind", "What the linkage is made of."), &mut self.kind, true);
        let k = plain("weight", "The weight of the load, which gravity turns about the joint; absent: none.");
        v.table(k, &mut self.weight, DeclaredWeight::visit);
    }
}

impl DeclaredWeight {
    /// Moment of gravity when the centre is level with the joint, N m.
    pub fn moment(&self) -> f64 {
        self.mass * self.centre_distance * STANDARD_GRAVITY
    }
}

impl<S: TableNumber> DeclaredWeight<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("mass", &MASS, "Mass of all that turns with the joint.").not_negative();
        v.quantity(k, &mut self.mass);
        let k = key("centre_distance", &LENGTH, "From the joint to the centre of that mass.");
        v.quantity(k.not_negative(), &mut self.centre_distance);
        let doc =
            "Angle of the joint at which the centre of mass is level with it and rises as the rod extends.";
        v.quantity(key("level_angle", &ANGLE, doc), &mut self.level_angle);
    }
}

impl CylinderTriangle {
    fn geometry(&self) -> PivotTriangle {
        PivotTriangle {
            cylinder_pivot: self.cylinder_pivot,
            rod_pivot: self.rod_pivot,
            retracted_length: self.retracted_length,
        }
    }
}

impl<S: TableNumber> CylinderTriangle<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("cylinder_pivot", &LENGTH, "From the joint to the pivot of the cylinder's body.");
        v.quantity(k.positive(), &mut self.cylinder_pivot);
        let k = key("rod_pivot", &LENGTH, "From the joint to the pivot of the rod.");
        v.quantity(k.positive(), &mut self.rod_pivot);
        let k = key("retracted_length", &LENGTH, "From pivot to pivot at position zero.").positive();
        v.quantity(k, &mut self.retracted_length);
        let doc = "What the angle of the joint is less than that of the geometry; it shifts its zero.";
        v.quantity(key("angle_offset", &ANGLE, doc).or(0.0), &mut self.angle_offset);
    }
}

impl<S: TableNumber> DeclaredLinks<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let doc =
            "By which the input link, seen from the fixed link, is ahead of the angle between both pivots.";
        v.quantity(key("input_angle", &ANGLE, doc).or(0.0), &mut self.input_angle);
        let k = key("fixed_link", &LENGTH, "From the joint of the input link to that of the output link.");
        v.quantity(k.positive(), &mut self.fixed_link);
        let k = key("input_link", &LENGTH, "Of the link that the cylinder turns.").positive();
        v.quantity(k, &mut self.input_link);
        v.quantity(key("coupler", &LENGTH, "From link to link.").positive(), &mut self.coupler);
        let k = key("output_link", &LENGTH, "Of the link that turns with the load.").positive();
        v.quantity(k, &mut self.output_link);
        let words = &[("open", FourBarBranch::Open), ("crossed", FourBarBranch::Crossed)];
        let k = plain("branch", "Whether coupler and fixed link cross.");
        v.choice(k, words, &mut self.branch, false);
    }
}

impl<S: TableNumber> Variants<S> for LinkageKind<S> {
    const STRICT: bool = true;

    fn all(&self) -> Vec<LinkageKind<S>> {
        vec![
            LinkageKind::default(),
            LinkageKind::FourBar { triangle: CylinderTriangle::default(), links: DeclaredLinks::default() },
            LinkageKind::Table { extensions: Vec::new(), angles: Vec::new(), tolerance: S::from(TOLERANCE) },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            LinkageKind::Triangle(_) => "triangle",
            LinkageKind::FourBar { .. } => "four_bar",
            LinkageKind::Table { .. } => "table",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            LinkageKind::Triangle(triangle) => triangle.visit(v),
            LinkageKind::FourBar { triangle, links } => {
                triangle.visit(v);
                links.visit(v);
            }
            LinkageKind::Table { extensions, angles, tolerance } => {
                let k = key("extensions", &LENGTH, "Positions of the piston, from 0 to the stroke.");
                v.quantities(k, extensions, true);
                v.quantities(key("angles", &ANGLE, "Of the joint at each, increasing."), angles, true);
                let doc = "How far the polynomial through the table may be from a row.";
                v.quantity(key("tolerance", &LENGTH, doc).positive().or(TOLERANCE), tolerance);
            }
        }
    }
}
