//! Kernels that cannot be reached from outside, compiled here once more for the unit tests next to
//! their code: the library itself is not built for tests. What lies outside a kernel it takes from
//! the module above it, which is here this file.
#![allow(dead_code, unreachable_pub, reason = "a kernel's callers stay in the library")]

#[path = "../src/simulate/columns.rs"]
mod columns;
#[path = "../src/simulate/divergence.rs"]
mod divergence;
#[path = "../src/design/factors.rs"]
mod factors;
#[path = "../src/simulate/file_names.rs"]
mod file_names;
#[path = "../src/simulate/follower.rs"]
mod follower;
#[path = "../src/family/hill.rs"]
mod hill;
#[path = "../src/simulate/metrics.rs"]
mod metrics;
#[path = "../src/simulate/parts.rs"]
mod parts;
#[path = "../src/campaign/range.rs"]
mod range;
#[path = "../src/simulate/record.rs"]
mod record;
#[path = "../src/campaign/row.rs"]
mod row;
#[path = "../src/simulate/shortest_number.rs"]
mod shortest_number;
#[path = "../src/campaign/spread.rs"]
mod spread;
#[path = "../src/simulate/sum.rs"]
mod sum;
#[path = "../src/campaign/supply.rs"]
mod supply;
#[path = "../src/simulate/tally.rs"]
mod tally;

use metrics::{Cause, Metrics, Window};
use phea_engineering::csv;
use phea_engineering::simulate;
use phea_engineering::simulate::ControlledMachine;
use phea_project as project;
use phea_quantity as quantity;
