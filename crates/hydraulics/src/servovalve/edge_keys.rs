//! Tables of one number for each edge.

use phea_quantity::{FLOW_COEFFICIENT, RATIO};
use phea_table::{TableNumber, Visitor, key};

use super::Edges;

impl<S: TableNumber> Edges<S> {
    /// Visits the shapes λ of the edges.
    pub fn visit_shapes<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("supply_to_a", &RATIO, "λ of edge 3, from supply to chamber A.").not_negative();
        v.quantity(k, &mut self.supply_to_a);
        let k = key("a_to_tank", &RATIO, "λ of edge 4, from chamber A to tank.").not_negative();
        v.quantity(k, &mut self.a_to_tank);
        let k = key("supply_to_b", &RATIO, "λ of edge 5, from supply to chamber B.").not_negative();
        v.quantity(k, &mut self.supply_to_b);
        let k = key("b_to_tank", &RATIO, "λ of edge 6, from chamber B to tank.").not_negative();
        v.quantity(k, &mut self.b_to_tank);
    }

    /// Visits the flow coefficients of the edges.
    pub fn visit_coefficients<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("supply_to_a", &FLOW_COEFFICIENT, "Edge 3, from supply to chamber A.").not_negative();
        v.quantity(k, &mut self.supply_to_a);
        let k = key("a_to_tank", &FLOW_COEFFICIENT, "Edge 4, from chamber A to tank.").not_negative();
        v.quantity(k, &mut self.a_to_tank);
        let k = key("supply_to_b", &FLOW_COEFFICIENT, "Edge 5, from supply to chamber B.").not_negative();
        v.quantity(k, &mut self.supply_to_b);
        let k = key("b_to_tank", &FLOW_COEFFICIENT, "Edge 6, from chamber B to tank.").not_negative();
        v.quantity(k, &mut self.b_to_tank);
    }
}
