//! Constants that cannot be are refused, by the key and with the reason, whatever the law of the registry.

use peridyne::law::descriptor::{Bounds, Need, Value};
use peridyne::run::Registry;
use peridyne::spec::{LawSpec, Parameter, Parameters};

/// Keys of solids whose numbers may have any sign, and what judges them instead.
const FREE: &[(&str, &str, &str)] = &[
    (
        "eam_like",
        "volume",
        "with `pair`: the bulk modulus is positive",
    ),
    (
        "anisotropic",
        "poisson",
        "with `young`: the compliance is positive",
    ),
    ("anisotropic", "stiffness", "it is that of a stable solid"),
    ("lamina", "fibre", "a row of bonds lies along it"),
    (
        "hypoelastic_plastic",
        "damage",
        "together: strains at fracture are positive",
    ),
];

/// Numbers that bounds exclude, as many as there are.
fn beyond(bounds: &Bounds) -> Vec<f64> {
    let mut all = vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    if bounds.least.is_finite() {
        all.push(bounds.least - 1.0);
        if !bounds.inclusive {
            all.push(bounds.least);
        }
    }
    if bounds.most.is_finite() {
        all.push(bounds.most + 1.0);
        if bounds.below {
            all.push(bounds.most);
        }
    }
    all
}

#[test]
fn numbers_out_of_bounds_are_refused_by_their_key() {
    let registry = Registry::standard();
    let mut asked = 0;
    for descriptor in registry.descriptors() {
        let refused = |key: &str, given: Parameter| {
            let mut parameters = Parameters::default().with(key, given.clone());
            let (wrong, why) = descriptor.check(&mut parameters).unwrap_err();
            assert_eq!(wrong, key, "{} {given:?}: {why}", descriptor.name);
            assert!(why.contains(key), "{}: {why}", descriptor.name);
        };
        for key in descriptor.taken() {
            match key.value {
                Value::Number(_, bounds) => {
                    for x in beyond(&bounds) {
                        refused(key.name, Parameter::Number(x));
                        asked += 1;
                    }
                }
                Value::List(count, _, bounds) => {
                    let fits = if bounds.hold(1.0) { 1.0 } else { 0.5 };
                    for x in beyond(&bounds) {
                        let mut list = vec![fits; count];
                        list[count - 1] = x;
                        refused(key.name, Parameter::List(list));
                        asked += 1;
                    }
                    refused(key.name, Parameter::List(vec![fits; count + 1]));
                }
                Value::Rows(columns) => {
                    for (n, (_, _, bounds)) in columns.iter().enumerate() {
                        for x in beyond(bounds) {
                            let mut row = vec![0.5; columns.len()];
                            row[n] = x;
                            refused(key.name, Parameter::Rows(vec![row]));
                            asked += 1;
                        }
                    }
                }
                Value::Word(_) => refused(key.name, Parameter::Word("no such word".into())),
                Value::Direction => {
                    for list in [[0.0; 3], [1.0, f64::NAN, 0.0], [f64::INFINITY, 0.0, 0.0]] {
                        refused(key.name, Parameter::List(list.to_vec()));
                        asked += 1;
                    }
                    refused(key.name, Parameter::List(vec![1.0; 2]));
                    refused(key.name, Parameter::Number(1.0));
                }
                Value::Formula(..) => refused(key.name, Parameter::Number(1.0)),
                Value::Entries(_) | Value::Name | Value::Table => {}
            }
        }
    }
    assert!(asked > 200, "{asked}");
}

/// A stiffness, a strength, a rate of a solid is bounded from below; what is not is on the list.
#[test]
fn constants_of_solids_have_signs() {
    let registry = Registry::standard();
    let mut found = vec![];
    for descriptor in registry.descriptors() {
        if registry.is_potential(&descriptor.name) {
            continue;
        }
        for key in descriptor.taken() {
            let free = match key.value {
                Value::Number(_, bounds) | Value::List(_, _, bounds) => {
                    bounds.least == f64::NEG_INFINITY
                }
                Value::Rows(columns) => columns.iter().any(|c| c.2.least == f64::NEG_INFINITY),
                _ => false,
            };
            if free {
                found.push((descriptor.name.to_string(), key.name));
            }
        }
    }
    for (law, key) in &found {
        assert!(
            FREE.iter().any(|(l, k, _)| l == law && k == key),
            "`{key}` of {law} takes any number: bound it, or say what judges it"
        );
    }
    assert_eq!(found.len(), FREE.len(), "{found:?}");
}

/// Pairs of moduli of no stable solid, whatever law asks for two.
#[test]
fn moduli_of_no_solid_are_refused() {
    let registry = Registry::standard();
    let pairs = [
        [("young", 3.0), ("poisson", 0.5)],
        [("young", 3.0), ("poisson", -1.0)],
        [("young", 3.0), ("shear", 1.0)],
        [("young", 3.0), ("bulk", 0.3)],
        [("young", 3.0), ("shear", 0.9)],
        [("bulk", -1.0), ("shear", 1.0)],
        [("bulk", 1.0), ("shear", 0.0)],
    ];
    let mut laws = 0;
    for descriptor in registry.descriptors() {
        if !descriptor.keys.iter().any(|k| k.need == Need::TwoOf) {
            continue;
        }
        laws += 1;
        for pair in pairs {
            let mut parameters = Parameters::numbers(&pair);
            let refused = descriptor.check(&mut parameters);
            assert!(refused.is_err(), "{} takes {pair:?}", descriptor.name);
        }
    }
    assert!(laws >= 8, "{laws}");
    // joint bounds of laws with other constants
    let refused = |law: &str, parameters: Parameters, part: &str| {
        let error = registry.look_up(&mut LawSpec::named(law, parameters));
        let message = error.unwrap_err().message.to_string();
        assert!(message.contains(part), "{law}: {message}");
    };
    let eam = Parameters::numbers(&[("pair", 6.0), ("volume", -1.0)]);
    refused("eam_like", eam, "bulk modulus");
}
