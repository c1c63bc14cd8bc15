//! YAML and XML (Teuchos parameter lists) as trees.

use super::tree::{Entry, Value};
use saphyr_parser::{Event, Parser};

/// What is wrong, at a line.
pub type Wrong = (usize, String);

/// Most lists inside each other; decks have six.
const DEEP: usize = 32;

/// A file of either kind: XML begins with `<`.
pub fn tree(text: &str) -> Result<Entry, Wrong> {
    match text.trim_start().starts_with('<') {
        true => xml(text),
        false => yaml(text),
    }
}

fn xml(text: &str) -> Result<Entry, Wrong> {
    let document = roxmltree::Document::parse(text)
        .map_err(|e| (e.pos().row as usize, format!("no XML: {e}")))?;
    let line = |n: roxmltree::Node| document.text_pos_at(n.range().start).row as usize;
    fn list(
        node: roxmltree::Node,
        line: &dyn Fn(roxmltree::Node) -> usize,
        depth: usize,
    ) -> Result<Vec<Entry>, Wrong> {
        let mut all = vec![];
        for child in node.children().filter(roxmltree::Node::is_element) {
            let at = line(child);
            let name = child.attribute("name").unwrap_or("").to_string();
            let value = match child.tag_name().name() {
                "Parameter" => Value::Text(child.attribute("value").unwrap_or("").into()),
                "ParameterList" if depth < DEEP => Value::List(list(child, line, depth + 1)?),
                "ParameterList" => return Err((at, "too many lists inside each other".into())),
                other => {
                    let message = format!("expected Parameter or ParameterList, found <{other}>");
                    return Err((at, message));
                }
            };
            all.push(Entry::new(name, at, value));
        }
        Ok(all)
    }
    let all = list(document.root_element(), &line, 0)?;
    Ok(Entry::new("Peridigm".into(), 1, Value::List(all)))
}

/// What is open while events come: the entries so far, and the key that waits for its value.
struct Open {
    key: (String, usize),
    all: Vec<Entry>,
    waiting: Option<(String, usize)>,
    /// A sequence counts its entries.
    sequence: bool,
}

fn yaml(text: &str) -> Result<Entry, Wrong> {
    let mut open = vec![Open {
        key: (String::new(), 1),
        all: vec![],
        waiting: Some((String::new(), 1)),
        sequence: false,
    }];
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|e| {
            let line = e.marker().line();
            (line, format!("no YAML: {}", e.info()))
        })?;
        let line = span.start.line();
        let Some(top) = open.last_mut() else { break };
        match event {
            Event::Scalar(text, ..) => match top.waiting.take() {
                Some((key, at)) => top.all.push(Entry::new(key, at, Value::Text(text.into()))),
                None if top.sequence => {
                    let key = (top.all.len() + 1).to_string();
                    top.all
                        .push(Entry::new(key, line, Value::Text(text.into())));
                }
                None => top.waiting = Some((text.into(), line)),
            },
            Event::MappingStart(..) | Event::SequenceStart(..) => {
                let counted = || ((top.all.len() + 1).to_string(), line);
                let key = match top.waiting.take() {
                    Some(key) => key,
                    None if top.sequence => counted(),
                    None => return Err((line, "a key should be a word".into())),
                };
                if open.len() > DEEP {
                    return Err((line, "too many lists inside each other".into()));
                }
                open.push(Open {
                    key,
                    all: vec![],
                    waiting: None,
                    sequence: matches!(event, Event::SequenceStart(..)),
                });
            }
            Event::MappingEnd | Event::SequenceEnd => {
                if let (Some(done), Some(below)) = (open.pop(), open.last_mut()) {
                    let (key, line) = done.key;
                    below.all.push(Entry::new(key, line, Value::List(done.all)));
                }
            }
            Event::Alias(_) => return Err((line, "aliases (*name) are not read".into())),
            Event::Nothing
            | Event::StreamStart
            | Event::StreamEnd
            | Event::DocumentStart(_)
            | Event::DocumentEnd => {}
        }
    }
    // the document's mapping, whose only entry is that of the program
    let document = open.pop().and_then(|o| o.all.into_iter().next());
    match document {
        Some(Entry {
            value: Value::List(all),
            ..
        }) => {
            let program = all.into_iter().find(|e| matches!(e.value, Value::List(_)));
            program.ok_or_else(|| (1, "no list Peridigm: or PeriLab: in it".into()))
        }
        Some(_) | None => Err((1, "no list Peridigm: or PeriLab: in it".into())),
    }
}
