//! Table `[line.accumulator.adjustment]`: an accumulator that is adjusted in operation.

use crate::cross_port::DeclaredOrifice;
use phea_dynamics::scalar::Scalar;
use phea_quantity::{PRESSURE, RATIO, VOLUME};
use phea_table::{Key, TableNumber, Variants, Visitor, key, plain};

pub(super) const SETTING_KEY: Key =
    key("setting", &RATIO, "Its value at rest, from 0, as declared or shut, to 1.")
        .at_least(0.0)
        .at_most(1.0)
        .or(0.0);

/// Adjusted part of an accumulator, with a setting from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredAdjustment<S = f64> {
    /// Part that the setting moves.
    pub kind: AdjustmentKind<S>,
    /// Value at rest; absent if zero.
    pub setting: Option<S>,
}

/// Part that a setting moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AdjustmentKind<S = f64> {
    /// Gas that is added and removed: the declared accumulator is that at setting 0.
    Gas(GasAtOne<S>),
    /// Valve between chamber and gas: shut at setting 0.
    Valve(DeclaredGasValve<S>),
}

/// Gas at setting 1, if different from setting 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GasAtOne<S = f64> {
    /// Gas volume at its precharge, m³.
    pub gas_volume: Option<S>,
    /// Precharge pressure, Pa gauge.
    pub precharge_pressure: Option<S>,
}

/// Valve between chamber and gas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredGasValve<S = f64> {
    /// Orifice of the fully open valve.
    pub orifice: DeclaredOrifice<S>,
    /// Volume of the oil between valve and gas, m³; if absent, a hundredth of the gas volume.
    pub dead_volume: Option<S>,
}

/// Default ratio of the oil volume between valve and gas to the gas volume.
const DEAD_FRACTION: f64 = 0.01;

impl<S: Default> Default for AdjustmentKind<S> {
    fn default() -> Self {
        AdjustmentKind::Gas(GasAtOne::default())
    }
}

impl<S: TableNumber> Variants<S> for AdjustmentKind<S> {
    const STRICT: bool = true;

    fn all(&self) -> Vec<AdjustmentKind<S>> {
        vec![AdjustmentKind::default(), AdjustmentKind::Valve(DeclaredGasValve::default())]
    }

    fn word(&self) -> &'static str {
        match self {
            AdjustmentKind::Gas(_) => "gas",
            AdjustmentKind::Valve(_) => "valve",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            AdjustmentKind::Gas(gas) => {
                let k = key("gas_volume", &VOLUME, "At setting 1; absent: that of the accumulator.");
                v.optional(k.positive(), &mut gas.gas_volume);
                let k =
                    key("precharge_pressure", &PRESSURE, "At setting 1; absent: that of the accumulator.");
                v.optional(k.positive(), &mut gas.precharge_pressure);
                if *gas == GasAtOne::default() {
                    let what = "`gas_volume` or `precharge_pressure`, which the setting moves,";
                    v.lacks(&[&["gas_volume"], &["precharge_pressure"]], what);
                }
            }
            AdjustmentKind::Valve(valve) => {
                valve.orifice.visit(v);
                let doc = "Oil between valve and gas; absent: a hundredth of the gas volume.";
                v.optional(key("dead_volume", &VOLUME, doc).positive(), &mut valve.dead_volume);
            }
        }
    }
}

impl DeclaredAdjustment {
    /// Valve of the adjustment, if it has one.
    pub fn valve(&self) -> Option<&DeclaredGasValve> {
        match &self.kind {
            AdjustmentKind::Valve(valve) => Some(valve),
            AdjustmentKind::Gas(_) => None,
        }
    }
}

impl<S: TableNumber> DeclaredAdjustment<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("kind", "What the setting moves."), &mut self.kind, true);
        v.unless_zero(SETTING_KEY, &mut self.setting);
    }
}

impl<S: Scalar> DeclaredGasValve<S> {
    /// Volume of the oil between the valve and this gas, m³.
    pub fn dead_volume(&self, gas_volume: S) -> S {
        self.dead_volume.unwrap_or_else(|| S::from(DEAD_FRACTION) * gas_volume)
    }
}
