//! Table `[valve]`.

use crate::power_unit::DeclaredSupply;
use crate::servovalve::{Edges, LeakageModel};
use phea_quantity::{ANGULAR_FREQUENCY, FLOW, PRESSURE, RATIO, TIME, VOLTAGE, VOLTAGE_RATE};
use phea_table::{CatalogueKind, DeclaredMisfit, Key, PartCost, TableNumber, Visitor, key, plain};

pub(super) const TARE_FLOW_KEY: Key =
    key("tare_flow", &FLOW, "Pilot stage flow from supply to tank.").not_negative().or(0.0);
pub(super) const TARE_PRESSURE_KEY: Key =
    key("tare_pressure", &PRESSURE, "Drop at which `tare_flow` is stated; absent: the supply's.").positive();
pub(super) const NOMINAL_VOLTAGE_KEY: Key =
    key("nominal_voltage", &VOLTAGE, "Command of full opening.").positive().or(10.0);
pub(super) const NATURAL_FREQUENCY_KEY: Key =
    key("natural_frequency", &ANGULAR_FREQUENCY, "Natural frequency of the spool's dynamics.")
        .positive()
        .usual(60.0, 3000.0, "servovalves");
pub(super) const DAMPING_RATIO_KEY: Key =
    key("damping_ratio", &RATIO, "Damping ratio of the spool's dynamics.").positive();
pub(super) const TRANSITION_PRESSURE_KEY: Key =
    key("transition_pressure", &PRESSURE, "Drop below which the square root is made regular.")
        .positive()
        .or(1000.0);
pub(super) const SATURATION_KEY: Key =
    key("saturation", &RATIO, "c of the opening u/(1 + c u), beyond the lap; 0: in proportion.")
        .not_negative()
        .or(0.0);
pub(super) const THRESHOLD_KEY: Key =
    key("threshold", &VOLTAGE, "Change of command that a reversal takes.").positive();
pub(super) const RATE_LIMIT_KEY: Key =
    key("rate_limit", &VOLTAGE_RATE, "Greatest rate of the spool, as equivalent command.").positive();
pub(super) const LEAKAGE_SHAPE_KEY: Key =
    key("leakage_shape", &RATIO, "λ of sech(λ U/U_n) in the leakage; 0 keeps it constant.")
        .not_negative()
        .or(0.0);

/// Words of `leakage_model`.
pub static LEAKAGE_MODELS: [(&str, LeakageModel); 2] =
    [("each_edge", LeakageModel::EachEdge), ("one_curve", LeakageModel::OneCurve)];

/// Servovalve, by coefficients of its four edges or by its data sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Valve<S = f64> {
    /// Name of the catalogue entry of the values.
    pub model: Option<String>,
    /// Command of full opening, V.
    pub nominal_voltage: S,
    /// Natural frequency of the spool, rad/s.
    pub natural_frequency: S,
    /// Damping ratio of the spool's dynamics.
    pub damping_ratio: S,
    /// Shape λ of sech(λ U/U_n) in the leakage; zero gives constant leakage.
    pub leakage_shape: S,
    /// Shape λ of each edge, in place of the common one.
    pub leakage_shapes: Option<Edges<S>>,
    /// Meaning of λ and the leakage coefficients away from null.
    pub leakage_model: LeakageModel,
    /// Pilot stage flow from supply to tank, m³/s.
    pub tare_flow: S,
    /// Pressure drop from supply to tank at which the tare flow is stated, Pa; if absent, that of
    /// the supply.
    pub tare_pressure: Option<S>,
    /// Spool position at which the valve is at null, V.
    pub null_bias: S,
    /// Width of the loop over a slow full cycle, including the threshold, V.
    pub hysteresis: Option<S>,
    /// Change of command that a reversal requires, V.
    pub threshold: Option<S>,
    /// Greatest rate of the spool, V/s.
    pub rate_limit: Option<S>,
    /// Pressure drop below which the square root is smoothed, Pa.
    pub transition_pressure: S,
    /// Flow coefficients K_v3 to K_v6, or the data from which they follow.
    pub flow: ValveCoefficients<RatedFlow<S>, S>,
    /// Leakage coefficients K_vin3 to K_vin6, or the data from which they follow.
    pub leakage: ValveCoefficients<NullLeakage<S>, S>,
    /// Overlap of the edges, or, if negative, underlap.
    pub lap: Option<ValveLap<S>>,
    /// Saturation of the opening, c of u/(1 + c u); absent if zero.
    pub saturation: Option<S>,
    /// Step response time of the data sheet, for information, s.
    pub response_time: Option<S>,
    /// Residual of the recordings from which its coefficients were identified.
    pub misfit: Option<DeclaredMisfit<S>>,
    /// Cost and mass.
    pub cost: PartCost<S>,
}

