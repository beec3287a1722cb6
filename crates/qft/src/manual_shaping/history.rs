//! What was done to a controller, and back.

use std::collections::BTreeMap;

use phea_dynamics::controller::Compensator;

use super::edit::{Edit, EditError, apply};

/// A controller with all its earlier states. It is a value: a copy of it is a branch of the work.
///
/// # Example
/// ```
/// use phea_dynamics::controller::{Compensator, Element};
/// use phea_qft::manual_shaping::{Edit, EditError, History};
/// let mut history = History::new(Compensator::new(vec![Element::Gain(2.0)]));
/// history.snapshot("as given");
/// history.edit(&Edit::ScaleGain(10.0))?;
/// history.edit(&Edit::Remove(0))?;
/// assert!(history.present().stages.is_empty());
/// assert_eq!(history.undo().map(|now| now.stages[0].element.clone()), Some(Element::Gain(20.0)));
/// assert_eq!(history.redo().map(|now| now.stages.len()), Some(0));
/// history.restore("as given"); // a step like any other
/// assert_eq!(history.present().stages[0].element, Element::Gain(2.0));
/// assert_eq!(history.undo().map(|now| now.stages.len()), Some(0));
/// # Ok::<(), EditError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    past: Vec<Compensator>,
    present: Compensator,
    /// What was undone, the next to be redone last.
    future: Vec<Compensator>,
    snapshots: BTreeMap<String, Compensator>,
}

impl History {
    /// A history that begins here.
    pub fn new(present: Compensator) -> History {
        History { past: Vec::new(), present, future: Vec::new(), snapshots: BTreeMap::new() }
    }

    /// The controller as it is now.
    pub fn present(&self) -> &Compensator {
        &self.present
    }

    /// Makes one change; what was undone before is forgotten.
    ///
    /// # Errors
    /// Those of [`apply`]; nothing is changed then.
    pub fn edit(&mut self, edit: &Edit) -> Result<&Compensator, EditError> {
        let changed = apply(&self.present, edit)?;
        Ok(self.step(changed))
    }

    /// Takes the last change back; `None` where there is none.
    pub fn undo(&mut self) -> Option<&Compensator> {
        let earlier = self.past.pop()?;
        self.future.push(std::mem::replace(&mut self.present, earlier));
        Some(&self.present)
    }

    /// Makes the change again that was taken back last; `None` where there is none.
    pub fn redo(&mut self) -> Option<&Compensator> {
        let later = self.future.pop()?;
        self.past.push(std::mem::replace(&mut self.present, later));
        Some(&self.present)
    }

    /// Keeps the controller as it is now under a name; an older one of that name is replaced.
    pub fn snapshot(&mut self, name: &str) {
        self.snapshots.insert(name.to_string(), self.present.clone());
    }

    /// Goes back to the controller of that name, which can be undone like a change; `None` where there is none.
    pub fn restore(&mut self, name: &str) -> Option<&Compensator> {
        let kept = self.snapshots.get(name)?.clone();
        Some(self.step(kept))
    }

    /// The controllers that were kept, by name.
    pub fn snapshots(&self) -> &BTreeMap<String, Compensator> {
        &self.snapshots
    }

    fn step(&mut self, next: Compensator) -> &Compensator {
        self.past.push(std::mem::replace(&mut self.present, next));
        self.future.clear();
        &self.present
    }
}
