//! Keyword lines, and the names that stand in them.

/// Parts of a line at a separator that stands in no quotation marks, trimmed.
pub(super) fn split<'a>(line: &'a str, separator: char, into: &mut Vec<&'a str>) {
    if !line.contains('"') {
        into.extend(line.split(separator).map(str::trim));
        return;
    }
    let mut quoted = false;
    let outside = |c: char| {
        quoted ^= c == '"';
        c == separator && !quoted
    };
    into.extend(line.split(outside).map(str::trim));
}

/// A name: blanks and case do not count, unless it stands in quotation marks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    /// By which it is compared.
    pub key: String,
    /// As it was written first.
    pub shown: String,
}

impl Label {
    pub fn new(text: &str) -> Label {
        let (mut key, mut shown, mut quoted) = (String::new(), String::new(), false);
        for c in text.trim().chars() {
            match c {
                '"' => quoted = !quoted,
                c if quoted => {
                    key.push(c);
                    shown.push(c);
                }
                c if c.is_whitespace() => {}
                c => {
                    key.extend(c.to_uppercase());
                    shown.push(c);
                }
            }
        }
        Label { key, shown }
    }
}

/// `*KEYWORD, OPTION, OPTION=VALUE`.
pub(super) struct Keyword {
    /// In capitals and without blanks: `SOLIDSECTION`.
    pub name: String,
    /// In capitals: `*SOLID SECTION`.
    pub shown: String,
    /// Names in capitals and without blanks, values as they stand.
    options: Vec<(String, Option<String>)>,
}

impl Keyword {
    /// Of a line and those that go on with it.
    pub fn new(header: &str) -> Keyword {
        let mut parts = Vec::new();
        split(header, ',', &mut parts);
        let shown = parts[0].to_uppercase();
        let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        let options = parts[1..].iter().filter(|p| !p.is_empty()).map(|part| {
            let (name, value) = match part.split_once('=') {
                Some((name, value)) => (name, Some(value.trim().to_string())),
                None => (*part, None),
            };
            (Label::new(name).key, value)
        });
        Keyword {
            name: Label::new(shown.trim_start_matches('*')).key,
            options: options.collect(),
            shown,
        }
    }

    pub fn value(&self, option: &str) -> Option<&str> {
        let mut all = self.options.iter();
        all.find(|(name, _)| name == option)?.1.as_deref()
    }

    pub fn has(&self, option: &str) -> bool {
        self.options.iter().any(|(name, _)| name == option)
    }

    /// An option that is none of these.
    pub fn other(&self, known: &[&str]) -> Option<&str> {
        let mut all = self.options.iter().map(|(name, _)| name.as_str());
        all.find(|name| !known.contains(name))
    }
}
