//! Fluid, lines, orifice and friction: limits, conservation and consistency.

use phea_dynamics::scalar::{Dual, Parameters, Scalar};
use phea_dynamics::simulation::DIRECTIONS;
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid, bulk_modulus_with_air};
use phea_hydraulics::friction::{Friction, FrictionLevels, LuGre, LuGrePassivity, Stribeck, StribeckShape};
use phea_hydraulics::line::{
    Anchoring, Hose, Line, Pipe, PipeWall, Stiffening, StiffeningMember, pipe_wall_compliance,
};
use phea_hydraulics::orifice::{flow, regular_root, regular_root_slope};
use phea_hydraulics::reference_rig::{hose, hose_line};

/// The modulus equals -V dp/dV of the volumes from which it is derived.
#[test]
fn bulk_modulus_with_air_is_the_slope_of_the_volume() {
    fn volume<S: Scalar>(p: S) -> S {
        let reference = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let liquid = S::from(0.97) * ((reference - p) / S::from(1.45e9)).exp();
        liquid + S::from(0.03) * ((reference / p).ln() / S::from(1.25)).exp()
    }
    for pressure in [0.3e5, 1e5, 10e5, 70e5, 400e5] {
        let v = volume(Dual::<DIRECTIONS>::variable(pressure, 0));
        let expected = -v.value() / v.gradient()[0];
        let found: f64 = bulk_modulus_with_air(1.45e9, 0.03, 1.25, pressure);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} against {expected}");
    }
}

#[test]
fn air_softens_less_the_higher_the_pressure() {
    let fluid = |volume_fraction| Fluid {
        bulk_modulus: 1.45e9,
        density: 870.0,
        kinematic_viscosity: 46e-6,
        entrained_air: Some(EntrainedAir { volume_fraction, polytropic_exponent: 1.4 }),
        vapour_pressure_absolute: 0.0,
    };
    let mut last = 0.0;
    for pressure in [0.0, 5e5, 20e5, 70e5, 300e5] {
        let modulus = fluid(0.02).modulus_at(pressure);
        assert!(modulus > last && modulus < 1.45e9);
        last = modulus;
    }
    // ORIGIN: analytic, the limits of no air and of infinite pressure
    assert!((fluid(0.0).modulus_at(20e5) / 1.45e9 - 1.0).abs() < 1e-15);
    assert!((fluid(0.02).modulus_at(1e9) / 1.45e9 - 1.0).abs() < 2e-5);
    let clean = Fluid { entrained_air: None, ..fluid(0.0) };
    let excessive = EntrainedAir { volume_fraction: 1.0, polytropic_exponent: 0.5 };
    let problems = Fluid { entrained_air: Some(excessive), ..clean }.problems();
    assert_eq!(problems.len(), 2);
}

#[test]
fn thick_walls_become_thin_ones() {
    for anchoring in [Anchoring::Throughout, Anchoring::OneEnd, Anchoring::ExpansionJoints] {
        let ratio = |thickness: f64| {
            let of = |thick| pipe_wall_compliance(10e-3, thickness, 206e9, 0.3, anchoring, thick);
            of(true) / of(false)
        };
        assert!((ratio(1e-6) - 1.0).abs() < 3e-4 && (ratio(1e-3) - 1.0).abs() > 0.05);
    }
    let compliance = |anchoring| pipe_wall_compliance(10e-3, 1e-3, 206e9, 0.3, anchoring, false);
    assert!(compliance(Anchoring::OneEnd) < compliance(Anchoring::Throughout));
    assert!(compliance(Anchoring::Throughout) < compliance(Anchoring::ExpansionJoints));
}

#[test]
fn elastic_pipe_is_a_little_softer_than_its_fluid() {
    let wall = PipeWall::Elastic {
        thickness: 1.5e-3,
        youngs_modulus: 206e9,
        poisson_ratio: 0.3,
        anchoring: Anchoring::Throughout,
        thick: true,
    };
    let line = |wall| Line::Pipe { pipe: Pipe { bore: 10.5e-3, wall }, length: 0.35 };
    let (rigid, elastic) = (line(PipeWall::Rigid), line(wall));
    assert_eq!(rigid.effective_modulus(1.45e9, StiffeningMember::Nominal), 1.45e9);
    let modulus = elastic.effective_modulus(1.45e9, StiffeningMember::Nominal);
    assert!(modulus < 0.97 * 1.45e9 && modulus > 0.9 * 1.45e9);
    // ORIGIN: analytic, fluid and wall take up volume in parallel
    let fluid = rigid.compliance(1.45e9, StiffeningMember::Nominal);
    let taken_by_wall = elastic.compliance(1.45e9, StiffeningMember::Nominal) - fluid;
    let Line::Pipe { pipe, .. } = elastic else { panic!() };
    assert!((taken_by_wall / (elastic.volume() * pipe.wall_compliance()) - 1.0).abs() < 1e-12);
}

