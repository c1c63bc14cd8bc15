//! Temperatures in degrees Celsius, and units as data sheets write them.

use super::*;
use peridyne::spec::DiffusionSpec;

const BAR: &str = r#"body = { lattice = "chain", spacing = "1 mm", cells = [20] }
horizon = { m_ratio = 3 }
run = { duration = "1 ms" }
[material]
density = "7.85 g/cm^3"
law = { pmb = { young = "210 kN/mm^2" } }
heat = { conductivity = "45 W/(m·K)", capacity = "0.46 kJ/(kg K)", expansion = "12e-6 1/K" }
[heat]
reference = "20 degC"
[[initial]]
temperature = "25 °C"
[[boundary_condition]]
region = { block = { low = "-1 mm", high = "1 mm" } }
convection = { coefficient = "25 W/m²/degC", ambient = "-10 degC" }
"#;

fn heat(text: &str) -> DiffusionSpec {
    let deck = Deck::parse(text, "bar.toml", &[]);
    let deck = deck.unwrap_or_else(|e| panic!("{e} {:?} {:?}", e.line, e.help));
    assert_eq!(deck.warnings, [""; 0]);
    deck.spec.interactions.diffusions[0].clone()
}

fn refused(from: &str, to: &str) -> (String, String, Option<usize>) {
    assert!(BAR.contains(from), "{from}");
    let error = Deck::parse(&BAR.replace(from, to), "bar.toml", &[]).unwrap_err();
    (
        error.to_string(),
        error.help.unwrap_or_default(),
        error.line,
    )
}

#[test]
fn degrees_celsius_are_kelvin_with_another_zero() {
    let heat = heat(BAR);
    assert_eq!(heat.reference, 293.15);
    assert_eq!(heat.initial[0].1.as_constant(), Some(298.15));
    let material = &heat.materials[0];
    assert_eq!(material.conductivity, 45.0);
    assert_eq!(material.capacity, 460.0);
    assert_eq!(material.expansion, 12e-6);
    let said = format!("{:?}", heat.conditions[0]);
    assert!(said.contains("263.15"), "{said}");
}

#[test]
fn the_same_deck_in_kelvin_is_the_same() {
    let kelvin = BAR
        .replace("20 degC", "293.15 K")
        .replace("25 °C", "298.15 K")
        .replace("-10 degC", "263.15 K")
        .replace("W/m²/degC", "W/m^2/K");
    let [celsius, kelvin] = [BAR, &kelvin].map(|text| {
        let said = format!("{:?}", heat(text));
        // but for how it is written
        let parts = said
            .split("source: ")
            .map(|part| part.rsplit_once("program").map_or(part, |p| p.1));
        parts.collect::<Vec<_>>().concat()
    });
    assert!(kelvin.contains("Push(263.15)"), "{kelvin}");
    assert_eq!(celsius, kelvin);
}

#[test]
fn where_celsius_could_mean_two_things_it_is_refused() {
    for wrong in [
        "\"20 degC + 5 K\"",
        "\"20 degC * t / 1 s\"",
        "\"2*(20 °C)\"",
    ] {
        let (message, _, line) = refused("\"25 °C\"", wrong);
        assert!(
            message.contains("20 K for a difference"),
            "{wrong}: {message}"
        );
        assert_eq!(line, Some(11), "{wrong}");
    }
    // a rise per length is a difference, whatever the zero
    let rise = BAR.replace("25 °C", "293.15 K + 5 degC/mm * x");
    assert!(Deck::parse(&rise, "bar.toml", &[]).is_ok());
    let constant = format!("constants = {{ warm = \"20 degC\" }}\n{BAR}");
    let error = Deck::parse(&constant, "bar.toml", &[]).unwrap_err();
    assert_eq!(error.line, Some(1));
    assert!(error.to_string().contains("constants"), "{error}");
    let (message, _, line) = refused("\"7.85 g/cm^3\"", "\"20 degC\"");
    assert!(message.contains("whole of a temperature"), "{message}");
    assert_eq!(line, Some(5));
    let (message, help, _) = refused("25 °C", "-300 °C");
    assert!(
        message.contains("absolute zero") && help.contains("in K"),
        "{message}"
    );
}

