//! Queue of the structures to be searched.

use std::collections::VecDeque;

use super::NamedStructure;
use super::attempt::SearchEffort;
use super::candidates::Ground;
use super::named::{is_named, named_structure};
use super::problem::{ControllerChoice, DesignOptions};
use crate::loop_shaping::{DesignProblem, Structure};

/// Largest number of free numbers of a structure that is searched with few starts.
const FEW_NUMBERS: usize = 4;
/// Number of poles by which a longer structure may exceed one that meets the limits.
const FURTHER_POLES: usize = 2;

/// A structure in the queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum QueuedStructure {
    /// The given structure.
    Given,
    /// A named structure.
    Named(NamedStructure),
    /// A structure of growing order.
    Free { order: usize, zeros: usize },
}

impl QueuedStructure {
    /// The structure itself.
    pub(super) fn structure(self, choice: &ControllerChoice, ground: &Ground) -> Structure {
        match (self, choice) {
            (QueuedStructure::Given, ControllerChoice::Given(structure)) => structure.clone(),
            (QueuedStructure::Given, _) => ground.structure(0, 0),
            (QueuedStructure::Named(name), _) => named_structure(name, ground),
            (QueuedStructure::Free { order, zeros }, _) => ground.structure(order, zeros),
        }
    }

    pub(super) fn name(self) -> Option<NamedStructure> {
        match self {
            QueuedStructure::Named(name) => Some(name),
            QueuedStructure::Given | QueuedStructure::Free { .. } => None,
        }
    }

    /// Width of the search in a problem that may be hard, for a structure that may have to reach
    /// this many dB to be of interest.
    pub(super) fn effort(
        self,
        structure: &Structure,
        (is_hard, to_be_reached_db): (bool, Option<f64>),
    ) -> SearchEffort {
        match self {
            _ if is_hard => SearchEffort::Great,
            _ if to_be_reached_db.is_some() => SearchEffort::Least,
            QueuedStructure::Named(_) if structure.dimension() <= FEW_NUMBERS => SearchEffort::Small,
            _ => SearchEffort::Usual,
        }
    }
}

/// The structures in the order in which they are searched.
pub(super) fn structures_to_search(
    problem: &DesignProblem,
    options: &DesignOptions,
    ground: &Ground,
    is_hard: bool,
) -> VecDeque<QueuedStructure> {
    let sampled = problem.timing.sample_time_s.is_some();
    let times = if is_hard { 2 } else { 1 };
    let each: Vec<QueuedStructure> = match options.controller {
        ControllerChoice::Given(_) => vec![QueuedStructure::Given],
        ControllerChoice::Named { name, .. } => vec![QueuedStructure::Named(name)],
        ControllerChoice::Grow { maximum_order } => growing(maximum_order, ground, sampled).collect(),
        ControllerChoice::Any { maximum_order, from, with_pure_gain, .. } => {
            let is_shorter = |name: &NamedStructure| from.is_some_and(|from| *name != from);
            let named = named(maximum_order, ground, with_pure_gain);
            let named = named.skip_while(is_shorter).map(QueuedStructure::Named);
            let is_new = |one: &QueuedStructure| match *one {
                QueuedStructure::Free { order, zeros } => !is_named(order, zeros, ground.integrators),
                QueuedStructure::Given | QueuedStructure::Named(_) => true,
            };
            named.chain(growing(maximum_order, ground, sampled).filter(is_new)).collect()
        }
    };
    match options.controller {
        ControllerChoice::Given(_) => VecDeque::from(each),
        _ => each.into_iter().flat_map(|one| std::iter::repeat_n(one, times)).collect(),
    }
}

/// The named structures that suit the problem: a pure gain if the specifications require no
/// integrator, those with an integrator if they do, after a pure gain if that is also included.
fn named(
    maximum_order: usize,
    ground: &Ground,
    with_pure_gain: bool,
) -> impl Iterator<Item = NamedStructure> + use<> {
    let integrators = ground.integrators;
    NamedStructure::ALL.into_iter().filter(move |name| {
        let is_gain = *name == NamedStructure::Proportional;
        let suits = usize::from(!is_gain) == integrators || is_gain && with_pure_gain;
        suits && name.order() <= maximum_order
    })
}

/// Named structures after one that meets the limits, with at least as many poles, which may be
/// worth them.
pub(super) fn longer(
    name: NamedStructure,
    choice: &ControllerChoice,
    ground: &Ground,
) -> VecDeque<QueuedStructure> {
    let ControllerChoice::Any { maximum_order, earned_per_pole_db, with_pure_gain, .. } = *choice else {
        return VecDeque::new();
    };
    if !earned_per_pole_db.is_finite() {
        return VecDeque::new();
    }
    let most = (name.order().max(ground.integrators) + FURTHER_POLES).min(maximum_order);
    let behind = named(most, ground, with_pure_gain).skip_while(|one| *one != name).skip(1);
    behind.filter(|one| one.order() >= name.order()).map(QueuedStructure::Named).collect()
}

/// Structures of growing order.
fn growing(maximum_order: usize, ground: &Ground, sampled: bool) -> impl Iterator<Item = QueuedStructure> {
    let integrators = ground.integrators;
    let orders = integrators..=maximum_order;
    let usual = orders.clone().flat_map(move |order| degrees(order, integrators, sampled));
    let biproper = orders.filter(move |order| !sampled && is_worth_as_many_zeros(*order, integrators));
    usual
        .chain(biproper.map(|order| (order, order)))
        .map(|(order, zeros)| QueuedStructure::Free { order, zeros })
}

/// Pairs (order, zeros) of an order: one pole more than zeros; equally many for a pure gain, for
/// proportional-integral control, and if the loop is sampled, so that its gain ends at pi/T anyway.
fn degrees(order: usize, integrators: usize, sampled: bool) -> Vec<(usize, usize)> {
    match order {
        0 => vec![(0, 0)],
        _ if sampled || (order == 1 && integrators == 1) => vec![(order, order - 1), (order, order)],
        _ => vec![(order, order - 1)],
    }
}

/// True if a continuous controller of this order is also searched with as many zeros as poles, once
/// none with fewer zeros has succeeded: for example a first-order lead, or a pair of zeros over a
/// pair of poles, which has the phase of the zeros at all higher frequencies.
fn is_worth_as_many_zeros(order: usize, integrators: usize) -> bool {
    order > integrators
}

/// The structure of this order with one zero fewer, for growing structures: a larger relative
/// degree has less gain at high frequency than any smaller one.
pub(super) fn fewer_zeros(candidate: QueuedStructure, structure: &Structure) -> VecDeque<QueuedStructure> {
    let order = structure.roots(-1.0);
    let fewer = structure.roots(1.0).checked_sub(1);
    let fewer = fewer.filter(|_| matches!(candidate, QueuedStructure::Free { .. }));
    fewer.map(|zeros| QueuedStructure::Free { order, zeros }).into_iter().collect()
}
