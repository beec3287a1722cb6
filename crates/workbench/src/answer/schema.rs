//! JSON Schema of answers, from their descriptions.

use std::collections::BTreeMap;

use super::envelope::Envelope;
use super::object::{Object, ObjectKey};
use super::shape::{EitherShape, KeyShape, Members, ObjectShape, ValueShape, WordList};
use super::{Body, Describe};
use crate::quantity::MotionKind;

/// The answer of a command.
pub(crate) struct CommandAnswer {
    shape: ObjectShape,
    /// Word of the key `command`; `None` for the answer of any command.
    command: Option<&'static str>,
    /// True if the keys of every answer are in front.
    in_envelope: bool,
}

impl CommandAnswer {
    /// Answer of this type, after the keys of every answer.
    pub(crate) fn of<Answer: Describe + Body>(command: &'static str) -> CommandAnswer {
        CommandAnswer { in_envelope: true, ..CommandAnswer::whole::<Answer>(Some(command)) }
    }

    /// Answer of this type, which has all keys.
    pub(crate) fn whole<Answer: Describe + Body>(command: Option<&'static str>) -> CommandAnswer {
        let (name, documentation) = match Answer::shape() {
            ValueShape::Object(own) => (own.name, own.documentation),
            _ => ("", ""),
        };
        let shape = ObjectShape { name, documentation, members: Answer::members };
        CommandAnswer { shape, command, in_envelope: false }
    }

    /// Names its definition, if the type without the keys of every answer is also a
    /// part of another answer.
    pub(crate) fn named(mut self, name: &'static str) -> CommandAnswer {
        self.shape.name = name;
        self
    }

    /// All keys.
    fn members(&self) -> Members {
        match self.in_envelope {
            true => Envelope::members().and((self.shape.members)()),
            false => (self.shape.members)(),
        }
    }
}

/// The schema of these answers.
pub(crate) fn schema_of(answers: &[CommandAnswer]) -> Object {
    let mut definitions = Definitions::default();
    for answer in answers {
        definitions.answer(answer);
    }
    let all: Vec<Object> = answers.iter().map(|answer| reference(answer.shape.name)).collect();
    Object::new()
        .with("$schema", "http://json-schema.org/draft-07/schema#")
        .with("title", "Answers of phea")
        .with("description", "JSON object that a command prints with --json; definitions by type.")
        .with("anyOf", all)
        .with("definitions", definitions.into_object())
}

/// Definitions by name, in the order in which they are first used.
#[derive(Default)]
struct Definitions {
    order: Vec<&'static str>,
    by_name: BTreeMap<&'static str, Object>,
}

impl Definitions {
    fn into_object(mut self) -> Object {
        let mut all = Object::new();
        for name in self.order {
            if let Some(definition) = self.by_name.remove(name) {
                all.push(name, definition);
            }
        }
        all
    }

    /// True if the name is new; its definition follows.
    fn begins(&mut self, name: &'static str) -> bool {
        let is_new = !self.order.contains(&name);
        if is_new {
            self.order.push(name);
        }
        is_new
    }

    fn answer(&mut self, answer: &CommandAnswer) {
        let ObjectShape { name, documentation, .. } = answer.shape;
        if self.begins(name) {
            let definition = self.object(documentation, answer.members(), answer.command);
            self.by_name.insert(name, definition);
        }
    }

    /// An object with these keys and no others.
    fn object(&mut self, documentation: &str, members: Members, command: Option<&str>) -> Object {
        let (mut properties, mut required, mut choices) = (Object::new(), vec![], members.choices);
        for member in members.list {
            let names = names_of(&member.key);
            for name in &names {
                let of_command = command.filter(|_| name == "command");
                properties.push(name.clone(), self.property(&member, of_command));
            }
            match <[String; 1]>::try_from(names) {
                Ok([name]) if member.required => required.push(name),
                Ok(_) => {}
                Err(_) if member.required => choices.push(vec![vec![member.key.clone()]]),
                Err(_) => {}
            }
        }
        let choices: Vec<Object> = choices.into_iter().filter_map(choice).collect();
        Object::new()
            .with("description", documentation.trim())
            .with("type", "object")
            .with("properties", properties)
            .with("required", required)
            .maybe("allOf", Some(choices).filter(|all| !all.is_empty()))
            .with("additionalProperties", false)
    }

    fn property(&mut self, member: &KeyShape, command: Option<&str>) -> Object {
        let described = Object::new().with("description", member.description.trim());
        match command {
            Some(word) => described.with("const", word),
            None => described.and(self.schema(&member.shape)),
        }
    }

