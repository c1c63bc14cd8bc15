//! What a deck has in a wrong form, and where it is said.

use super::with;

/// `key = value`, the part of it that is refused, and in which words.
const REFUSED: &str = r#"
output.space_time = [{ field = "density", range = [1, 2, 3] }] | [1, 2, 3] | expected a list of 2, found 3
output.space_time = [{ field = "density", range = [1] }] | [1] | expected a list of 2, found 1
output.space_time = [{ field = "density", range = [1, "a"] }] | "a" | expected f64, found string "a"
output.space_time = [{ field = 1 }] | 1 | expected a string, found the number `1`
output.space_time = { fields = "density" } | fields | unknown key `fields`
output.pictures = [[1]] | [1] | expected a table of keys, such as { key = value }, found a list
output.pictures = [{ field = "damage", film = 1 }] | 1 | expected true or false, "png" or "gif", found the number `1`
output.pictures = [{ field = "damage" }, { filed = "damage" }] | filed | unknown key `filed`
output.checkpoint = "often" | "often" | expected true or false, found string "often"
output.checkpoint = 99999999999999999999 | 99999999999999999999 | expected a value or a table, found the number `99999999999999999999` as i128
output.checkpoint = [true] | [true] | expected true or false, found a list
body = [1, 2] | 2 | expected a table of keys, such as { key = value }, found the number `2`
body.lattice = 3 | 3 | wanted string or table
body.lattice = "cube" | "cube" | `cube` is not known here
body.lattice = { cubic = 1 } | 1 | expected table, found integer
body.cells = [1, -1] | -1 | expected a whole number from 0, found the number `-1`
body.cells = [1, 4294967296] | 4294967296 | expected a whole number from 0, found the number `4294967296`
body.spacing = true | true | expected a number, or a text such as "0.5 mm", found boolean `true`
body.spacing = 1e999 | 1e999 | floating-point number overflowed
body.spacing = 18446744073709551616 | 18446744073709551616 | expected a number, or a text such as "0.5 mm", found the number `18446744073709551616` as i128
run.steps = 1e3 | 1e3 | expected a whole number from 0, found the number `1000.0`
run.steps = 2020-01-01 | 2020-01-01 | expected a whole number from 0, found a table
run.time_step = 2020-01-01 | 2020-01-01 | unknown key `$__toml_private_datetime`
run.time_step = true | true | expected a number, or a text such as "0.5 mm", found boolean `true`
run.time_step = { safety = [0.5] } | [0.5] | expected a number, or a text such as "0.5 mm", found a list
run.time_step = 9223372036854775808 | 9223372036854775808 | expected a value or a table, found the number `9223372036854775808`
run.integrator = "euler" | "euler" | `euler` is not known here
run.solver = [] | [] | wanted string or table
horizon = true | true | expected a number, or a text such as "0.5 mm", found boolean `true`
horizon = { m_ratios = 3 } | m_ratios | unknown key `m_ratios`
units = 3 | 3 | expected enum UnitName, found the number `3`
units = "imperial" | "imperial" | `imperial` is not known here
units = [1] | [1] | expected enum UnitName, found a list
units = true | true | expected enum UnitName, found boolean `true`
units = 1.5 | 1.5 | expected enum UnitName, found the number `1.5`
units = { long = 1 } | long | unknown key `long`
periodic = "x" | "x" | expected a list, found string "x"
periodic = ["w"] | "w" | `w` is not known here
periodic = [1] | 1 | wanted string or table
periodic = { w = 1 } | w | unknown key `w`
contact = 3 | 3 | expected true or false, found the number `3`
influence = 3 | 3 | expected a string, found the number `3`
sets = { a = { block = 1.5 } } | 1.5 | data did not match any variant of untagged enum Block
sets = { a = { mark = [1] } } | [1] | data did not match any variant of untagged enum Block
sets = { a = { basis = [0, "b"] } } | "b" | expected a whole number from 0, found string "b"
sets = { a = 1 } | 1 | expected a table of keys, such as { key = value }, found the number `1`
sets = [1] | [1] | expected a map, found a list
boundary_condition = [{ displacement = { x = [1] } }] | [1] | expected a number, or a text such as "0.5 mm", found a list
boundary_condition = [{ displacement = { w = 1 } }] | w | unknown key `w`
boundary_condition = [{ displacement = 3 }] | 3 | expected components such as { x = "1 mm" } or ["1 mm", "free"], found the number `3`
boundary_condition = [{ displacement = [0, 0, 0, 0] }] | [0, 0, 0, 0] | expected 1 to 3 components, found 4
initial.0.velocity = { y = true } | true | expected a number, or a text such as "0.5 mm", found boolean `true`
material.law = 3 | 3 | expected a law such as { lps = { … } }, found the number `3`
material.law = { pmb = [1] } | [1] | the constants of the law "pmb" are a table
material.law = { pmb = { bulks = 1 } } | bulks | unknown key `bulks`
material.law = { pmb = { bulk = true } } | true | expected a number, or a text such as "0.5 mm", found boolean `true`
material.law = "pmbb" | "pmbb" | `pmbb` is not known here
material.law = 2020-01-01 | 2020-01-01 | `$__toml_private_datetime` is not known here
probe = [{ name = "a", measure = "forces" }] | "forces" | `forces` is not known here
probe = [{ name = "a" }] | { name = "a" } | the key `measure` is missing
body.file_step = -1 | -1 | expected a whole number from 0, found the number `-1`
sets.a.region = 3 | 3 | wanted string or table
sets.a.region = {} | {} | expected a table with exactly one entry, which says the kind
sets.a.region = { everything = {}, block = {} } | { everything = {}, block = {} } | expected a table with exactly one entry, which says the kind
sets.a.region = "blok" | "blok" | `blok` is not known here
sets.a.region = "block" | "block" | expected a table of keys, such as { key = value }, found unit variant
sets.a.region = { everything = 1 } | 1 | expected table, found integer
sets.a.region = { everything = { a = 1 } } | { a = 1 } | expected empty table
sets.a.region = { everything = [1] } | [1] | expected empty array
sets.a.region = { blok = 1 } | blok | `blok` is not known here
sets.a.region = { block = 1 } | 1 | expected a table of keys, such as { key = value }, found the number `1`
sets.a.region = { block = [1, 2] } | [1, 2] | expected a table of keys, such as { key = value }, found a list
sets.a.region = { block = { low = [0, 0, 0] } } | { low = [0, 0, 0] } | the key `high` is missing
sets.a.region = { block = { low = [0, 0, 0], up = 1, hi = 2 } } | hi | unexpected keys in table: hi, up, available keys: low, high
sets.a.region = { block = { low = [0, 0, true], high = [1, 1, 1] } } | true | expected a number, or a text such as "0.5 mm", found boolean `true`
sets.a.region = { block = { low = [0, 0, 0, 0], high = [1, 1, 1] } } | [0, 0, 0, 0] | expected 1 to 3 components, found 4
sets.a.region = { union = 3 } | 3 | expected a list, found the number `3`
sets.a.region = { union = ["everything", "nothing"] } | "nothing" | `nothing` is not known here
sets.a.random = { part = 1, seed = 1.5 } | 1.5 | expected a whole number from 0, found the number `1.5`
sets.a.random = { part = 1, seed = -1 } | -1 | expected a whole number from 0, found the number `-1`
sets.a.random = { part = 1, seed = 18446744073709551616 } | 18446744073709551616 | expected a whole number from 0, found the number `18446744073709551616` as i128
sets.a.random = { part = 1, seed = -9223372036854775809 } | -9223372036854775809 | expected a whole number from 0, found the number `-9223372036854775809` as i128
sets.a.random = { part = 1, seed = 340282366920938463463374607431768211455 } | 340282366920938463463374607431768211455 | expected a whole number from 0, found the number `340282366920938463463374607431768211455` as u128
sets.a.random = { part = 1, seed = 999999999999999999999999999999999999999999 } | 999999999999999999999999999999999999999999 | integer number overflowed
sets.a.random = { part = 1, seed = true } | true | expected a whole number from 0, found boolean `true`
output.space_time = { field = "density", range = [1, 2, 3] } | [1, 2, 3] | expected a list of 2, found 3
sets.a.region = 2020-01-01 | 2020-01-01 | wanted string or table
sets.a.region = { everything = 2020-01-01 } | 2020-01-01 | expected table, found datetime
sets.a.region = { block = 2020-01-01 } | 2020-01-01 | unknown key `$__toml_private_datetime`
sets.a.region = { moved = { by = [1], from = { block = 1 } } } | moved | `moved` is not known here
sets.a.region = { everything = 1.5 } | 1.5 | expected table, found float
units = 2020-01-01 | 2020-01-01 | unknown key `$__toml_private_datetime`
output.every = inf | inf | expected a whole number from 0, found the number `inf`
output.space_time = [{ field = "density", range = [nan, 1e999] }] | 1e999 | floating-point number overflowed
output.fields = ["damage", 3] | 3 | expected a string, found the number `3`
output.pictures = [{ field = "damage", range = [0, 1, 2] }, 3] | [0, 1, 2] | expected a list of 2, found 3
sets.a.mark = 9223372036854775808 | 9223372036854775808 | data did not match any variant of untagged enum Block
sets.a.mark = [] | [] | data did not match any variant of untagged enum Block
"#;