/// Lap of the edges over the travel of full opening: positive for an overlap, negative for an
/// underlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ValveLap<S = f64> {
    /// Lap of edges 3 and 6, which a positive command opens.
    pub positive: S,
    /// Lap of edges 4 and 5, which a negative command opens.
    pub negative: S,
}

/// Coefficients of the edges as declared, or the data sheet values from which they follow, equal
/// for all edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValveCoefficients<R, S = f64> {
    /// Coefficients declared for each edge, m³/(s·√Pa).
    Edges {
        /// Declared coefficients.
        edges: Edges<S>,
        /// Additional data sheet values.
        rating: Option<R>,
    },
    /// Coefficients from the data sheet.
    Rated(R),
}

/// Rated flow of a data sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RatedFlow<S = f64> {
    /// Flow, m³/s.
    pub flow: S,
    /// Pressure drop over both edges at this flow, Pa.
    pub pressure_drop: S,
}

/// Leakage at null of a data sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NullLeakage<S = f64> {
    /// Leakage including the tare flow, m³/s; the lowest of a range.
    pub flow: S,
    /// Highest leakage including the tare flow, if the data sheet prints a range, m³/s.
    pub maximum: Option<S>,
    /// Supply pressure of the measurement, Pa.
    pub pressure: S,
}

impl<R: Default, S> Default for ValveCoefficients<R, S> {
    fn default() -> Self {
        ValveCoefficients::Rated(R::default())
    }
}

impl<R, S> ValveCoefficients<R, S> {
    /// Coefficients of each edge, if declared.
    pub fn edges(&self) -> Option<&Edges<S>> {
        if let ValveCoefficients::Edges { edges, .. } = self { Some(edges) } else { None }
    }

    /// Data sheet values.
    pub fn rating(&self) -> Option<&R> {
        match self {
            ValveCoefficients::Edges { rating, .. } => rating.as_ref(),
            ValveCoefficients::Rated(rating) => Some(rating),
        }
    }

    fn into_parts(self) -> (Option<Edges<S>>, Option<R>) {
        match self {
            ValveCoefficients::Edges { edges, rating } => (Some(edges), rating),
            ValveCoefficients::Rated(rating) => (None, Some(rating)),
        }
    }

    fn of_parts(edges: Option<Edges<S>>, rating: Option<R>) -> Option<ValveCoefficients<R, S>> {
        match (edges, rating) {
            (Some(edges), rating) => Some(ValveCoefficients::Edges { edges, rating }),
            (None, rating) => rating.map(ValveCoefficients::Rated),
        }
    }
}

impl<S: TableNumber> RatedFlow<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(
            key("nominal_flow", &FLOW, "Rated flow of the data sheet.").positive().usual(
                5e-6,
                2e-2,
                "servovalves",
            ),
            &mut self.flow,
        );
        let k = key("nominal_pressure_drop", &PRESSURE, "Drop over both edges together at the rated flow.")
            .usual(5e5, 3.5e7, "servovalves");
        v.quantity(k.positive(), &mut self.pressure_drop);
    }
}

impl<S: TableNumber> ValveLap<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("positive", &RATIO, "Of edges 3 and 6, over full travel; negative: underlap.");
        v.quantity(k, &mut self.positive);
        let k = key("negative", &RATIO, "Of edges 4 and 5, over full travel; negative: underlap.");
        v.quantity(k, &mut self.negative);
    }
}

impl<S: TableNumber> NullLeakage<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("null_leakage", &FLOW, "Leakage at null, tare flow included; the lowest of a range.");
        v.quantity(k.not_negative(), &mut self.flow);
        let k =
            key("null_leakage_maximum", &FLOW, "Highest leakage at null, where the data sheet has a range.");
        v.optional(k.not_negative(), &mut self.maximum);
        let k = key("null_leakage_pressure", &PRESSURE, "Supply pressure the null leakage was measured at.");
        v.quantity(k.positive(), &mut self.pressure);
    }
}

