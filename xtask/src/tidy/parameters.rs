//! The parameters of the actuator: the public numbers of those types of `crates/hydraulics` that
//! can be refused, because they have a method `problems` or are part of a type that has one.
//! Somebody types these numbers and has to know what they mean.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::{self, Visit};

use crate::repository::Repository;

/// A public number of a type that can be refused.
pub(super) struct Parameter {
    pub(super) path: String,
    pub(super) line: usize,
    pub(super) owner: String,
    pub(super) name: String,
}

/// All parameters, in the order of the files.
pub(super) fn parameters(repository: &Repository) -> Vec<Parameter> {
    let mut types = Types::default();
    for file in repository.rust_files().iter().filter(|file| file.path.starts_with("crates/hydraulics/src/"))
    {
        types.path.clone_from(&file.path);
        types.visit_file(&file.syntax);
    }
    let mut refusable = types.refusable.clone();
    let mut to_look_into: Vec<String> = refusable.iter().cloned().collect();
    while let Some(owner) = to_look_into.pop() {
        let parts = types.parts.get(&owner).into_iter().flatten();
        to_look_into.extend(parts.filter(|part| refusable.insert(part.to_string())).cloned());
    }
    types.numbers.into_iter().filter(|number| refusable.contains(&number.owner)).collect()
}

#[derive(Default)]
struct Types {
    path: String,
    /// Public numbers of any type.
    numbers: Vec<Parameter>,
    /// The names that occur in the types of a type's fields.
    parts: BTreeMap<String, BTreeSet<String>>,
    /// Types with a method `problems`.
    refusable: BTreeSet<String>,
}

impl Types {
    fn add(&mut self, owner: &syn::Ident, generics: &syn::Generics, fields: &syn::Fields) {
        let scalars: Vec<String> =
            generics.type_params().map(|parameter| parameter.ident.to_string()).collect();
        for field in fields {
            let mut names = Names::default();
            names.visit_type(&field.ty);
            if let Some(name) = field.ident.as_ref().filter(|_| is_number(&field.ty, &scalars)) {
                let (line, name) = (name.span().start().line, name.to_string());
                self.numbers.push(Parameter {
                    path: self.path.clone(),
                    line,
                    owner: owner.to_string(),
                    name,
                });
            }
            self.parts.entry(owner.to_string()).or_default().extend(names.0);
        }
    }
}

impl<'ast> Visit<'ast> for Types {
    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.add(&item.ident, &item.generics, &item.fields);
    }

    fn visit_item_enum(&mut self, item: &'ast syn::ItemEnum) {
        item.variants.iter().for_each(|variant| self.add(&item.ident, &item.generics, &variant.fields));
    }

    fn visit_item_impl(&mut self, block: &'ast syn::ItemImpl) {
        let problems = |item: &syn::ImplItem| match item {
            syn::ImplItem::Fn(method) => method.sig.ident == "problems",
            _ => false,
        };
        if let (syn::Type::Path(owner), true) = (&*block.self_ty, block.items.iter().any(problems)) {
            self.refusable.extend(owner.path.segments.last().map(|segment| segment.ident.to_string()));
        }
    }
}

/// Every name in a type.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl<'ast> Visit<'ast> for Names {
    fn visit_path_segment(&mut self, segment: &'ast syn::PathSegment) {
        self.0.insert(segment.ident.to_string());
        visit::visit_path_segment(self, segment);
    }
}

/// `f64`, a scalar by the name of a type parameter, an array or an option of them.
fn is_number(kind: &syn::Type, scalars: &[String]) -> bool {
    let of_numbers = |argument: &syn::GenericArgument| match argument {
        syn::GenericArgument::Type(inner) => is_number(inner, scalars),
        _ => false,
    };
    match kind {
        syn::Type::Array(array) => is_number(&array.elem, scalars),
        syn::Type::Path(path) => path.path.segments.last().is_some_and(|last| match &last.arguments {
            syn::PathArguments::AngleBracketed(inner) => {
                last.ident == "Option" && inner.args.iter().any(of_numbers)
            }
            _ => last.ident == "f64" || scalars.iter().any(|scalar| last.ident == scalar),
        }),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(files: &[(&str, &str)]) -> Vec<String> {
        let parameters = parameters(&Repository::from_texts(files));
        parameters.into_iter().map(|Parameter { owner, name, .. }| format!("{owner}::{name}")).collect()
    }

    #[test]
    fn numbers_that_can_be_refused_are_parameters_and_answers_are_not() {
        let code = "
            pub struct Hose<S = f64> { pub bore: S, pub name: String, pub stiffening: Option<Stiffening> }
            impl<S> Hose<S> { pub fn problems(&self) {} }
            pub enum Line { Volume { volume: f64 } }
            impl Line { fn problems(&self) {} }
            pub struct Answer { pub minimum: f64 }
        ";
        let part = "pub struct Stiffening { pub nominal: f64 }";
        let files = [("crates/hydraulics/src/line.rs", code), ("crates/hydraulics/src/line/hose.rs", part)];
        assert_eq!(names(&files), ["Hose::bore", "Line::volume", "Stiffening::nominal"]);
        assert!(names(&[("crates/qft/src/line.rs", code)]).is_empty());
    }

    #[test]
    fn arrays_and_options_of_numbers_are_numbers() {
        for (text, expected) in
            [("[f64; 2]", true), ("Option<S>", true), ("Vec<f64>", false), ("Line", false)]
        {
            assert_eq!(is_number(&syn::parse_str(text).unwrap(), &["S".to_string()]), expected, "{text}");
        }
    }
}
