//! Kernels that cannot be reached from outside, compiled here again for the unit tests next to
//! their code: the library itself is not built for tests.
#![allow(dead_code, unreachable_pub, reason = "a kernel's callers stay in the library")]

mod descent;

#[path = "../src/bound/ceiling.rs"]
mod ceiling;
#[path = "../src/stability/characteristic.rs"]
mod characteristic;
#[path = "../src/coordinate_climb.rs"]
mod coordinate_climb;
#[path = "../src/bound/covering.rs"]
mod covering;
#[path = "../src/manual_shaping/edit.rs"]
mod edit;
#[path = "../src/stability/encirclement.rs"]
mod encirclement;
#[path = "../src/design/feedback_sign.rs"]
mod feedback_sign;
#[path = "../src/bound/fill.rs"]
mod fill;
#[path = "../src/bound/inequality.rs"]
mod inequality;
#[path = "../src/bound/interval.rs"]
mod interval;
#[path = "../src/kept_plants.rs"]
mod kept_plants;
#[path = "../src/specification/limit.rs"]
mod limit;
#[path = "../src/design/stabilising/placement.rs"]
mod placement;
#[path = "../src/design/diagnosis/plane.rs"]
mod plane;
#[path = "../src/bound/power_of_two.rs"]
mod power_of_two;
#[path = "../src/stability/product.rs"]
mod product;
#[path = "../src/loop_shaping/margins/prominent.rs"]
mod prominent;
#[path = "../src/bound/quadratic.rs"]
mod quadratic;
#[path = "../src/loop_shaping/start/spread.rs"]
mod spread;
#[path = "../src/loop_shaping/subproblem.rs"]
mod subproblem;
#[path = "../src/loop_shaping/triplets.rs"]
mod triplets;

use phea_qft::closed_loop::{self, Compensation};
use phea_qft::loop_shaping as search;
use phea_qft::stability::Irresolution;

const DECIBELS_PER_NEPER: f64 = 20.0 / std::f64::consts::LN_10;
