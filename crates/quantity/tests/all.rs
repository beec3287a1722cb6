//! Quantities in text from outside.
#![cfg(test)]

mod text;
