use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::line::{Hose, Line, StiffeningMember};

use super::list::List;

/// The modulus of the fluid, and the lines from the valve to the chambers.
pub(super) fn lines(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let moduli =
        [rig.point.pressure_a, rig.point.pressure_b].map(|pressure| components.fluid.modulus_at(pressure));
    let sides = [("a", components.line_a, moduli[0]), ("b", components.line_b, moduli[1])];
    let same = components.line_a == components.line_b && moduli[0] == moduli[1];
    list.group("Lines");
    list.add(
        "fluid.bulk_modulus_at_pressure",
        "β_0",
        moduli[0],
        "Pa",
        "β_0(p) = -V dp/dV, entrained air included",
    );
    for (side, line, modulus) in sides.into_iter().take(if same { 1 } else { 2 }) {
        let name = |quantity: &str| {
            if same { format!("line.{quantity}") } else { format!("line.{side}.{quantity}") }
        };
        list.add(name("volume"), "V_ho", line.volume(), "m3", "V_{ho} = π/4 D_{ho}^2 L_{ho}");
        if let Line::Hose { hose, .. } = line {
            hose_wall(hose, &name, list);
        }
        let effective = line.effective_modulus(modulus, StiffeningMember::Nominal);
        list.add(name("effective_modulus"), "β_e", effective, "Pa", "1/β_e = 1/β_0 + 1/β_{ho}");
        if let Line::Hose { .. } = line {
            let softest = line.effective_modulus(modulus, StiffeningMember::Minimum);
            list.add(
                name("effective_modulus_minimum"),
                "β_e",
                softest,
                "Pa",
                "β_e at the least stiffening r_β",
            );
            let stiffest = line.effective_modulus(modulus, StiffeningMember::Maximum);
            list.add(
                name("effective_modulus_maximum"),
                "β_e",
                stiffest,
                "Pa",
                "β_e at the greatest stiffening r_β",
            );
        }
        let compliance = line.compliance(modulus, StiffeningMember::Nominal);
        let equation = match line {
            Line::Hose { .. } => "C_{ho} = ε L_{ho}/r_β + (A_{ho} + E(p)) L_{ho}/β_0",
            Line::Pipe { .. } | Line::Volume { .. } => "C_{ho} = V_{ho}/β_e",
        };
        list.add(name("compliance"), "C_ho", compliance, "m3/Pa", equation);
        // a wave runs in the oil that fills the bore
        let filled = line.filled().effective_modulus(modulus, StiffeningMember::Nominal);
        let wave_speed = (filled / components.fluid.density).sqrt();
        list.add(name("wave_speed"), "c", wave_speed, "m/s", "c = sqrt(β_e(p)/ρ)");
        if let Line::Hose { length, .. } | Line::Pipe { length, .. } = line {
            list.add(name("wave_travel_time"), "T", length / wave_speed, "s", "T = L_{ho}/c");
        }
    }
}

fn hose_wall(hose: Hose, name: &impl Fn(&str) -> String, list: &mut List) {
    list.add(
        name("volumetric_expansion"),
        "E",
        hose.volumetric_expansion,
        "m3/m",
        "E(p_S) = E_1 + ε (p_S - p_1)",
    );
    list.add(
        name("operating_expansion"),
        "E(p)",
        hose.operating_expansion,
        "m3/m",
        "E(p) = E_1 + ε (p - p_1), p = (p_S + p_T)/2",
    );
    list.add(name("static_modulus"), "β_hoSS", hose.static_modulus(), "Pa", "β_{hoSS} = (A_{ho} + E)/ε");
    list.add(
        name("dynamic_modulus"),
        "β_ho",
        hose.wall_modulus(StiffeningMember::Nominal),
        "Pa",
        "β_{ho} = r_β β_{hoSS}",
    );
}