#[test]
fn zero_kelvin_is_no_default_beside_celsius() {
    let (message, help, _) = refused("reference = \"20 degC\"\n", "");
    assert!(message.contains("heat.reference is 0 K"), "{message}");
    assert!(help.contains("reference = \"20 degC\" in [heat]"), "{help}");
    let deck = BAR.replace("reference = \"20 degC\"", "reference = 20");
    let deck = Deck::parse(&deck, "bar.toml", &[]).unwrap();
    assert_eq!(deck.warnings.len(), 1, "{:?}", deck.warnings);
    assert!(
        deck.warnings[0].starts_with("bar.toml:9: 20 is in kelvin"),
        "{:?}",
        deck.warnings
    );
}

#[test]
fn numbers_without_units_have_no_celsius() {
    let plain = format!("units = \"none\"\n{}", BAR.replace('"', "'"));
    let error = Deck::parse(&plain, "bar.toml", &[]).unwrap_err();
    assert!(!error.to_string().is_empty());
}

#[test]
fn other_units_say_what_to_write() {
    for (wrong, says) in [("20 degF", "(68 + 459.67)/1.8 K"), ("20 C", "written degC")] {
        let (message, ..) = refused("25 °C", wrong);
        assert!(message.contains(says), "{wrong}: {message}");
    }
    for (wrong, says) in [
        ("1 MPa*sqrt(m)", "K²/E"),
        ("1 MPa m^0.5", "K²/E"),
        ("1 MPa*m^(1/2)", "K²/E"),
    ] {
        let deck = IMPACT.replace(
            "fracture = { critical_stretch = 0.0005, alpha = 0.25 }",
            &format!("fracture = {{ energy = \"{wrong}\" }}"),
        );
        let error = Deck::parse(&deck, "impact.toml", &[]).unwrap_err();
        let help = error.help.clone().unwrap_or_default();
        assert!(help.contains(says), "{wrong}: {error} {help}");
        assert!(error.line.is_some(), "{wrong}");
    }
    // and that is right: (0.75e6)² · 1/72e9 = 7.8125 J/m²
    let deck = IMPACT.replace(
        "fracture = { critical_stretch = 0.0005, alpha = 0.25 }",
        "fracture = { energy = \"(0.75 MPa)^2 * 1 m / 72 GPa\" }",
    );
    let spec = parse(&deck).spec;
    let fracture = spec.materials[0].fracture.as_ref().unwrap();
    let Criterion::Energy(energy) = fracture.criterion else {
        panic!("{fracture:?}");
    };
    assert!((energy - 7.8125).abs() < 1e-12, "{energy}");
}

/// Slashes behind a number divide each by what follows, as they do between numbers.
#[test]
fn each_slash_divides() {
    for (text, value) in [
        ("2/s/mm * x * (1 mm)", 0.04),
        ("2 1/s/mm * x * (1 mm)", 0.04),
        ("2 1/(s mm) * x * (1 mm)", 0.04),
        ("120 deg/s * x", 120.0_f64.to_radians() * 0.02),
        ("60 N/mm / (1e3 kg/m/s)", 60.0),
    ] {
        let spec = with("initial.0.velocity.y", text);
        let spec = spec
            .unwrap_or_else(|e| panic!("{text}: {e} {:?}", e.help))
            .spec;
        let velocity = spec.loading.initial[0].velocity[1].as_ref().unwrap();
        let found = velocity.eval(&[0.02, 0.0, 0.0], 0.0);
        assert!((found - value).abs() < 1e-14 * value, "{text}: {found}");
    }
}
