//! Costs and masses of parts: `price` and `mass` in the declaration of a part, for a line also per
//! length.

use crate::{TableNumber, Visitor, key, plain};
use phea_quantity::{MASS, MASS_PER_LENGTH, Price, PricedBy};

/// Stated cost and mass of a part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartCost<S = f64> {
    /// Price of the part.
    pub price: Option<Price>,
    /// Mass of the part, kg.
    pub mass: Option<S>,
}

/// Cost and mass of a hose or a pipe: of both its ends, and per metre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineCost<S = f64> {
    /// Cost and mass of the ends of one line, in addition to those of its length.
    pub ends: PartCost<S>,
    /// Price of a metre.
    pub price_per_length: Option<Price>,
    /// Mass per length without the oil, kg/m.
    pub mass_per_length: Option<S>,
}

impl<S: TableNumber> PartCost<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.price(plain("price", "What the part costs."), PricedBy::Piece, &mut self.price);
        v.optional(key("mass", &MASS, "Mass of the part.").not_negative(), &mut self.mass);
    }
}

impl<S: TableNumber> LineCost<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("price", "Of one line, in addition to `price_per_length`: its fittings, or all of it.");
        v.price(k, PricedBy::Piece, &mut self.ends.price);
        let k = plain("price_per_length", "Of a metre of it.");
        v.price(k, PricedBy::Length, &mut self.price_per_length);
        let k =
            key("mass", &MASS, "Of one line, in addition to `mass_per_length`: its fittings, or all of it.");
        v.optional(k.not_negative(), &mut self.ends.mass);
        let k = key("mass_per_length", &MASS_PER_LENGTH, "Mass of a metre of it, without oil.");
        v.optional(k.not_negative(), &mut self.mass_per_length);
    }
}
