//! A deck of another program as a tree of names and texts, which remembers what was made of each entry.

use std::cell::RefCell;

use crate::read::number::number;

/// What became of an entry.
#[derive(Debug, Clone, PartialEq)]
enum State {
    /// Nobody asked for it.
    Open,
    Taken,
    /// It says nothing of the problem.
    Idle,
    /// It has no counterpart, and why.
    Refused(String),
}

#[derive(Debug)]
pub enum Value {
    Text(String),
    List(Vec<Entry>),
}

/// `key: value`, at a line of the file.
#[derive(Debug)]
pub struct Entry {
    pub key: String,
    /// From 1.
    pub line: usize,
    pub value: Value,
    state: RefCell<State>,
}

/// An entry that was not mapped.
#[derive(Debug, Clone, PartialEq)]
pub struct Unmapped {
    pub line: usize,
    /// Names from the top, with slashes.
    pub entry: String,
    pub why: String,
}

/// Names are the same in any case, and with blanks or underscores.
fn plain(name: &str) -> String {
    name.trim().to_lowercase().replace('_', " ")
}

pub fn same(a: &str, b: &str) -> bool {
    plain(a) == plain(b)
}

impl Entry {
    pub fn new(key: String, line: usize, value: Value) -> Self {
        Entry {
            key,
            line,
            value,
            state: RefCell::new(State::Open),
        }
    }

    pub fn all(&self) -> &[Entry] {
        match &self.value {
            Value::List(all) => all,
            Value::Text(_) => &[],
        }
    }

    /// Its entries that are lists.
    pub fn lists(&self) -> impl Iterator<Item = &Entry> {
        let lists = self.all().iter();
        lists.filter(|e| matches!(e.value, Value::List(_)))
    }

    pub fn find(&self, key: &str) -> Option<&Entry> {
        self.all().iter().find(|e| same(&e.key, key))
    }

    pub fn list(&self, key: &str) -> Option<&Entry> {
        self.lists().find(|e| same(&e.key, key))
    }

    /// Its own text, which is taken by asking.
    pub fn own(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => {
                self.state.replace(State::Taken);
                Some(text.trim())
            }
            Value::List(_) => None,
        }
    }

    /// The text of an entry, which is taken by asking.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.find(key)?.own()
    }

    /// The number of an entry, which is taken if it is one.
    pub fn number(&self, key: &str) -> Option<f64> {
        let entry = self.find(key)?;
        let number = number(entry.own()?).filter(|x| x.is_finite());
        if number.is_none() {
            entry.refuse("a number was expected");
        }
        number
    }

    pub fn is_true(&self, key: &str) -> bool {
        self.text(key)
            .is_some_and(|t| t.eq_ignore_ascii_case("true"))
    }

    /// It, and all in it, has no counterpart.
    pub fn refuse(&self, why: &str) {
        self.state.replace(State::Refused(why.into()));
    }

    pub fn refuse_entry(&self, key: &str, why: &str) {
        if let Some(entry) = self.find(key) {
            entry.refuse(why);
        }
    }

    /// These say nothing of the problem.
    pub fn idle(&self, keys: &[&str]) {
        for entry in keys.iter().filter_map(|k| self.find(k)) {
            entry.state.replace(State::Idle);
        }
    }

    /// All that was not mapped, in the order of the file.
    pub fn unmapped(&self) -> Vec<Unmapped> {
        let mut found = vec![];
        for entry in self.all() {
            entry.gather("", None, &mut found);
        }
        found.sort_by_key(|u| u.line);
        found
    }

    fn gather(&self, above: &str, why: Option<&str>, found: &mut Vec<Unmapped>) {
        let path = match above {
            "" => self.key.clone(),
            above => format!("{above} / {}", self.key),
        };
        let state = self.state.borrow();
        let why = match (&*state, why) {
            (State::Refused(why), _) => Some(&**why),
            (State::Idle, _) => return,
            (State::Open | State::Taken, Some(why)) => Some(why),
            (State::Taken, None) => None,
            (State::Open, None) => None,
        };
        match (&self.value, why, &*state) {
            (Value::List(all), why, _) => {
                all.iter().for_each(|e| e.gather(&path, why, found));
            }
            (Value::Text(text), Some(why), _) => found.push(self.told(&path, text, why)),
            (Value::Text(text), None, State::Open) => {
                found.push(self.told(&path, text, "it has no counterpart that is known"));
            }
            (Value::Text(_), None, _) => {}
        }
    }

    fn told(&self, path: &str, text: &str, why: &str) -> Unmapped {
        Unmapped {
            line: self.line,
            entry: format!("{path} = {}", text.trim()),
            why: why.into(),
        }
    }
}
