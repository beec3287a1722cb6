//! Number known within bounds: `5`, or `{ nominal = 5, minimum = 4, maximum = 5 }`.

use phea_table::Key;
use phea_table::{ValueForm, Visitor};

/// Number known within bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundedNumber {
    /// Nominal value for the design.
    pub nominal: f64,
    /// Least possible value.
    pub minimum: f64,
    /// Greatest possible value.
    pub maximum: f64,
}

impl BoundedNumber {
    /// Number without spread.
    pub fn exactly(value: f64) -> Self {
        BoundedNumber { nominal: value, minimum: value, maximum: value }
    }

    fn is_exact(&self) -> bool {
        self.minimum == self.nominal && self.nominal == self.maximum
    }

    pub(crate) fn visit<V: Visitor>(v: &mut V, key: Key, field: &mut Option<BoundedNumber>) {
        let spread = field.is_some_and(|interval| !interval.is_exact());
        if v.form(key, if spread { ValueForm::Table } else { ValueForm::Number }) != ValueForm::Table {
            let mut number = field.map(|interval| interval.nominal);
            v.optional(key, &mut number);
            *field = number.map(BoundedNumber::exactly);
            return;
        }
        let part = |name, doc| Key { name, doc, default: None, ..key };
        v.table(key, field, |interval: &mut BoundedNumber, v: &mut V| {
            v.quantity(part("nominal", "The value to design with."), &mut interval.nominal);
            v.quantity(part("minimum", "The least it may be."), &mut interval.minimum);
            v.quantity(part("maximum", "The most it may be."), &mut interval.maximum);
        });
    }
}
