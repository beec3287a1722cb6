//! Enums: one of several values, or one of several sets of keys.

use proc_macro2::TokenStream as Tokens;
use quote::quote;
use syn::{DataEnum, DeriveInput, Error, Fields, Result, Variant};

use super::{body, describe_object, named, parts};

/// `Describe` for an enum, and `Body` if its variants have named fields.
pub(crate) fn derive(input: &DeriveInput, documentation: &str, data: &DataEnum) -> Result<Tokens> {
    let has_keys = |variant: &Variant| !matches!(variant.fields, Fields::Unnamed(_));
    match data.variants.iter().all(has_keys) {
        true => derive_keys(input, documentation, data),
        false => derive_values(input, documentation, data),
    }
}

/// The keys of one of the variants.
fn derive_keys(input: &DeriveInput, documentation: &str, data: &DataEnum) -> Result<Tokens> {
    let (mut arms, mut alternatives) = (Vec::new(), Vec::new());
    for variant in &data.variants {
        let fields = named(&variant.fields)?;
        let (names, put, members) = parts(&fields);
        let name = &variant.ident;
        arms.push(quote! { Self::#name { #(#names),* } => { #(#put)* } });
        alternatives.push(quote! {
            { let mut all = crate::answer::Members::default(); #(all = all.and(#members);)* all }
        });
    }
    let body = body(
        input,
        &quote! { all = all.and(crate::answer::Members::one_of(vec![#(#alternatives),*])); },
        &quote! { match self { #(#arms)* } },
    );
    let described = describe_object(input, documentation);
    Ok(quote! { #body #described })
}

/// The value of one of the variants.
fn derive_values(input: &DeriveInput, documentation: &str, data: &DataEnum) -> Result<Tokens> {
    let (mut arms, mut shapes) = (Vec::new(), Vec::new());
    for variant in &data.variants {
        let kind = match &variant.fields {
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => fields.unnamed.first(),
            _ => None,
        };
        let message = "every variant must have one value, or every one named fields";
        let kind = kind.ok_or_else(|| Error::new(variant.ident.span(), message))?;
        let (name, kind) = (&variant.ident, &kind.ty);
        arms.push(quote! { Self::#name(value) => crate::answer::Describe::into_json(value) });
        shapes.push(quote! { <#kind as crate::answer::Describe>::shape() });
    }
    let (name, text) = (&input.ident, input.ident.to_string());
    let (generics, arguments, bounds) = input.generics.split_for_impl();
    Ok(quote! {
        impl #generics crate::answer::Describe for #name #arguments #bounds {
            fn shape() -> crate::answer::ValueShape {
                crate::answer::ValueShape::Either(crate::answer::EitherShape {
                    name: #text,
                    documentation: #documentation,
                    values: vec![#(#shapes),*],
                })
            }

            fn into_json(self) -> crate::answer::Json {
                match self { #(#arms),* }
            }
        }
    })
}
