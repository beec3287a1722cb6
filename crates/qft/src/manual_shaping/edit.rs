//! Edits of a controller, represented as values.

use phea_dynamics::controller::{Compensator, Element, Stage};
use phea_dynamics::linear::LinearError;

/// One change of a list of elements. Elements are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Insertion of a new element.
    Add {
        /// Number of elements before it.
        at: usize,
        /// The element, with its enabled state.
        stage: Stage,
    },
    /// Removal of this element.
    Remove(usize),
    /// Replacement of an element; the enabled state is unchanged.
    Replace(usize, Element),
    /// Enables or disables an element; a disabled one stays in the list.
    Enable(usize, bool),
    /// Move of an element to another position; the order of the others is unchanged.
    Move {
        /// Present position.
        from: usize,
        /// New position.
        to: usize,
    },
    /// Multiplication of the gain by a factor: that of the first enabled gain, or of a new one in
    /// front.
    ScaleGain(f64),
}

/// Reason why a list of elements cannot be changed in this way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// An element that does not exist.
    #[error("there is no element {index}, counted from 0: there are {count}")]
    NoElement {
        /// Requested index, from 0.
        index: usize,
        /// Number of elements.
        count: usize,
    },
    /// An element that is not a transfer function.
    #[error("the element is not a transfer function: {0}")]
    Element(LinearError),
    /// An element for which the loop is zero.
    #[error("the element is zero at every frequency")]
    Zero,
    /// A factor that is zero or not finite, or results in such a gain.
    #[error("the gain cannot be multiplied by {0}")]
    Factor(f64),
}

/// The elements with one change made; the given ones are not modified.
///
/// # Errors
/// [`EditError`] for an element or position that does not exist, an element that is not a transfer
/// function, or a factor of zero.
///
/// # Example
/// ```
/// use phea_dynamics::controller::{Compensator, Element, Stage};
/// use phea_qft::manual_shaping::{Edit, EditError, apply};
/// let given = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
/// let stage = Stage { element: Element::RealZero { frequency: 4.0 }, enabled: true };
/// let added = apply(&given, &Edit::Add { at: 2, stage })?;
/// let louder = apply(&added, &Edit::ScaleGain(3.0))?;
/// assert_eq!(louder.transfer_function().map(|g| g.gain()), Ok(6.0 / 4.0)); // 6 (s/4 + 1)/s
/// assert_eq!(apply(&louder, &Edit::Remove(3)), Err(EditError::NoElement { index: 3, count: 3 }));
/// # Ok::<(), EditError>(())
/// ```
pub fn apply(compensator: &Compensator, edit: &Edit) -> Result<Compensator, EditError> {
    let mut stages = compensator.stages.clone();
    let count = stages.len();
    let missing = |index: usize| EditError::NoElement { index, count };
    match edit {
        Edit::Add { at, stage } => {
            sound(&stage.element)?;
            if *at > count {
                return Err(missing(*at));
            }
            stages.insert(*at, stage.clone());
        }
        Edit::Remove(index) => drop(taken(&mut stages, *index)?),
        Edit::Replace(index, element) => {
            sound(element)?;
            stages.get_mut(*index).ok_or(missing(*index))?.element = element.clone();
        }
        Edit::Enable(index, enabled) => {
            stages.get_mut(*index).ok_or(missing(*index))?.enabled = *enabled;
        }
        Edit::Move { from, to } => {
            if *to >= count {
                return Err(missing(*to));
            }
            let stage = taken(&mut stages, *from)?;
            stages.insert(*to, stage);
        }
        Edit::ScaleGain(factor) => scale(&mut stages, *factor)?,
    }
    Ok(Compensator { stages })
}

fn sound(element: &Element) -> Result<(), EditError> {
    let function = element.transfer_function().map_err(EditError::Element)?;
    if function.gain() == 0.0 { Err(EditError::Zero) } else { Ok(()) }
}

fn taken(stages: &mut Vec<Stage>, index: usize) -> Result<Stage, EditError> {
    if index < stages.len() {
        Ok(stages.remove(index))
    } else {
        Err(EditError::NoElement { index, count: stages.len() })
    }
}

fn scale(stages: &mut Vec<Stage>, factor: f64) -> Result<(), EditError> {
    let gain = stages.iter_mut().filter(|stage| stage.enabled).find_map(|stage| match &mut stage.element {
        Element::Gain(gain) => Some(gain),
        _ => None,
    });
    let product = gain.as_ref().map_or(factor, |gain| **gain * factor);
    if product == 0.0 || !product.is_finite() || factor == 0.0 {
        return Err(EditError::Factor(factor));
    }
    match gain {
        Some(gain) => *gain = product,
        None => stages.insert(0, Stage { element: Element::Gain(factor), enabled: true }),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given() -> Compensator {
        Compensator::new(vec![Element::Integrator, Element::Gain(2.0), Element::RealZero { frequency: 3.0 }])
    }

    #[test]
    fn an_element_moves_to_the_place_that_is_named() {
        let order = |from, to| {
            let moved = apply(&given(), &Edit::Move { from, to }).unwrap();
            let place = |wanted: &Element| moved.stages.iter().position(|stage| stage.element == *wanted);
            given().stages.iter().map(|stage| place(&stage.element).unwrap()).collect::<Vec<_>>()
        };
        assert_eq!(order(0, 2), [2, 0, 1]);
        assert_eq!(order(2, 0), [1, 2, 0]);
        assert_eq!(order(1, 1), [0, 1, 2]);
    }

    #[test]
    fn what_is_not_there_is_refused_and_named() {
        let refused = |edit| apply(&given(), &edit).unwrap_err();
        let missing = |index| EditError::NoElement { index, count: 3 };
        let stage = Stage { element: Element::Integrator, enabled: true };
        assert_eq!(refused(Edit::Add { at: 4, stage }), missing(4));
        assert_eq!(refused(Edit::Remove(3)), missing(3));
        assert_eq!(refused(Edit::Replace(7, Element::Integrator)), missing(7));
        assert_eq!(refused(Edit::Enable(3, false)), missing(3));
        assert_eq!(refused(Edit::Move { from: 5, to: 0 }), missing(5));
        assert_eq!(refused(Edit::Move { from: 0, to: 3 }), missing(3));
        assert_eq!(refused(Edit::Replace(0, Element::RealPole { frequency: 0.0 })), EditError::Zero);
        let endless = refused(Edit::Replace(0, Element::RealZero { frequency: 0.0 }));
        assert!(matches!(endless, EditError::Element(_)), "{endless:?}");
    }

    #[test]
    fn a_gain_is_scaled_where_it_acts() {
        let scaled = |compensator: &Compensator, factor| apply(compensator, &Edit::ScaleGain(factor));
        let function = |compensator: &Compensator| compensator.transfer_function().unwrap();
        let twice = scaled(&given(), 2.0).unwrap();
        assert_eq!((twice.stages.len(), function(&twice).gain()), (3, 2.0 * function(&given()).gain()));
        let silent = apply(&given(), &Edit::Enable(1, false)).unwrap();
        let beside = scaled(&silent, 5.0).unwrap();
        assert_eq!((beside.stages.len(), &beside.stages[0].element), (4, &Element::Gain(5.0)));
        for factor in [0.0, f64::NAN, f64::INFINITY] {
            assert!(scaled(&given(), factor).is_err() && scaled(&silent, factor).is_err());
        }
    }
}
