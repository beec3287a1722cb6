//! `[controller]` and `[prefilter]`.

mod element;

pub use element::{Element, ElementKind};

use super::formula::Formula;
use super::key::{key, plain};
use super::reader::Reader;
use super::text::Findings;
use super::tree::Node;
use super::visitor::{Shape, Visitor};
use crate::catalogue::Catalogue;
use crate::quantity::{RATIO, TIME, VOLTAGE};

/// A transfer function in one of three forms: polynomials, factors, or elements in series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transfer {
    /// Polynomial in `s`, or in `z` when it is sampled.
    pub numerator: Option<Formula>,
    /// Polynomial in `s`, or in `z` when it is sampled.
    pub denominator: Option<Formula>,
    /// Leading coefficient k of k Π(s - z)/Π(s - p).
    pub gain: Option<f64>,
    /// Real and imaginary parts, 1/s.
    pub zeros: Vec<[f64; 2]>,
    /// Real and imaginary parts, 1/s.
    pub poles: Vec<[f64; 2]>,
    /// Elements in series.
    pub elements: Vec<Element>,
}

/// Which of its forms a [`Transfer`] is written in.
#[derive(Clone, Debug, PartialEq)]
pub enum TransferForm<'a> {
    /// Polynomials.
    Polynomials {
        /// As written.
        numerator: &'a Formula,
        /// As written.
        denominator: &'a Formula,
    },
    /// k Π(s - z)/Π(s - p).
    Factors {
        /// k.
        gain: f64,
        /// Real and imaginary parts.
        zeros: &'a [[f64; 2]],
        /// Real and imaginary parts.
        poles: &'a [[f64; 2]],
    },
    /// In series.
    Elements(&'a [Element]),
}

impl Transfer {
    /// The form it is written in; `None` only for one that was not read from a valid project.
    pub fn form(&self) -> Option<TransferForm<'_>> {
        if let (Some(numerator), Some(denominator)) = (&self.numerator, &self.denominator) {
            return Some(TransferForm::Polynomials { numerator, denominator });
        }
        if let Some(gain) = self.gain {
            return Some(TransferForm::Factors { gain, zeros: &self.zeros, poles: &self.poles });
        }
        if self.elements.is_empty() { None } else { Some(TransferForm::Elements(&self.elements)) }
    }

    /// The same as elements in series: polynomials and factors are one general element, with every number as it was written.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::project::{ElementKind, Transfer};
    /// let transfer = Transfer { gain: Some(2.0), poles: vec![[-3.0, 0.0]], ..Transfer::default() };
    /// let [general] = &transfer.as_elements()[..] else { panic!() };
    /// assert_eq!((general.kind, general.gain, &general.poles), (ElementKind::General, Some(2.0), &transfer.poles));
    /// assert!(Transfer::default().as_elements().is_empty());
    /// ```
    pub fn as_elements(&self) -> Vec<Element> {
        match self.form() {
            None => vec![],
            Some(TransferForm::Elements(elements)) => elements.to_vec(),
            Some(TransferForm::Polynomials { .. } | TransferForm::Factors { .. }) => vec![Element {
                kind: ElementKind::General,
                numerator: self.numerator.clone(),
                denominator: self.denominator.clone(),
                gain: self.gain,
                zeros: self.zeros.clone(),
                poles: self.poles.clone(),
                ..Element::default()
            }],
        }
    }

    /// What a table says of it, other keys left alone.
    pub(crate) fn read(table: &Node, findings: &mut Findings) -> Transfer {
        let catalogue = Catalogue::default();
        let mut transfer = Transfer::default();
        transfer.visit(&mut Reader::new(table, table.place.text, &catalogue, findings));
        transfer
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("numerator", "Polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.numerator, false);
        let k = plain("denominator", "Polynomial in s, or in z when sampled.");
        v.formula(k, Shape::Polynomial, &mut self.denominator, false);
        let k = key("gain", &RATIO, "Leading coefficient: k of k prod(s - z)/prod(s - p).");
        v.optional(k, &mut self.gain);
        v.complexes(
            key("zeros", &RATIO, "Numbers, or [re, im] pairs with their conjugates."),
            &mut self.zeros,
        );
        v.complexes(
            key("poles", &RATIO, "Numbers, or [re, im] pairs with their conjugates."),
            &mut self.poles,
        );
        v.tables(plain("elements", "Elements in series."), &mut self.elements, Element::visit);
    }
}

/// The controller as declared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// From force error to command.
    pub transfer: Transfer,
    /// V (or the plant's input unit), limit of the command.
    pub saturation: Option<f64>,
    /// What happens to the integrator at the limit.
    pub anti_windup: AntiWindup,
    /// s; absent: continuous.
    pub sample_time: Option<f64>,
    /// s, computation and transport delay of the loop.
    pub delay: f64,
    /// How a continuous controller becomes a sampled one.
    pub discretization: Discretization,
}

/// What happens to the integrator at the limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AntiWindup {
    /// It winds up.
    #[default]
    None,
    /// It is fed back the excess.
    BackCalculation,
    /// It stops.
    Clamping,
}

/// How a continuous controller becomes a sampled one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Discretization {
    /// The bilinear rule.
    #[default]
    Tustin,
    /// Exact for piecewise constant input.
    ZeroOrderHold,
    /// Poles and zeros mapped by exp(sT).
    Matched,
}

impl Controller {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("saturation", &VOLTAGE, "Limit of the command.").positive();
        v.optional(k, &mut self.saturation);
        let words = &[
            ("none", AntiWindup::None),
            ("back_calculation", AntiWindup::BackCalculation),
            ("clamping", AntiWindup::Clamping),
        ];
        let k = plain("anti_windup", "What happens to the integrator at the limit.");
        v.choice(k, words, &mut self.anti_windup, false);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
        let k = key("delay", &TIME, "Computation and transport delay of the loop, part of every verdict.");
        v.quantity(k.not_negative().or(0.0), &mut self.delay);
        let words = &[
            ("tustin", Discretization::Tustin),
            ("zero_order_hold", Discretization::ZeroOrderHold),
            ("matched", Discretization::Matched),
        ];
        let k = plain("discretization", "How a continuous controller becomes a sampled one.");
        v.choice(k, words, &mut self.discretization, false);
    }
}

/// The prefilter as declared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prefilter {
    /// From reference to filtered reference.
    pub transfer: Transfer,
    /// s; absent: continuous.
    pub sample_time: Option<f64>,
}

impl Prefilter {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        let k = key("sample_time", &TIME, "Sample time; absent: continuous.").positive();
        v.optional(k, &mut self.sample_time);
    }
}
