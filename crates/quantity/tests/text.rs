//! Quantities in text: exact factors, errors with their location, and output without loss.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use phea_quantity::{self as quantity, *};

fn check(text: &str, dimension: &Dimension, expected: f64) {
    assert_eq!(parse(text, dimension), Ok(expected), "{text}");
}

#[test]
fn units_are_exact() {
    // ORIGIN: analytic, from the definitions 1 in = 25.4 mm, 1 lb = 0.45359237 kg, g = 9.80665
    // m/s2, 1 gal = 231 in3.
    check("70 bar", &PRESSURE, 70e5);
    check("12.7 mm", &LENGTH, 0.0127);
    check("0.5 in", &LENGTH, 0.0127);
    check("1 ft", &LENGTH, 0.3048);
    check("46 cSt", &KINEMATIC_VISCOSITY, 46e-6);
    check("46 mm2/s", &KINEMATIC_VISCOSITY, 46e-6);
    check("1000 psi", &PRESSURE, 6894757.293168361);
    check("10 gpm", &FLOW, 6.30901964e-4);
    check("9.8 L/min", &FLOW, 9.8e-3 / 60.0);
    check("4.7 cc/ft", &VOLUME_PER_LENGTH, 1.541_994_750_656_168e-5);
    check("20 MN/m", &STIFFNESS, 2e7);
    check("20 kN/mm", &STIFFNESS, 2e7);
    check("100 N.s/m", &DAMPING, 100.0);
    check("100 N s/m", &DAMPING, 100.0);
    check("100 N·s/m", &DAMPING, 100.0);
    check("1 N.s/mm", &DAMPING, 1000.0);
    check("3.2e-7 m3/(s.Pa^0.5)", &FLOW_COEFFICIENT, 3.2e-7);
    check("870 kg/m3", &DENSITY, 870.0);
    check("870 kg/m³", &DENSITY, 870.0);
    check("870 kg.m^-3", &DENSITY, 870.0);
    check("1583 mm^2", &AREA, 1583e-6);
    check("20 %", &RATIO, 0.2);
    check("1 1/s", &ANGULAR_FREQUENCY, 1.0);
    check(" 5ms ", &TIME, 5e-3);
    check("5 µs", &TIME, 5e-6);
    check("inf", &PRESSURE, f64::INFINITY);
}

#[test]
fn hertz_counts_cycles() {
    check("175 Hz", &ANGULAR_FREQUENCY, 175.0 * std::f64::consts::TAU);
    check("1 kHz", &ANGULAR_FREQUENCY, 1000.0 * std::f64::consts::TAU);
    check("1099 rad/s", &ANGULAR_FREQUENCY, 1099.0);
    check("60 rpm", &ANGULAR_FREQUENCY, std::f64::consts::TAU);
    check("360 deg", &ANGLE, std::f64::consts::TAU);
}

#[test]
fn square_roots_of_units() {
    let litres = parse("1 L/(min.bar^0.5)", &FLOW_COEFFICIENT).unwrap();
    let expected = 1e-3 / 60.0 / 1e5_f64.sqrt(); // ORIGIN: analytic
    assert!((litres / expected - 1.0).abs() < 1e-15);
}

#[test]
fn decibels_only_for_gains() {
    let six = parse("6 dB", &GAIN).unwrap();
    assert!((six - 1.9952623149688795).abs() < 1e-15); // ORIGIN: analytic, 10^(6/20)
    assert!(parse("6 dB", &RATIO).is_err());
}

fn refuse(text: &str, dimension: &Dimension, message: &str, help: Option<&str>) {
    let error = parse(text, dimension).unwrap_err();
    assert_eq!(error.to_string(), message, "{text}");
    assert_eq!(error.help.map(|help| help.to_string()).as_deref(), help, "{text}");
    assert!(text.is_char_boundary(error.range.start) && text.is_char_boundary(error.range.end), "{text}");
}

#[test]
fn refusals_state_the_correct_form() {
    refuse("70 mm", &PRESSURE, "expected a pressure, found a length", None);
    refuse("70 kg.m", &PRESSURE, "expected a pressure, found something in kg.m", None);
    refuse("70 baar", &PRESSURE, "unknown unit `baar`", Some("did you mean `bar`?"));
    refuse("70 BAR", &PRESSURE, "unknown unit `BAR`", Some("did you mean `bar`?"));
    refuse("7 Mpa", &PRESSURE, "unknown unit `Mpa`", Some("did you mean `MPa`?"));
    refuse(
        "7 psia",
        &PRESSURE,
        "unknown unit `psia`",
        Some("pressures are gauge here: subtract the atmospheric pressure"),
    );
    refuse("70", &PRESSURE, "this number has no unit", Some("add one, or write 70 without quotes for Pa"));
    refuse("bar", &PRESSURE, "a quantity begins with a number", None);
    refuse("", &PRESSURE, "an empty text", None);
    refuse("12,7 mm", &LENGTH, "a comma inside a number", Some("write 12.7 mm"));
    refuse("1e400 bar", &PRESSURE, "the number is too large", None);
    refuse("1e-400 bar", &PRESSURE, "the number is too small to be distinguished from zero", None);
    refuse("nan bar", &PRESSURE, "a quantity begins with a number", None);
    refuse(
        "1 m3/s.Pa",
        &FLOW_PRESSURE_COEFFICIENT,
        "a product after \"/\" can be read in two ways",
        Some("put parentheses around what is divided by, as in m3/(s.Pa)"),
    );
    refuse("1 m3/(s.Pa", &FLOW_PRESSURE_COEFFICIENT, "this parenthesis is not closed", None);
    refuse("1 m^x", &LENGTH, "expected an exponent such as 2, -1 or 0.5", None);
    refuse("1 m^0.3", &LENGTH, "expected an exponent such as 2, -1 or 0.5", None);
    refuse("0.9 12", &RATIO, "expected the name of a unit", None);
    refuse("1 m\u{a0}\u{2003}é", &LENGTH, "unknown unit `é`", None);
}

