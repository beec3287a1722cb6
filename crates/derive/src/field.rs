//! A field of a struct: its key, how it is printed and how it is described.

use proc_macro2::Span;
use proc_macro2::TokenStream as Tokens;
use quote::quote;
use syn::ext::IdentExt;
use syn::{Error, Expr, Ident, LitStr, Result, Type};

use super::documentation;

/// A field with its attributes.
pub(crate) struct DeclaredField {
    name: Ident,
    kind: Type,
    presence: Presence,
    /// True if pairs of its numbers are the ends of intervals.
    interval: bool,
}

enum Presence {
    /// The keys of the value.
    Flat,
    /// One key with its description, left out without a value where it is optional.
    Key { key: Tokens, description: String, optional: bool },
}

impl DeclaredField {
    /// A field as it was declared.
    pub(crate) fn of(field: &syn::Field) -> Result<DeclaredField> {
        let nameless = || Error::new(Span::call_site(), "fields need names, which are the keys");
        let name = field.ident.clone().ok_or_else(nameless)?;
        let (mut key, mut optional, mut flat, mut interval) = (None, false, false, false);
        for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("answer")) {
            attribute.parse_nested_meta(|meta| {
                match meta.path.get_ident().map(Ident::to_string).as_deref() {
                    Some("optional") => optional = true,
                    Some("flatten") => flat = true,
                    Some("interval") => interval = true,
                    Some("key") => key = Some(meta.value()?.parse::<Expr>()?),
                    _ => return Err(meta.error("is none of `optional`, `flatten`, `interval`, `key = ...`")),
                }
                Ok(())
            })?;
        }
        let presence = match (flat, documentation(&field.attrs)) {
            (true, _) if optional || key.is_some() => {
                return Err(Error::new(name.span(), "a flattened field has no key of its own"));
            }
            (true, _) => Presence::Flat,
            (false, None) => {
                return Err(Error::new(name.span(), "lacks a description: add a doc comment"));
            }
            (false, Some(description)) => {
                let own = LitStr::new(&name.unraw().to_string(), name.span());
                let key = key.map_or(quote! { #own }, |key| quote! { #key });
                Presence::Key { key, description, optional }
            }
        };
        Ok(DeclaredField { name, kind: field.ty.clone(), presence, interval })
    }

    /// Name of the field in Rust.
    pub(crate) fn name(&self) -> &Ident {
        &self.name
    }

    /// The statement that prints it, from a variable of its name.
    pub(crate) fn put(&self) -> Tokens {
        let name = &self.name;
        match &self.presence {
            Presence::Flat => quote! { crate::answer::Body::put(#name, object); },
            Presence::Key { key, optional: false, .. } => quote! {
                crate::answer::Field::put(#name, crate::answer::ObjectKey::from(#key), object);
            },
            Presence::Key { key, optional: true, .. } => quote! {
                if let Some(value) = #name {
                    crate::answer::Field::put(value, crate::answer::ObjectKey::from(#key), object);
                }
            },
        }
    }

    /// The expression that describes its keys.
    pub(crate) fn members(&self) -> Tokens {
        let kind = &self.kind;
        let members = match &self.presence {
            Presence::Flat => quote! { <#kind as crate::answer::Body>::members() },
            Presence::Key { key, description, optional: false } => quote! {
                <#kind as crate::answer::Field>::members(
                    crate::answer::ObjectKey::from(#key), #description
                )
            },
            Presence::Key { key, description, optional: true } => quote! {
                <<#kind as crate::answer::Perhaps>::Value as crate::answer::Field>::members(
                    crate::answer::ObjectKey::from(#key), #description
                ).optional()
            },
        };
        if self.interval {
            quote! { #members.of_intervals() }
        } else {
            members
        }
    }
}
