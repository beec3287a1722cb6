//! Key `misfit` of the valve, of its lines and of the friction: the residual of recordings with the
//! identified numbers.

use crate::{TableNumber, Visitor, key, plain};
use phea_quantity::{RATIO, significant};

/// Greatest misfit of the numbers of a part that were identified from recordings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredMisfit<S = f64> {
    /// Root mean square over the range of the signal.
    pub fraction: S,
    /// Signal and recording, and the location in it.
    pub at: Option<String>,
}

impl DeclaredMisfit {
    /// Value of the key `misfit`.
    ///
    /// # Example
    /// ```
    /// use phea_table::DeclaredMisfit;
    /// let misfit = DeclaredMisfit { fraction: 0.0123, at: Some("force of \"a\".csv".to_string()) };
    /// assert_eq!(misfit.in_toml(), "{ share = 0.0123, at = \"force of /a/.csv\" }");
    /// ```
    pub fn in_toml(&self) -> String {
        format!("{{ {} }}", self.entries().join(", "))
    }

    /// Entries of its own keys with their values.
    pub fn entries(&self) -> Vec<String> {
        let at = self.at.iter().map(|at| format!("at = \"{}\"", at.replace(['"', '\\'], "/")));
        [format!("share = {}", significant(self.fraction, 3))].into_iter().chain(at).collect()
    }
}

impl<S: TableNumber> DeclaredMisfit<S> {
    /// Visits the key `misfit` of a part.
    pub fn visit<V: Visitor<S>>(misfit: &mut Option<DeclaredMisfit<S>>, v: &mut V) {
        let k = plain("misfit", "What these numbers leave unexplained of recordings, as identified.");
        v.table(k, misfit, |misfit, v| {
            let k = key("share", &RATIO, "Root mean square of the misfit, over the range of the signal.");
            v.quantity(k.not_negative(), &mut misfit.fraction);
            v.text(plain("at", "Which signal of which recording, and where."), &mut misfit.at, false);
        });
    }
}