/// A number that two countries read differently by a factor of a thousand is rejected with both
/// readings.
#[test]
fn thousands_are_never_taken_for_decimals() {
    for (text, readings) in [
        ("20.000 N", "write 20 N or 20000 N"),
        ("-1.250 kN", "write -1.25 kN or -1250 kN"),
        ("1,234 kN", "write 1.234 kN or 1234 kN"),
        ("2,5 kN", "write 2.5 kN"),
        ("0,250 kN", "write 0.25 kN"),
        ("1.234,50 N", "write 1234.5 N"),
        ("1,234.5 N", "write 1234.5 N"),
        ("1.200.000 N", "write 1200000 N"),
        ("20 000 N", "write 20000 N"),
        ("20\u{a0}000 N", "write 20000 N"),
        ("20'000 N", "write 20000 N"),
        ("20_000 N", "write 20000 N"),
        ("1.2.3 N", "write the decimal sign as a point and no separators"),
    ] {
        let error = parse(text, &FORCE).unwrap_err();
        assert_eq!(error.help.as_ref().unwrap().to_string(), readings, "{text}: {error}");
    }
    // ORIGIN: analytic
    for (text, value) in [
        ("1.234 N", 1.234),
        ("0.870 N", 0.87),
        ("12.70 N", 12.7),
        ("1.000e3 N", 1000.0),
        ("5000.000 N", 5000.0),
    ] {
        check(text, &FORCE, value);
    }
    assert!(parse_price("1.200 EUR", PricedBy::Piece).is_err());
}

#[test]
fn a_percentage_is_a_number_of_percent() {
    for text in ["2 %", "2", "2 percent", "20 mm/m"] {
        check(text, &PERCENT, 2.0);
    }
    check("2 %", &RATIO, 0.02);
    refuse("2 mm", &PERCENT, "expected a percentage, found a length", None);
}

#[test]
fn units_are_spelled_as_data_sheets_spell_them() {
    // ORIGIN: analytic
    check("3 kNs/m", &DAMPING, 3000.0);
    check("3 Ns/mm", &DAMPING, 3000.0);
    check("3 kN.s/m", &DAMPING, 3000.0);
    check("40 Nm", &TORQUE, 40.0);
    check("1.2 kNm/rad", &TORSIONAL_STIFFNESS, 1200.0);
    check("1.5 Nms/rad", &TORSIONAL_DAMPING, 1.5);
    check("0.8 Vs/m", &VOLTAGE_PER_VELOCITY, 0.8);
    check("12 daN", &FORCE, 120.0);
    check("2 kip", &FORCE, 8896.443230521);
    check("100 cm3/U", &DISPLACEMENT, 1e-4 / std::f64::consts::TAU);
    check("40 mA", &CURRENT, 0.04);
    check("20 V.mA", &POWER, 0.02);
    check("37 °C", &TEMPERATURE, 37.0);
    refuse(
        "20 mA",
        &VOLTAGE,
        "expected a voltage, found a current",
        Some("commands are voltages: write the voltage at which the amplifier gives this current"),
    );
    // revolutions or radians: a factor of 2 pi
    assert!(parse("1500 1/min", &ANGULAR_VELOCITY).is_err());
    for text in ["3 kgs", "3 bars", "3 sN", "3 Nq"] {
        let error = parse(text, &MASS).unwrap_err();
        assert!(matches!(error.fault, QuantityFault::UnknownUnit(_)), "{text}: {error}");
    }
}

#[test]
fn nothing_panics() {
    for text in [
        "1 m^", "1 (", "1 ((m))", "1 m//s", "1 /", "1 .", "- 1 m", "1e", "1e+", "1 e5", "１ m", "1 m²²",
        "1 m^99", "1 1", "1 1/",
    ] {
        let _ = parse(text, &LENGTH);
    }
    assert!(parse(&"1 m".repeat(1000), &LENGTH).is_err());
}

