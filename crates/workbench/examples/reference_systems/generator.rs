//! The random systems themselves: the same hundred on every machine.

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{cos, exp, magnitude, pow, sin};

/// A system in the form in which it is handed to both sides.
pub(super) struct ReferenceSystem {
    pub(super) form: Form,
}

pub(super) enum Form {
    Factored(TransferFunction),
    States(StateSpace),
}

const COUNT: usize = 100;

/// Alternately factored and state space, orders 1 to 8; every fifth sampled, every seventh with an
/// integrator.
pub(super) fn reference_systems() -> Result<Vec<ReferenceSystem>, LinearError> {
    let mut seeded = Seeded(2019);
    let mut systems = Vec::with_capacity(COUNT);
    for index in 0..COUNT {
        let order = 1 + (index / 2) % 8;
        let states = index % 2 == 1;
        // in dense coordinates a double carries fewer decades than factors do
        let decades = if states { 2.0 } else { 5.0 };
        let factors = seeded.system(order, decades, index % 5 == 3, index % 7 == 2)?;
        let form = if states {
            Form::States(seeded.mixed(&StateSpace::from_transfer_function(&factors)?)?)
        } else {
            Form::Factored(factors)
        };
        systems.push(ReferenceSystem { form });
    }
    Ok(systems)
}

/// Seeded numbers in [0, 1): splitmix64.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Roots with magnitudes from 0.1 rad/s up, about half of them in complex pairs with damping
    /// above 2 %.
    fn roots(&mut self, count: usize, decades: f64, unstable_fraction: f64) -> Vec<Complex64> {
        let mut roots = Vec::with_capacity(count);
        while roots.len() < count {
            let size = pow(10.0, -1.0 + decades * self.next());
            let side = if self.next() < unstable_fraction { 1.0 } else { -1.0 };
            if self.next() < 0.4 || roots.len() + 2 > count {
                roots.push(Complex64::new(side * size, 0.0));
            } else {
                let angle = 1.55 * self.next();
                let (re, im) = (side * size * cos(angle), size * sin(angle));
                roots.extend([Complex64::new(re, im), Complex64::new(re, -im)]);
            }
        }
        roots
    }

    fn system(
        &mut self,
        order: usize,
        decades: f64,
        sampled: bool,
        integrator: bool,
    ) -> Result<TransferFunction, LinearError> {
        let zero_count = (1..=order).filter(|_| self.next() < 0.5).count();
        let zeros = self.roots(zero_count, decades, 0.25);
        let mut poles = self.roots(order, decades, if order > 3 { 0.02 } else { 0.1 });
        let real = poles.iter().position(|pole| pole.im == 0.0);
        if let Some(index) = real.filter(|_| integrator) {
            poles[index] = Complex64::new(0.0, 0.0);
        }
        // gain of a few at the frequency of a pole in the middle, so that crossings are usual
        let sizes: Vec<f64> = poles.iter().map(|pole| magnitude(*pole)).collect();
        let middle = sizes.get(order / 2).copied().filter(|size| *size > 0.0).unwrap_or(1.0);
        let shape = TransferFunction::from_factors(1.0, zeros.clone(), poles.clone())?;
        let level = pow(10.0, 1.5 * self.next() - 0.5) / magnitude(shape.at_frequency(1.1 * middle));
        let system = TransferFunction::from_factors(level, zeros, poles)?;
        if sampled { self.as_sampled(&system) } else { Ok(system) }
    }

    /// Roots mapped by z = exp(sT) with T from the fastest pole: a sampled system with roots all
    /// over the disc.
    fn as_sampled(&mut self, system: &TransferFunction) -> Result<TransferFunction, LinearError> {
        let fastest = system.poles().iter().map(|pole| magnitude(*pole)).fold(0.1, f64::max);
        let sample_time_s = (0.2 + self.next()) / fastest;
        let image = |root: &Complex64| {
            let (size, angle) = (exp(root.re * sample_time_s), root.im * sample_time_s);
            Complex64::new(size * cos(angle), size * sin(angle))
        };
        let zeros: Vec<Complex64> = system.zeros().iter().map(image).collect();
        let poles: Vec<Complex64> = system.poles().iter().map(image).collect();
        let domain = TimeDomain::Discrete { sample_time_s };
        let shape = TransferFunction::from_factors(1.0, zeros.clone(), poles.clone())?.in_domain(domain)?;
        let level = 2.0 * self.next() / magnitude(shape.at_frequency(0.5 / sample_time_s));
        TransferFunction::from_factors(level, zeros, poles)?.in_domain(domain)
    }

    /// The same system in coordinates that mix all states and have their own units.
    fn mixed(&mut self, system: &StateSpace) -> Result<StateSpace, LinearError> {
        let order = system.order();
        let units: Vec<f64> = (0..order).map(|_| pow(10.0, 6.0 * (self.next() - 0.5))).collect();
        let mix = DMatrix::from_fn(order, order, |i, j| {
            let entry = if i == j { 1.0 } else { 0.4 * (self.next() - 0.5) };
            entry * units[i]
        });
        let back = mix.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(order, order));
        StateSpace::new(
            &mix * system.a() * &back,
            &mix * system.b(),
            system.c() * &back,
            system.d().clone(),
            system.domain(),
        )
    }
}
