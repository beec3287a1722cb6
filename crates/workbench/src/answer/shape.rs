//! Description of the JSON of an answer: its values, and the keys of its objects.

use super::object::ObjectKey;

/// A value of JSON, described.
#[derive(Clone, Debug)]
pub(crate) enum ValueShape {
    Flag,
    /// Integer that is not negative.
    Count,
    Integer,
    /// Number in SI, infinity being a text.
    Number,
    /// Real and imaginary part.
    Complex,
    Text,
    /// Plant of a family: its values by the names of the parameters.
    Plant,
    Words(WordList),
    List(Box<ValueShape>),
    /// List of a known number of values.
    Array(Box<ValueShape>, usize),
    /// Lower and upper end of an interval, both numbers.
    Interval,
    /// List of values that differ in kind.
    Tuple(Vec<ValueShape>),
    /// Object whose keys are names, each with such a value.
    Map(Box<ValueShape>),
    Nullable(Box<ValueShape>),
    Either(EitherShape),
    Object(ObjectShape),
}

impl ValueShape {
    /// With intervals in place of pairs of numbers.
    fn of_intervals(self) -> ValueShape {
        let within = |value: Box<ValueShape>| Box::new(value.of_intervals());
        match self {
            ValueShape::Array(item, 2) if matches!(*item, ValueShape::Number) => ValueShape::Interval,
            ValueShape::Array(item, count) => ValueShape::Array(within(item), count),
            ValueShape::List(item) => ValueShape::List(within(item)),
            ValueShape::Map(value) => ValueShape::Map(within(value)),
            ValueShape::Nullable(value) => ValueShape::Nullable(within(value)),
            other => other,
        }
    }
}

/// The words of an enumeration.
#[derive(Clone, Debug)]
pub(crate) struct WordList {
    pub(crate) name: &'static str,
    pub(crate) documentation: &'static str,
    pub(crate) words: Vec<&'static str>,
}

/// One of several values, with a name.
#[derive(Clone, Debug)]
pub(crate) struct EitherShape {
    pub(crate) name: &'static str,
    pub(crate) documentation: &'static str,
    pub(crate) values: Vec<ValueShape>,
}

/// An object with a name. Its keys are a function because objects may contain each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectShape {
    pub(crate) name: &'static str,
    pub(crate) documentation: &'static str,
    pub(crate) members: fn() -> Members,
}

/// A key of an object, with its description.
#[derive(Clone, Debug)]
pub(crate) struct KeyShape {
    pub(crate) key: ObjectKey,
    pub(crate) description: String,
    pub(crate) shape: ValueShape,
    /// True if every such object has the key.
    pub(crate) required: bool,
}

/// The keys of an object.
#[derive(Clone, Debug, Default)]
pub(crate) struct Members {
    pub(crate) list: Vec<KeyShape>,
    /// Sets of keys, every key of at least one of which the object has.
    pub(crate) choices: Vec<Vec<Vec<ObjectKey>>>,
}

impl Members {
    /// One key that every object has.
    pub(crate) fn one(key: ObjectKey, description: impl Into<String>, shape: ValueShape) -> Members {
        let member = KeyShape { key, description: description.into(), shape, required: true };
        Members { list: vec![member], choices: vec![] }
    }

    /// These and those of another.
    pub(crate) fn and(mut self, other: Members) -> Members {
        self.list.extend(other.list);
        self.choices.extend(other.choices);
        self
    }

    /// Makes all keys optional.
    pub(crate) fn optional(mut self) -> Members {
        self.list.iter_mut().for_each(|member| member.required = false);
        self.choices.clear();
        self
    }

    /// With intervals in place of the pairs of numbers in the values.
    pub(crate) fn of_intervals(mut self) -> Members {
        for member in &mut self.list {
            member.shape = member.shape.clone().of_intervals();
        }
        self
    }

    /// The keys of one of several sets; a key of two sets is described by the first.
    pub(crate) fn one_of(sets: Vec<Members>) -> Members {
        let required = |set: &Members| {
            let keys = set.list.iter().filter(|member| member.required);
            keys.map(|member| member.key.clone()).collect::<Vec<ObjectKey>>()
        };
        let choice = sets.iter().map(required).collect();
        let mut all = Members { list: vec![], choices: vec![choice] };
        for member in sets.into_iter().flat_map(|set| set.list) {
            if all.list.iter().all(|known| known.key != member.key) {
                all.list.push(KeyShape { required: false, ..member });
            }
        }
        all
    }
}
