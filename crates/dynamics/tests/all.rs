//! Systems, controllers and simulation through the public interface: closed forms, limits,
//! conservation and published numbers.
#![cfg(test)]

mod controller;
mod discretization;
mod frequency;
mod held_plants;
mod least_squares;
mod linear_roots;
mod linear_systems;
mod simulation;
mod simulation_profile;
mod spectrum;
mod time_response;
