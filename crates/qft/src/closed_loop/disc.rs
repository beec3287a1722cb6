//! Closed-loop magnitudes of all plants within the disc around a response.
//!
//! ```text
//! u = 1 + L within |u - u_0| <= r:     1/u within |1/u - u_0*/d| <= r/d,                d = |u_0|^2 - r^2
//!                                      L/u within |L/u - (u_0* L_0 - r^2)/d| <= r/d
//! ```
//!
//! The image of a disc is a disc while d > 0, and the outside of a disc otherwise: L = -1 is then
//! one of the plants.

use num_complex::Complex64;
use phea_dynamics::portable::magnitude;

use crate::specification::ClosedLoop;

/// The squares of the least and of the greatest magnitude over that at the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DiscFactors {
    sensitivity: [f64; 2],
    complementary: [f64; 2],
}

impl DiscFactors {
    const OF_A_POINT: DiscFactors = DiscFactors { sensitivity: [1.0; 2], complementary: [1.0; 2] };

    /// Factors for L within this disc.
    pub(crate) fn of(centre: Complex64, radius: f64) -> DiscFactors {
        if radius.is_nan() || radius <= 0.0 {
            return DiscFactors::OF_A_POINT;
        }
        let own = 1.0 + centre;
        let distance = own.norm_sqr() - radius * radius;
        let image = |centre: Complex64, at_centre: f64| {
            let (from_zero, reach) = (magnitude(centre / distance), (radius / distance).abs());
            let [least, most] = if distance > 0.0 {
                [(from_zero - reach).max(0.0), from_zero + reach]
            } else {
                [(reach - from_zero).max(0.0), f64::INFINITY]
            };
            [least, most].map(|one| (one / at_centre) * (one / at_centre))
        };
        let size = magnitude(own);
        DiscFactors {
            sensitivity: image(own.conj(), 1.0 / size),
            complementary: image(own.conj() * centre - radius * radius, magnitude(centre) / size),
        }
    }

    /// Factors of one closed loop; P/(1 + L) is L/(1 + L) over G H, which is known.
    pub(crate) fn of_closed_loop(self, closed_loop: ClosedLoop) -> [f64; 2] {
        match closed_loop {
            ClosedLoop::RobustStability | ClosedLoop::Tracking | ClosedLoop::PlantInputDisturbance => {
                self.complementary
            }
            ClosedLoop::Sensitivity | ClosedLoop::ControlEffort | ClosedLoop::LoadMotion => self.sensitivity,
        }
    }
}
