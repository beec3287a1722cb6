//! Checks of the friction of a cylinder or a motor.

use phea_dynamics::portable;
use phea_quantity::{self as quantity, DAMPING};
use phea_table::TableCheck;

use super::keys::DeclaredFriction;
use super::{Friction, FrictionLevels, LuGre};

impl DeclaredFriction {
    /// Checks the levels of each direction, in the table at `path`.
    pub fn check(&self, path: &str, check: &mut dyn TableCheck) {
        let Some(curve) = self.law.curve() else {
            if self.retracting.is_some() {
                let message = "viscous friction alone is the same both ways: choose `model = \"stribeck\"` or `\"lugre\"`, or remove `retracting`";
                check.error(&format!("{path}.retracting"), message);
            }
            return;
        };
        if !check.declared(&format!("{path}.static")) || !check.declared(&format!("{path}.coulomb")) {
            return;
        }
        let extending = curve.extending();
        self.check_levels((path, path), extending, check);
        if let Some(back) = self.retracting {
            self.check_levels((&format!("{path}.retracting"), path), back.levels(extending), check);
        }
    }

    /// Checks the levels of one direction, with keys in the first table if they are there,
    /// otherwise in the second.
    fn check_levels(&self, (own, other): (&str, &str), levels: FrictionLevels, check: &mut dyn TableCheck) {
        let FrictionLevels { coulomb, static_friction, viscous } = levels;
        let at = |key: &str, check: &dyn TableCheck| {
            check.written_path(format!("{own}.{key}"), &format!("{other}.{key}"))
        };
        if levels.is_reversed() {
            let [lower, upper] = ["coulomb", "static"].map(|key| at(key, check));
            return check.in_order([&lower, &upper], [coulomb, static_friction]);
        }
        let Friction::LuGre(LuGre { bristle_damping, .. }) = self.law else { return };
        let least = levels.passive_viscous(bristle_damping);
        if viscous < least {
            let unit = check.motion().dimension(&DAMPING).si;
            let least = rounded_up(least);
            let message = format!(
                "this LuGre friction can give out energy: it is passive for `viscous` of at least {least} {unit} \
                 (bristle_damping (static - coulomb)/coulomb; Barabanov and Ortega, 2000)"
            );
            check.warning(&at("viscous", check), message);
        }
    }
}

/// Next higher number with three significant digits.
fn rounded_up(value: f64) -> String {
    let place = portable::pow(10.0, portable::log10(value).floor() - 2.0);
    quantity::significant((value / place).ceil() * place, 3)
}