    fn schema(&mut self, shape: &ValueShape) -> Object {
        let kind = |kind: &str| Object::new().with("type", kind);
        match shape {
            ValueShape::Flag => kind("boolean"),
            ValueShape::Count => kind("integer").with("minimum", 0_u32),
            ValueShape::Integer => kind("integer"),
            ValueShape::Text => kind("string"),
            ValueShape::Number => self.known("Number", number),
            ValueShape::Complex => self.known("Complex", complex),
            ValueShape::Interval => self.known("Interval", interval),
            ValueShape::Plant => self.known("Plant", plant),
            ValueShape::Words(list) => self.words(list),
            ValueShape::List(item) => kind("array").with("items", self.schema(item)),
            ValueShape::Array(item, count) => sized(kind("array").with("items", self.schema(item)), *count),
            ValueShape::Tuple(items) => {
                let each: Vec<Object> = items.iter().map(|item| self.schema(item)).collect();
                sized(kind("array").with("items", each), items.len())
            }
            ValueShape::Map(value) => kind("object").with("additionalProperties", self.schema(value)),
            ValueShape::Nullable(value) => Object::new().with("anyOf", [self.schema(value), kind("null")]),
            ValueShape::Either(either) => self.either(either),
            ValueShape::Object(own) => {
                if self.begins(own.name) {
                    let definition = self.object(own.documentation, (own.members)(), None);
                    self.by_name.insert(own.name, definition);
                }
                reference(own.name)
            }
        }
    }

    /// A definition that many answers use.
    fn known(&mut self, name: &'static str, definition: fn(&mut Definitions) -> Object) -> Object {
        if self.begins(name) {
            let definition = definition(self);
            self.by_name.insert(name, definition);
        }
        reference(name)
    }

    fn either(&mut self, either: &EitherShape) -> Object {
        if self.begins(either.name) {
            let each: Vec<Object> = either.values.iter().map(|value| self.schema(value)).collect();
            let definition =
                Object::new().with("description", either.documentation.trim()).with("anyOf", each);
            self.by_name.insert(either.name, definition);
        }
        reference(either.name)
    }

    fn words(&mut self, list: &WordList) -> Object {
        if self.begins(list.name) {
            let definition = Object::new()
                .with("description", list.documentation.trim())
                .with("type", "string")
                .with("enum", distinct(&list.words));
            self.by_name.insert(list.name, definition);
        }
        reference(list.name)
    }
}

/// The words without repetition: two values may have one word.
fn distinct(words: &[&'static str]) -> Vec<&'static str> {
    let mut distinct = Vec::new();
    for word in words {
        if !distinct.contains(word) {
            distinct.push(*word);
        }
    }
    distinct
}

fn reference(name: &str) -> Object {
    Object::new().with("$ref", format!("#/definitions/{name}"))
}

fn sized(array: Object, count: usize) -> Object {
    array.with("minItems", count).with("maxItems", count)
}

fn number(_: &mut Definitions) -> Object {
    let infinite = Object::new().with("type", "string").with("enum", ["inf", "-inf"]);
    Object::new()
        .with("description", "Number in SI; infinity, which JSON lacks, is a text.")
        .with("anyOf", [Object::new().with("type", "number"), infinite])
}

fn complex(all: &mut Definitions) -> Object {
    let parts = Object::new()
        .with("description", "Real and imaginary part.")
        .with("type", "array")
        .with("items", all.schema(&ValueShape::Number));
    sized(parts, 2)
}

fn interval(all: &mut Definitions) -> Object {
    let ends = Object::new()
        .with("description", "Lower and upper end of an interval.")
        .with("type", "array")
        .with("items", all.schema(&ValueShape::Number));
    sized(ends, 2)
}

fn plant(all: &mut Definitions) -> Object {
    let text = "Plant of a family: SI values by the names of the parameters; of a measured plant its name.";
    let values =
        Object::new().with("anyOf", [all.schema(&ValueShape::Number), all.schema(&ValueShape::Text)]);
    Object::new().with("description", text).with("type", "object").with("additionalProperties", values)
}

/// A key by its names in rigs of both motions.
fn names_of(key: &ObjectKey) -> Vec<String> {
    let mut names =
        [MotionKind::Linear, MotionKind::Rotary].map(|motion| key.text(motion).into_owned()).to_vec();
    names.dedup();
    names
}

/// Requires the keys of one of these sets; `None` where one of them is empty.
fn choice(sets: Vec<Vec<ObjectKey>>) -> Option<Object> {
    if sets.iter().any(Vec::is_empty) {
        return None;
    }
    let motions = [MotionKind::Linear, MotionKind::Rotary];
    let mut ways: Vec<Vec<String>> = Vec::new();
    for (set, motion) in sets.iter().flat_map(|set| motions.map(|motion| (set, motion))) {
        let names = set.iter().map(|key| key.text(motion).into_owned()).collect();
        if !ways.contains(&names) {
            ways.push(names);
        }
    }
    let ways = ways.into_iter().map(|names| Object::new().with("required", names));
    Some(Object::new().with("anyOf", ways.collect::<Vec<Object>>()))
}
