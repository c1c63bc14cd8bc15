//! Dictionaries as decks, and JSON as dictionaries.

use crate::arrays::kind;
use crate::error::expected;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use serde_json::Value as Json;
use toml::{Table, Value};

/// A dictionary of numbers, strings, lists and dictionaries as a deck.
pub fn toml(given: &Bound<'_, PyDict>) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in given {
        let name = key.cast::<PyString>();
        let name = name.map_err(|_| expected(format!("keys are strings, got {}", kind(&key))))?;
        let name = name.to_string();
        // what is not given
        if value.is_none() {
            continue;
        }
        let value = one(&value, &name)?;
        table.insert(name, value);
    }
    Ok(table)
}

fn one(given: &Bound<'_, PyAny>, key: &str) -> PyResult<Value> {
    if let Ok(table) = given.cast::<PyDict>() {
        return Ok(Value::Table(toml(table)?));
    }
    if let Ok(text) = given.cast::<PyString>() {
        return Ok(Value::String(text.to_string()));
    }
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(given.extract()?));
    }
    if given.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(given.extract()?));
    }
    // arrays and numbers of NumPy
    if let Ok(list) = given.call_method0("tolist") {
        return one(&list, key);
    }
    if let Ok(text) = given.call_method0("__fspath__") {
        return one(&text, key);
    }
    let each = given.try_iter().map_err(|_| {
        expected(format!(
            "`{key}`: expected a number, a string, a list or a dictionary, got {}",
            kind(given)
        ))
    })?;
    let values = each.map(|value| one(&value?, key));
    Ok(Value::Array(values.collect::<PyResult<_>>()?))
}

/// JSON as Python has it.
pub fn of_json<'py>(py: Python<'py>, value: &Json) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?
        .call_method1("loads", (value.to_string(),))
}
