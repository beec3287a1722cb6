//! The bridge from any plant to robust design.
