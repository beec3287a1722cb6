//! Gas at a chamber: what it contains, and what separates it from its chamber.

use phea_dynamics::scalar::Scalar;

use super::{Accumulator, AdjustedGas, GasBranch, GasValve, Neck, RelaxingGas};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::parameter::{ParameterError, Problems};

/// Accumulator at a chamber.
///
/// # Example
/// Gas behind a neck is as compliant at rest as gas at its chamber, but only then a branch:
/// ```
/// use phea_hydraulics::accumulator::{Accumulator, ChamberGas, GasContent, GasPassage, Neck, SealedGas};
/// let gas = Accumulator { gas_volume: 1e-5, precharge_pressure: 15e5, polytropic_exponent: 1.2 };
/// let neck = Neck::round([6e-3, 40e-3], [870.0, 46e-6, 1.45e9], 1.5);
/// let (content, passage) = (GasContent::Polytropic(gas), GasPassage::Neck(neck));
/// let behind = ChamberGas::Sealed(SealedGas { content, passage, maximum_pressure_ratio: None });
/// assert_eq!(behind.at_rest(), ChamberGas::from(gas).at_rest());
/// assert!(behind.branch(35e5).is_some() && ChamberGas::from(gas).branch(35e5).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChamberGas<S = f64> {
    /// Constant amount of gas.
    Sealed(SealedGas<S>),
    /// Gas that is added and removed in operation.
    Adjusted(AdjustedGas<S>),
}

/// Constant amount of gas, and its passage to the chamber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SealedGas<S = f64> {
    /// Gas.
    pub content: GasContent<S>,
    /// Passage between chamber and gas.
    pub passage: GasPassage<S>,
    /// Highest permitted pressure over the precharge, both absolute, if stated.
    pub maximum_pressure_ratio: Option<S>,
}

/// Gas by its law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GasContent<S = f64> {
    /// Polytropic gas.
    Polytropic(Accumulator<S>),
    /// Gas that exchanges heat with its wall.
    Relaxing(RelaxingGas<S>),
}

/// Passage between a chamber and its gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GasPassage<S = f64> {
    /// None: the gas has the pressure of its chamber.
    Open,
    /// Neck.
    Neck(Neck<S>),
    /// Valve that is adjusted in operation.
    Valve(GasValve<S>),
}

impl<S> From<Accumulator<S>> for ChamberGas<S> {
    /// Polytropic gas with the pressure of its chamber.
    fn from(gas: Accumulator<S>) -> ChamberGas<S> {
        let content = GasContent::Polytropic(gas);
        ChamberGas::Sealed(SealedGas { content, passage: GasPassage::Open, maximum_pressure_ratio: None })
    }
}

impl ChamberGas {
    /// Gas at this setting of its adjustment in slow motion; `None` behind a shut valve.
    pub fn at_setting(&self, setting: f64) -> Option<SealedGas> {
        match self {
            ChamberGas::Adjusted(gas) => {
                let at_rest = gas.moved(setting - gas.setting, 0.0).gas;
                Some(ChamberGas::Adjusted(AdjustedGas { at_rest, ..*gas }).sealed())
            }
            gas => (gas.valve().is_none() || setting != 0.0).then(|| gas.sealed()),
        }
    }

    /// Impossible parameters of this gas; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        if let Some(ratio) = self.maximum_pressure_ratio() {
            problems.key(super::keys::MAXIMUM_PRESSURE_RATIO_KEY, ratio);
        }
        match self {
            ChamberGas::Adjusted(gas) => problems.all(gas.problems()),
            ChamberGas::Sealed(SealedGas { content, passage, .. }) => {
                problems.all(match content {
                    GasContent::Polytropic(gas) => gas.problems(),
                    GasContent::Relaxing(gas) => gas.problems(),
                });
                problems.all(match passage {
                    GasPassage::Open => Vec::new(),
                    GasPassage::Neck(neck) => neck.problems(),
                    GasPassage::Valve(valve) => valve.problems(),
                });
            }
        }
        problems.into_vec()
    }
}

phea_dynamics::parameters! { ChamberGas = ChamberGas::Sealed(gas) | ChamberGas::Adjusted(gas) }
phea_dynamics::parameters! { SealedGas { content, passage, maximum_pressure_ratio } }
phea_dynamics::parameters! { GasContent = GasContent::Polytropic(gas) | GasContent::Relaxing(gas) }
phea_dynamics::parameters! {
    GasPassage = GasPassage::Open | GasPassage::Neck(neck) | GasPassage::Valve(valve)
}

impl<S> ChamberGas<S> {
    /// Neck between chamber and gas.
    pub fn neck(&self) -> Option<&Neck<S>> {
        match self {
            ChamberGas::Adjusted(gas) => gas.neck.as_ref(),
            ChamberGas::Sealed(SealedGas { passage: GasPassage::Neck(neck), .. }) => Some(neck),
            ChamberGas::Sealed(_) => None,
        }
    }

