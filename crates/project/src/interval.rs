//! Number known within bounds: `5`, or `{ nominal = 5, minimum = 4, maximum = 5 }`.

use phea_table::Key;
use phea_table::{TableNumber, ValueForm, Visitor};

/// Number known within bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundedNumber<S = f64> {
    /// Nominal value for the design.
    pub nominal: S,
    /// Least possible value.
    pub minimum: S,
    /// Greatest possible value.
    pub maximum: S,
}

impl<S: TableNumber> BoundedNumber<S> {
    /// Number without spread.
    pub fn exactly(value: S) -> Self {
        BoundedNumber { nominal: value, minimum: value, maximum: value }
    }

    fn is_exact(&self) -> bool {
        self.minimum == self.nominal && self.nominal == self.maximum
    }
}

impl<S: TableNumber> BoundedNumber<S> {
    pub(crate) fn visit<V: Visitor<S>>(v: &mut V, key: Key, field: &mut Option<BoundedNumber<S>>) {
        let spread = field.is_some_and(|interval| !interval.is_exact());
        if v.form(key, if spread { ValueForm::Table } else { ValueForm::Number }) != ValueForm::Table {
            let mut number = field.map(|interval| interval.nominal);
            v.optional(key, &mut number);
            *field = number.map(BoundedNumber::exactly);
            return;
        }
        let part = |name, doc| Key { name, doc, default: None, ..key };
        v.table(key, field, |interval: &mut BoundedNumber<S>, v: &mut V| {
            v.quantity(part("nominal", "The value to design with."), &mut interval.nominal);
            v.quantity(part("minimum", "The least it may be."), &mut interval.minimum);
            v.quantity(part("maximum", "The most it may be."), &mut interval.maximum);
        });
    }
}