/// The thesis multiplies a modulus of the expanded bore by the unexpanded volume; a hose's sheet
/// states the expansion of its wall.
#[test]
fn a_hose_has_the_expansion_of_its_data_sheet() {
    let (hose, line) = (hose(), hose_line());
    let bore_area = std::f64::consts::FRAC_PI_4 * 12.7e-3 * 12.7e-3;
    for (member, r_beta) in [(StiffeningMember::Minimum, 4.0), (StiffeningMember::Nominal, 5.0)] {
        // ORIGIN: analytic, dV/dp = epsilon L/r_beta + (A_ho + E(35 bar)) L/beta_0
        let (wall, oil) = (2.236e-12 * 1.5 / r_beta, (bore_area + 7.774e-6) * 1.5 / 1.45e9);
        assert!((line.compliance(1.45e9, member) / (wall + oil) - 1.0).abs() < 1e-12);
        assert!((line.filled().volume() / (1.45e9 * oil) - 1.0).abs() < 1e-12);
        let of_modulus = line.filled().volume() / line.filled().effective_modulus(1.45e9, member);
        assert!((of_modulus / (wall + oil) - 1.0).abs() < 1e-12);
        // ORIGIN: analytic, thesis (6.24) leaves A_ho/(A_ho + E(70 bar)) of the wall and the oil of
        // the unexpanded bore
        let printed = wall * bore_area / (bore_area + 1.56e-5) + bore_area * 1.5 / 1.45e9;
        assert!((line.compliance_of_unexpanded(1.45e9, member) / printed - 1.0).abs() < 1e-12);
    }
    let empty = Hose { operating_expansion: -2e-4, ..hose };
    assert_eq!(empty.problems()[0].quantity, "operating_expansion");
}

#[test]
fn impossible_lines_are_refused() {
    let soft = Hose { dynamic_stiffening: Stiffening { nominal: 3.0, minimum: 4.0, maximum: 2.0 }, ..hose() };
    let problems = Line::Hose { hose: soft, length: -1.0 }.problems();
    let names: Vec<&str> = problems.iter().map(|problem| problem.quantity.as_str()).collect();
    let expected = ["hose.dynamic_stiffening.nominal", "hose.dynamic_stiffening.maximum", "length"];
    assert_eq!(names, expected);
}

#[test]
fn regular_root_is_smooth_odd_and_rising() {
    let mut last = f64::NEG_INFINITY;
    for step in -400..=400 {
        let drop = 25.0 * f64::from(step);
        let root = regular_root(Dual::<DIRECTIONS>::variable(drop, 0), Dual::constant(1e3));
        assert!(root.value() > last && root.gradient()[0] > 0.0);
        assert!((root.gradient()[0] / regular_root_slope(drop, 1e3) - 1.0).abs() < 1e-13);
        assert_eq!(regular_root(-drop, 1e3), -root.value());
        last = root.value();
    }
    // ORIGIN: analytic, 1 - (1 + 1/r^2)^(-1/4) at r transition pressures
    for ratio in [10.0_f64, 100.0] {
        let missing = 1.0 - flow(2.0, ratio * 1e3, 1e3) / (2.0 * (ratio * 1e3).sqrt());
        assert!((missing - 0.25 / (ratio * ratio)).abs() < 0.01 / (ratio * ratio));
    }
}

fn curve() -> Stribeck {
    Stribeck {
        coulomb: 80.0,
        static_friction: 120.0,
        stribeck_velocity: 0.01,
        stribeck_exponent: 2.0,
        viscous: 100.0,
        retracting: None,
    }
}

#[test]
fn the_slope_of_the_steady_curve_is_the_closed_form() {
    use phea_dynamics::scalar::Dual;
    // ORIGIN: analytic, dF/dv = sigma_2 - 2 (F_S - F_C) v/v_S^2 exp(-(v/v_S)^2)
    let expected = 100.0 - 2.0 * 40.0 * 0.005 / 1e-4 * phea_dynamics::portable::exp(-0.25);
    let along =
        curve().convert(&mut Dual::<DIRECTIONS>::from).steady_force(Dual::<DIRECTIONS>::variable(0.005, 0));
    assert!((along.gradient()[0] / expected - 1.0).abs() < 1e-12);
    let lugre = Friction::LuGre(LuGre { curve: curve(), bristle_stiffness: 1e7, bristle_damping: 2e3 });
    assert_eq!((lugre.viscous(), Friction::Viscous { viscous: 55.0 }.viscous()), (100.0, 55.0));
}

#[test]
fn derivatives_of_friction_exist_at_standstill() {
    for exponent in [0.5, 1.0, 2.0] {
        let curve =
            Stribeck { stribeck_exponent: exponent, ..curve() }.convert(&mut Dual::<DIRECTIONS>::from);
        let lugre =
            LuGre { curve, bristle_stiffness: Dual::constant(1e7), bristle_damping: Dual::constant(2e3) };
        let force = lugre.force(Dual::variable(0.0, 0), Dual::variable(3e-6, 1));
        // ORIGIN: analytic, dF/dv = sigma_1 + sigma_2 and dF/dz = sigma_0 where |v| has slope zero
        assert!((force.gradient()[0] - 2100.0).abs() < 1e-9 && force.gradient()[1] == 1e7);
    }
}