    /// Valve between chamber and gas.
    pub fn valve(&self) -> Option<&GasValve<S>> {
        match self {
            ChamberGas::Sealed(SealedGas { passage: GasPassage::Valve(valve), .. }) => Some(valve),
            ChamberGas::Sealed(_) | ChamberGas::Adjusted(_) => None,
        }
    }

    /// Gas that is added and removed.
    pub fn adjusted(&self) -> Option<&AdjustedGas<S>> {
        match self {
            ChamberGas::Adjusted(gas) => Some(gas),
            ChamberGas::Sealed(_) => None,
        }
    }

    /// Gas that exchanges heat.
    pub fn relaxing(&self) -> Option<&RelaxingGas<S>> {
        match self {
            ChamberGas::Sealed(SealedGas { content: GasContent::Relaxing(gas), .. }) => Some(gas),
            ChamberGas::Sealed(_) | ChamberGas::Adjusted(_) => None,
        }
    }
}

impl<S: Copy> ChamberGas<S> {
    /// Highest permitted pressure over the precharge, both absolute, if stated.
    pub fn maximum_pressure_ratio(&self) -> Option<S> {
        match self {
            ChamberGas::Adjusted(gas) => gas.maximum_pressure_ratio,
            ChamberGas::Sealed(gas) => gas.maximum_pressure_ratio,
        }
    }
}

impl<S: Scalar> ChamberGas<S> {
    /// Highest permitted pressure at rest, Pa gauge; `None` without one.
    ///
    /// ```text
    /// P_2 = (p_2/p_0) P_0,     absolute, P_0 at the working temperature and the setting at rest
    /// ```
    pub(crate) fn pressure_limit(&self) -> Option<S> {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let at_rest = self.at_rest().precharge_pressure;
        Some(self.maximum_pressure_ratio()? * (at_rest + atmosphere) - atmosphere)
    }

    /// Gas within a machine: sealed if its setting does not move. A valve that is shut at rest is
    /// known from its setting.
    pub(crate) fn of_machine(self, moves: bool) -> ChamberGas<S> {
        match self {
            ChamberGas::Sealed(gas @ SealedGas { passage: GasPassage::Valve(valve), .. }) => {
                let passage = GasPassage::Valve(GasValve { shut: false, ..valve });
                ChamberGas::Sealed(SealedGas { passage, ..gas })
            }
            ChamberGas::Adjusted(_) if !moves => ChamberGas::Sealed(self.sealed()),
            gas => gas,
        }
    }

    /// Gas at rest, without its adjustment: a valve is a passage.
    #[must_use]
    pub fn sealed(&self) -> SealedGas<S> {
        match *self {
            ChamberGas::Sealed(gas @ SealedGas { passage: GasPassage::Valve(_), .. }) => {
                SealedGas { passage: GasPassage::Open, ..gas }
            }
            ChamberGas::Sealed(gas) => gas,
            ChamberGas::Adjusted(AdjustedGas { at_rest, neck, maximum_pressure_ratio, .. }) => {
                let passage = neck.map_or(GasPassage::Open, GasPassage::Neck);
                SealedGas { content: GasContent::Polytropic(at_rest), passage, maximum_pressure_ratio }
            }
        }
    }

    /// Gas at rest and in slow motion.
    pub fn at_rest(&self) -> Accumulator<S> {
        match self {
            ChamberGas::Adjusted(gas) => gas.at_rest,
            ChamberGas::Sealed(SealedGas { content: GasContent::Polytropic(gas), .. }) => *gas,
            ChamberGas::Sealed(SealedGas { content: GasContent::Relaxing(gas), .. }) => gas.isothermal(),
        }
    }

    /// Setting at rest, from 0 to 1; `None` without an adjustment.
    pub fn setting(&self) -> Option<S> {
        self.valve().map(|valve| valve.setting).or(self.adjusted().map(|gas| gas.setting))
    }

    /// True if the gas is behind a neck or a valve or exchanges heat.
    pub(crate) fn is_branch(&self) -> bool {
        self.neck().is_some() || self.valve().is_some() || self.relaxing().is_some()
    }

    /// Branch of gas behind a neck or a valve or with heat exchange, at a chamber pressure in Pa;
    /// `None` for other gas.
    pub fn branch(&self, pressure: S) -> Option<GasBranch<S>> {
        let later = self.relaxing().map(|gas| gas.relaxation(pressure));
        let branch = GasBranch::of(self.at_rest().compliance(pressure), later, self.neck());
        let branch = match self.valve() {
            Some(valve) => branch.through_valve(valve.conductance(), valve.compliance),
            None => branch,
        };
        self.is_branch().then_some(branch)
    }

    /// Compliance of the oil between chamber and gas: in a neck, or behind a valve, m3/Pa.
    pub(crate) fn oil_before(&self) -> S {
        let neck = self.neck().map(|neck| neck.compliance);
        neck.or(self.valve().map(|valve| valve.compliance)).unwrap_or(S::from(0.0))
    }
}