impl Valve {
    /// Pressure drop from supply to tank at which the tare flow is stated, Pa.
    pub fn tare_drop(&self, supply: &DeclaredSupply) -> f64 {
        self.tare_pressure.unwrap_or(supply.pressure - supply.tank_pressure)
    }
}

impl<S: TableNumber> Valve<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.catalogue(
            plain("model", "Name of a valve of the catalogue."),
            CatalogueKind::Valve,
            &mut self.model,
        );
        v.quantity(NOMINAL_VOLTAGE_KEY, &mut self.nominal_voltage);
        v.quantity(NATURAL_FREQUENCY_KEY, &mut self.natural_frequency);
        v.quantity(DAMPING_RATIO_KEY, &mut self.damping_ratio);
        v.quantity(LEAKAGE_SHAPE_KEY, &mut self.leakage_shape);
        let k = plain("leakage_shapes", "λ of each edge, in place of `leakage_shape`: a table, or an array.");
        v.record(k, &mut self.leakage_shapes, Edges::visit_shapes);
        let k = plain("leakage_model", "What follows sech(λ U/U_n): each edge's leakage, or the valve's.");
        v.choice(k, &LEAKAGE_MODELS, &mut self.leakage_model, false);
        v.quantity(TARE_FLOW_KEY, &mut self.tare_flow);
        v.quantity(TRANSITION_PRESSURE_KEY, &mut self.transition_pressure);
        self.visit_coefficients(v);
        let k = key("response_time", &TIME, "Step response time of the data sheet; for information.");
        v.optional(k.positive(), &mut self.response_time);
        DeclaredMisfit::visit(&mut self.misfit, v);
        self.cost.visit(v);
    }

    fn visit_coefficients<V: Visitor<S>>(&mut self, v: &mut V) {
        let (mut edges, mut rating) = std::mem::take(&mut self.flow).into_parts();
        let (mut leaking_edges, mut leakage) = std::mem::take(&mut self.leakage).into_parts();
        let flows = plain("flow_coefficients", "K_v3 to K_v6: a table, or an array in this order.");
        v.record(flows, &mut edges, Edges::visit_coefficients);
        let leaks = plain("leakage_coefficients", "K_vin3 to K_vin6: a table, or an array in this order.");
        v.record(leaks, &mut leaking_edges, Edges::visit_coefficients);
        let k = plain("lap", "Overlap of the edges, positive and negative command; below zero: underlap.");
        v.record(k, &mut self.lap, ValveLap::visit);
        v.unless_zero(SATURATION_KEY, &mut self.saturation);
        self.visit_imperfections(v);
        v.way(&["nominal_flow"], &mut rating, RatedFlow::visit);
        v.way(&["null_leakage"], &mut leakage, NullLeakage::visit);
        self.flow = ValveCoefficients::of_parts(edges, rating).unwrap_or_else(|| {
            let what = "`flow_coefficients`, or `nominal_flow` with `nominal_pressure_drop`,";
            v.lacks(&[&[flows.name], &["nominal_flow"]], what);
            ValveCoefficients::default()
        });
        self.leakage = ValveCoefficients::of_parts(leaking_edges, leakage).unwrap_or_else(|| {
            let what = "`leakage_coefficients`, or `null_leakage` with `null_leakage_pressure`,";
            v.lacks(&[&[leaks.name], &["null_leakage"]], what);
            ValveCoefficients::default()
        });
    }

    fn visit_imperfections<V: Visitor<S>>(&mut self, v: &mut V) {
        v.optional(TARE_PRESSURE_KEY, &mut self.tare_pressure);
        let k = key("null_bias", &VOLTAGE, "Spool position at which the valve is at null.").or(0.0);
        v.quantity(k, &mut self.null_bias);
        let k = key("hysteresis", &VOLTAGE, "Width of the loop over a slow full cycle, threshold included.");
        v.optional(k.positive(), &mut self.hysteresis);
        v.optional(THRESHOLD_KEY, &mut self.threshold);
        v.optional(RATE_LIMIT_KEY, &mut self.rate_limit);
    }
}