/// Fixed sequence of numbers over many decades.
fn numbers(count: u64) -> impl Iterator<Item = f64> {
    (0..count).scan(0x9e37_79b9_7f4a_7c15_u64, |state, _| {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        Some(f64::from_bits(*state)).filter(|x| x.is_finite()).or(Some(1.0))
    })
}

#[test]
fn printing_loses_nothing() {
    for dimension in DIMENSIONS {
        for value in numbers(300).chain([0.0, 1.0, 70e5, 2.236e-12, 1.0 / 3.0, 0.0127]) {
            let text = quantity::print(value, dimension);
            let back = match text.strip_prefix('"') {
                Some(inner) => parse(inner.trim_end_matches('"'), dimension).unwrap(),
                None => text.parse().unwrap(),
            };
            assert_eq!(back.to_bits(), value.to_bits(), "{text} for {}", dimension.name);
        }
    }
}

#[test]
fn people_read_their_own_units() {
    let cases: [(f64, &Dimension, &str); 9] = [
        (1.45e9, &PRESSURE, "\"1.45 GPa\""),
        (70e5, &PRESSURE, "\"70 bar\""),
        (0.0, &PRESSURE, "\"0 Pa\""),
        (2e7, &STIFFNESS, "\"20 kN/mm\""),
        (9.8e-3 / 60.0, &FLOW, "\"9.8 L/min\""),
        (0.05, &TIME, "\"50 ms\""),
        (13.1, &MASS, "\"13.1 kg\""),
        (1099.0, &ANGULAR_FREQUENCY, "\"1099 rad/s\""),
        (0.9, &RATIO, "0.9"),
    ];
    for (value, dimension, text) in cases {
        assert_eq!(quantity::print(value, dimension), text);
    }
}

/// Units of tables.
static READ_IN: [(&str, &Dimension); 14] = [
    ("Pa", &PRESSURE),
    ("bar", &PRESSURE),
    ("psi", &PRESSURE),
    ("ksi", &PRESSURE),
    ("L/min", &FLOW),
    ("gpm", &FLOW),
    ("ms", &TIME),
    ("Hz", &ANGULAR_FREQUENCY),
    ("deg", &ANGLE),
    ("%", &RATIO),
    ("%", &PERCENT),
    ("", &PERCENT),
    ("", &RATIO),
    ("dB", &GAIN),
];

/// A scale reads every number as [`parse`] does with its unit, to the last bit.
#[test]
fn a_scale_is_a_quantity_without_its_unit() {
    for (unit, dimension) in READ_IN {
        let scale = UnitScale::new(unit, dimension).unwrap();
        let check = |text: &str| {
            // a number of the rows of a table has no thousands
            let power = if text.contains('.') && !text.contains('e') { "e0" } else { "" };
            let exact = parse(&format!("{text}{power} {unit}"), dimension);
            let expected = exact.ok().filter(|value| value.is_finite());
            assert_eq!(scale.read(text).map(f64::to_bits), expected.map(f64::to_bits), "{text} {unit}");
        };
        for value in numbers(300) {
            // every number of digits, in the decades of a test bench and in the full range
            let digits = (value.to_bits() % 18) as usize;
            let text = format!("{value:.digits$e}");
            let (mantissa, exponent) = text.split_once('e').unwrap();
            check(mantissa);
            check(&format!("{mantissa}e{}", exponent.parse::<i32>().unwrap() % 10));
            check(&format!("{value:e}"));
        }
        for text in [
            "0",
            "-0",
            "+7",
            "0.000",
            ".5",
            "-.25",
            "1e5",
            "1E+05",
            "1e-30",
            "1e-300",
            "1e300",
            "1e999",
            "inf",
            "nan",
            "",
            "-",
            ".",
            "1e",
            "1e+",
            "1.2.3",
            "1,5",
            "9007199254740993",
            "12345678901234567890",
            "0.69976806640625",
            "123456789012345678901234567890e-25",
            "0x10",
            "１",
        ] {
            check(text);
        }
        assert_eq!(["1 ", "1 bar", "1,5"].map(|text| scale.read(text)), [None; 3]);
        assert_eq!(scale.read("5.").map(f64::to_bits), scale.read("5").map(f64::to_bits));
    }
    assert_eq!(
        UnitScale::new("mm", &PRESSURE).unwrap_err().to_string(),
        "expected a pressure, found a length"
    );
    assert_eq!(UnitScale::new("", &PRESSURE).unwrap_err().fault, QuantityFault::NoUnit);
    assert_eq!(
        UnitScale::new("baar", &PRESSURE).unwrap_err().help,
        Some(Box::new(QuantityHint::NearUnit("bar")))
    );
}

/// A display unit is found again by its symbol and size, and none is missing in the list.
#[test]
fn display_units_have_known_symbols() {
    let declared = include_str!("../src/display_unit.rs").matches(": Self = DisplayUnit {").count();
    assert_eq!(DisplayUnit::ALL.len(), declared);
    for unit in DisplayUnit::ALL {
        assert_eq!(known_unit(unit.symbol, unit.in_si), Some(unit));
    }
    assert_eq!(known_unit("EUR", 1.0).unwrap().symbol, "EUR");
}