#[test]
fn what_is_of_another_form_is_told_at_its_place() {
    for case in REFUSED.trim().lines() {
        let [line, place, message] = *case.split(" | ").collect::<Vec<_>>() else {
            panic!("{case}");
        };
        let (key, value) = line.split_once(" = ").unwrap();
        let error = with(key, value).unwrap_err();
        assert_eq!(error.message, message, "{line}");
        assert_eq!(error.span().map(|span| &line[span]), Some(place), "{line}");
    }
}

#[test]
fn a_value_may_stand_bare_or_in_a_table() {
    for (key, value) in [
        ("contact", "true"),
        ("contact", "{}"),
        ("units", r#""si""#),
        ("units", r#"{ system = "si" }"#),
        ("run.time_step", "1e-7"),
        ("run.time_step", "{ safety = 0.5 }"),
        ("output.checkpoint", "false"),
        ("output.checkpoint", "{ keep = 1 }"),
        ("sets.a.region", r#""everything""#),
        ("sets.a.region", "{ everything = [] }"),
        ("body.lattice", "{ cubic = {} }"),
        (
            "output.pictures",
            r#"[{ field = "damage", range = [0, 1.5] }]"#,
        ),
    ] {
        let read = with(key, value);
        assert!(read.is_ok(), "{key} = {value}: {}", read.unwrap_err());
    }
}
