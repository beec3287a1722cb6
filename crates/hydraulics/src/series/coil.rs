use std::f64::consts::PI;

/// Wire of a pair of coil springs. Units: 1, Pa, Pa, kg/m3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoilWire {
    /// Spring index C: mean diameter of the coil over that of the wire.
    pub index: f64,
    /// Greatest shear stress tau.
    pub allowed_shear_stress: f64,
    /// Shear modulus G.
    pub shear_modulus: f64,
    /// Density rho.
    pub density: f64,
}

/// Pair of equal coil springs, opposed: one pushes and one pulls the load. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoilPair {
    /// Factor K_w by which curvature and shear raise the stress.
    pub wahl_factor: f64,
    /// Diameter d of the wire.
    pub wire_diameter: f64,
    /// Mean diameter D of the coil.
    pub coil_diameter: f64,
    /// Active coils n of either spring; two more are closed and ground.
    pub active_coils: f64,
    /// Length of either spring with its coils in contact.
    pub solid_length: f64,
    /// Length of both in their housing, at rest.
    pub installed_length: f64,
    /// Mass of both, kg.
    pub mass: f64,
}

/// Fewest active coils of a practical spring: with fewer, the closed ends would dominate the
/// stiffness.
pub const LEAST_ACTIVE_COILS: f64 = 2.0;
/// Number of closed and ground coils at both ends together.
const CLOSED_COILS: f64 = 2.0;
/// Fraction of its greatest deflection by which a spring stays open, so that no coils touch.
const CLEARANCE: f64 = 0.15;

/// Pair of coil springs with a stiffness k in N/m that holds a force F in N to either side.
///
/// ```text
/// each spring   k/2, preloaded by F/2 so that neither becomes slack: from 0 to F over 2 F/k
/// Wahl          tau = K_w 8 F C/(pi d^2),    K_w = (4 C - 1)/(4 C - 4) + 0.615/C
/// coils         k/2 = G d/(8 C^3 n)
/// length        2 ((n + 2) d + 0.15 (2 F/k) + F/k)
/// mass          2 rho (pi d^2/4) pi D (n + 2)
/// ```
///
/// Source: Wahl (1963), "Mechanical springs", second edition, McGraw-Hill.
///
/// # Example
/// A wire of that diameter carries the allowed stress, and the coils give the stiffness:
/// ```
/// use phea_hydraulics::series::{CoilWire, coil_pair};
/// let wire = CoilWire { index: 4.0, allowed_shear_stress: 6e8, shear_modulus: 81.5e9, density: 7850.0 };
/// let pair = coil_pair(2.24e6, 11e3, &wire);
/// let [wire_diameter, coil] = [pair.wire_diameter, pair.coil_diameter];
/// let stress = pair.wahl_factor * 8.0 * 11e3 * coil / (std::f64::consts::PI * wire_diameter.powi(3));
/// assert!((stress / 6e8 - 1.0).abs() < 1e-12);
/// let stiffness = 81.5e9 * wire_diameter.powi(4) / (8.0 * coil.powi(3) * pair.active_coils);
/// assert!((2.0 * stiffness / 2.24e6 - 1.0).abs() < 1e-12);
/// ```
pub fn coil_pair(stiffness: f64, force: f64, wire: &CoilWire) -> CoilPair {
    let CoilWire { index, allowed_shear_stress, shear_modulus, density } = *wire;
    let wahl_factor = (4.0 * index - 1.0) / (4.0 * index - 4.0) + 0.615 / index;
    let wire_diameter = (8.0 * wahl_factor * force * index / (PI * allowed_shear_stress)).sqrt();
    let coil_diameter = index * wire_diameter;
    let active_coils = shear_modulus * wire_diameter / (4.0 * index * index * index * stiffness);
    let coils = active_coils + CLOSED_COILS;
    let (solid_length, deflection) = (coils * wire_diameter, force / stiffness);
    let section = PI * wire_diameter * wire_diameter / 4.0;
    CoilPair {
        wahl_factor,
        wire_diameter,
        coil_diameter,
        active_coils,
        solid_length,
        installed_length: 2.0 * (solid_length + CLEARANCE * 2.0 * deflection + deflection),
        mass: 2.0 * density * section * PI * coil_diameter * coils,
    }
}