/// Absorbed power less power stored in the bristles, F v - sigma_0 z dz/dt, at any velocity and any
/// deflection that the model can reach (|sigma_0 z| <= F_S): never negative if the condition holds,
/// negative somewhere just beyond it.
#[test]
fn lugre_gives_no_energy_exactly_when_it_is_passive() {
    let least_dissipation = |lugre: LuGre| {
        let mut least = f64::INFINITY;
        for i in -120..=120 {
            for exponent in -40..=30 {
                let z = 1e-7 * f64::from(i);
                let v = phea_dynamics::portable::pow(10.0, 0.1 * f64::from(exponent));
                let stored = lugre.bristle_stiffness * z * lugre.bristle_rate(v, z);
                least = least.min((lugre.force(v, z) * v - stored) / v);
            }
        }
        least
    };
    // sigma_1 (F_S - F_C)/F_C = 100 at sigma_1 = 200
    let at = |bristle_damping| LuGre { curve: curve(), bristle_stiffness: 1e7, bristle_damping };
    assert_eq!(at(200.0).passivity(), LuGrePassivity::Passive { surplus: 0.0 });
    assert!(least_dissipation(at(200.0)) >= 0.0);
    assert!(matches!(at(205.0).passivity(), LuGrePassivity::NotPassive { .. }));
    assert!(least_dissipation(at(205.0)) < 0.0);
}

/// Friction with greater resistance in retraction.
fn harder_back() -> LuGre {
    let retracting = Some(FrictionLevels { coulomb: 110.0, static_friction: 160.0, viscous: 130.0 });
    LuGre { curve: Stribeck { retracting, ..curve() }, bristle_stiffness: 1e7, bristle_damping: 200.0 }
}

/// Friction by direction has in each direction the curve of a friction with its levels in both
/// directions, and at a reversal neither force nor rate of the bristles jumps, for any deflection.
#[test]
fn friction_by_direction_is_one_friction_for_each_and_continuous_between_them() {
    let both = harder_back();
    let back = Stribeck { coulomb: 110.0, static_friction: 160.0, viscous: 130.0, ..curve() };
    for velocity in [1e-5, 3e-3, 0.02, 0.4] {
        assert_eq!(both.curve.steady_force(velocity), curve().steady_force(velocity));
        assert_eq!(both.curve.steady_force(-velocity), -back.steady_force(velocity));
    }
    for deflection in [-1.6e-5, -4e-6, 0.0, 7e-6, 1.2e-5] {
        let [more, less] = [1e-12, -1e-12].map(|velocity| both.force(velocity, deflection));
        assert!((more - less).abs() < 1e-8, "{more} {less}");
    }
    let [more, less] =
        [1e-12, -1e-12].map(|velocity| both.curve.regular_force(StribeckShape::Squared, velocity, 1e-4));
    assert!((more - less).abs() < 1e-5, "{more} {less}");
}

/// Bristles in slow reciprocation carry -g of retracting and g of extending alternately; the energy
/// of a whole cycle is the sum of both over the distance.
#[test]
fn a_slow_cycle_takes_the_friction_of_each_direction() {
    let both = harder_back();
    let (speed, turns, parts) = (0.05, 2, 40_000);
    let step = 0.1 / speed / f64::from(parts);
    let (mut deflection, mut taken) = (0.0, [0.0; 2]);
    for way in [1.0, -1.0].repeat(turns) {
        let velocity = way * speed;
        for _ in 0..parts {
            let carried = both.curve.sliding_force(velocity);
            let settled = way * carried / both.bristle_stiffness;
            let decay = phea_dynamics::portable::exp(-both.bristle_stiffness * speed * step / carried);
            deflection = settled + (deflection - settled) * decay;
            taken[usize::from(way < 0.0)] += both.force(velocity, deflection) * velocity * step;
        }
    }
    // force times distance in each direction; the bristles take a short distance to reverse
    for (found, force) in taken.iter().zip([85.0, 116.5]) {
        let expected = turns as f64 * 0.1 * force;
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
}

/// The stricter direction decides on passivity.
#[test]
fn friction_by_direction_is_passive_where_both_directions_are() {
    let passive = harder_back();
    // ORIGIN: analytic, sigma_1 (F_S - F_C)/F_C: 100 of 100 N s/m extending, 90.9 of 130 retracting
    assert_eq!(passive.passivity(), LuGrePassivity::Passive { surplus: 0.0 });
    let levels = FrictionLevels { coulomb: 80.0, static_friction: 160.0, viscous: 130.0 };
    let worse = LuGre { curve: Stribeck { retracting: Some(levels), ..curve() }, ..passive };
    assert_eq!(worse.passivity(), LuGrePassivity::NotPassive { required_viscous: 200.0 });
    let below = FrictionLevels { static_friction: 70.0, ..levels };
    let impossible = Stribeck { retracting: Some(below), ..curve() };
    assert_eq!(impossible.problems()[0].quantity, "retracting.static");
}
