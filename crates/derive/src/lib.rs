//! Derives, for the structs of which the answers of commands consist, the printed JSON and its
//! description from one declaration.
//!
//! The traits that the derived code names are defined by the module `answer` of `crates/workbench`.

mod field;
mod variants;

use proc_macro::TokenStream;
use proc_macro2::TokenStream as Tokens;
use quote::quote;
use syn::spanned::Spanned;
use syn::{Attribute, Data, DeriveInput, Error, Expr, Fields, Lit, Meta, Result};

use field::DeclaredField;

/// Derives `Body` and `Describe` for a struct: a key for each field, in the order of the fields,
/// described by its documentation.
///
/// An enum gets `Describe` from the value of each variant; one whose variants have named fields
/// also gets `Body`, with the keys of one variant.
///
/// Attributes of a field:
///
/// - `#[answer(optional)]` on an `Option`: no key without a value, where otherwise `null` is
///   printed.
/// - `#[answer(flatten)]`: the keys of the value in place of one key.
/// - `#[answer(interval)]`: pairs of numbers are the lower and the upper end of an interval.
/// - `#[answer(key = EXPRESSION)]`: a key other than the name of the field, as a text or as the
///   name of a quantity of the motion of the rig.
#[proc_macro_derive(Answer, attributes(answer))]
pub fn answer(input: TokenStream) -> TokenStream {
    let input = syn::parse_macro_input!(input as DeriveInput);
    derive(&input).unwrap_or_else(Error::into_compile_error).into()
}

fn derive(input: &DeriveInput) -> Result<Tokens> {
    let documentation = documentation(&input.attrs)
        .ok_or_else(|| Error::new(input.ident.span(), "lacks a description: add a doc comment"))?;
    match &input.data {
        Data::Struct(data) => derive_struct(input, &documentation, &data.fields),
        Data::Enum(data) => variants::derive(input, &documentation, data),
        Data::Union(_) => Err(Error::new(input.span(), "a union is not an answer")),
    }
}

/// The keys of a struct.
fn derive_struct(input: &DeriveInput, documentation: &str, fields: &Fields) -> Result<Tokens> {
    let fields = named(fields)?;
    let (names, put, members) = parts(&fields);
    let body = body(
        input,
        &quote! { #(all = all.and(#members);)* },
        &quote! {
            let Self { #(#names),* } = self;
            #(#put)*
        },
    );
    let described = describe_object(input, documentation);
    Ok(quote! { #body #described })
}

/// Names of fields, what prints each and what describes it.
fn parts(fields: &[DeclaredField]) -> (Vec<&syn::Ident>, Vec<Tokens>, Vec<Tokens>) {
    let names = fields.iter().map(DeclaredField::name).collect();
    (
        names,
        fields.iter().map(DeclaredField::put).collect(),
        fields.iter().map(DeclaredField::members).collect(),
    )
}

/// The implementation of `Body`.
fn body(input: &DeriveInput, members: &Tokens, put: &Tokens) -> Tokens {
    let name = &input.ident;
    let (generics, arguments, bounds) = input.generics.split_for_impl();
    quote! {
        impl #generics crate::answer::Body for #name #arguments #bounds {
            fn members() -> crate::answer::Members {
                let mut all = crate::answer::Members::default();
                #members
                all
            }

            fn put(self, object: &mut crate::answer::Object) {
                #put
            }
        }
    }
}

/// The implementation of `Describe` for a type with keys.
fn describe_object(input: &DeriveInput, documentation: &str) -> Tokens {
    let name = &input.ident;
    let (generics, arguments, bounds) = input.generics.split_for_impl();
    let text = name.to_string();
    quote! {
        impl #generics crate::answer::Describe for #name #arguments #bounds {
            fn shape() -> crate::answer::ValueShape {
                crate::answer::ValueShape::Object(crate::answer::ObjectShape {
                    name: #text,
                    documentation: #documentation,
                    members: <Self as crate::answer::Body>::members,
                })
            }

            fn into_json(self) -> crate::answer::Json {
                crate::answer::Json::Object(crate::answer::Body::into_object(self))
            }
        }
    }
}

/// The fields, which must have names.
fn named(fields: &Fields) -> Result<Vec<DeclaredField>> {
    match fields {
        Fields::Named(named) => named.named.iter().map(DeclaredField::of).collect(),
        Fields::Unit => Ok(vec![]),
        Fields::Unnamed(_) => Err(Error::new(fields.span(), "fields need names, which are the keys")),
    }
}

/// The text of a doc comment on one line.
fn documentation(attributes: &[Attribute]) -> Option<String> {
    let lines = attributes.iter().filter_map(|attribute| {
        let Meta::NameValue(pair) = &attribute.meta else { return None };
        let Expr::Lit(literal) = &pair.value else { return None };
        match &literal.lit {
            Lit::Str(text) if pair.path.is_ident("doc") => Some(text.value().trim().to_string()),
            _ => None,
        }
    });
    let text = lines.filter(|line| !line.is_empty()).collect::<Vec<String>>().join(" ");
    Some(text).filter(|text| !text.is_empty())
}
