use super::format::DIMENSIONS;
use super::*;
use proptest::prelude::*;

/// Values of a variable of a file made by hand.
#[derive(Clone)]
pub enum Given {
    Text(Vec<&'static str>),
    Ints(Vec<i32>),
    Floats(Vec<f32>),
    Doubles(Vec<f64>),
}

impl Given {
    fn kind(&self) -> Type {
        match self {
            Given::Text(_) => Type::Char,
            Given::Ints(_) => Type::Int,
            Given::Floats(_) => Type::Float,
            Given::Doubles(_) => Type::Double,
        }
    }

    fn bytes(&self, width: usize) -> Vec<u8> {
        match self {
            Given::Text(all) => { all.iter() }
                .flat_map(|t| {
                    let mut field = t.as_bytes().to_vec();
                    field.resize(width, 0);
                    field
                })
                .collect(),
            Given::Ints(v) => v.iter().flat_map(|x| x.to_be_bytes()).collect(),
            Given::Floats(v) => v.iter().flat_map(|x| x.to_be_bytes()).collect(),
            Given::Doubles(v) => v.iter().flat_map(|x| x.to_be_bytes()).collect(),
        }
    }
}

/// A file of these dimensions and variables: name, names of dimensions, values, element type.
pub fn file(
    version: Version,
    dimensions: &[(&str, usize)],
    variables: &[(&str, &[&str], Given, Option<&str>)],
) -> Vec<u8> {
    let mut header = Header::new(version);
    for (name, length) in dimensions {
        header.dimension(name, *length);
    }
    for (name, of, given, elements) in variables {
        let place = |d: &&str| dimensions.iter().position(|k| k.0 == *d).expect(d);
        let of: Vec<usize> = of.iter().map(place).collect();
        let v = header.variable(name, given.kind(), &of);
        if let Some(kind) = elements {
            v.attributes
                .push(("elem_type".into(), Attribute::Text((*kind).into())));
        }
    }
    lay_out(&mut header).unwrap();
    let mut bytes = vec![];
    header.write(&mut bytes).unwrap();
    for ((_, _, given, _), v) in variables.iter().zip(&header.variables) {
        assert_eq!(bytes.len() as u64, v.begin);
        let width = header.shape(v).last().copied().unwrap_or(1);
        bytes.extend(given.bytes(width as usize));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

const VERSIONS: [Version; 2] = [Version::Offset64, Version::Data64];

fn small(version: Version) -> Vec<u8> {
    let dimensions = [("three", 3), ("five", 5), ("time", 0)];
    let variables: [(&str, &[&str], Given, Option<&str>); 4] = [
        (
            "words",
            &["three", "five"],
            Given::Text(vec!["ab", "cd  ", "äé"]),
            None,
        ),
        (
            "whole",
            &["three"],
            Given::Ints(vec![-1, 0, i32::MAX]),
            Some("HEX8"),
        ),
        (
            "double",
            &["three"],
            Given::Doubles(vec![0.1, -1.0, 1e300]),
            None,
        ),
        (
            "float",
            &["three"],
            Given::Floats(vec![0.5, -1.0, 1e30]),
            None,
        ),
    ];
    file(version, &dimensions, &variables)
}

#[test]
fn what_is_written_is_read_in_every_version() {
    for version in VERSIONS {
        let reader = Reader::new(small(version)).unwrap();
        let words = reader.texts("words").unwrap().unwrap();
        assert_eq!(words, ["ab", "cd", "äé"]);
        let whole = reader.wholes("whole").unwrap().unwrap();
        assert_eq!(whole, [-1, 0, i64::from(i32::MAX)]);
        let doubles = reader.floats("double").unwrap().unwrap();
        assert_eq!(doubles, [0.1, -1.0, 1e300]);
        assert_eq!(reader.floats("float").unwrap().unwrap()[..2], [0.5, -1.0]);
        let elements = reader.attribute("whole", "elem_type");
        assert_eq!(elements.as_deref(), Some("HEX8"));
        assert_eq!(reader.attribute("float", "elem_type"), None);
        assert_eq!(reader.length("five"), Some(5));
        assert_eq!(reader.shape("words"), Some(vec![3, 5]));
        assert_eq!(reader.floats("nothing"), Ok(None));
    }
}

#[test]
fn records_are_found_one_by_one() {
    for version in VERSIONS {
        let mut header = Header::new(version);
        let time = header.dimension("time_step", 0);
        let two = header.dimension("two", 2);
        header.variable("t", Type::Double, &[time]);
        header.variable("x", Type::Float, &[time, two]);
        let start = lay_out(&mut header).unwrap();
        assert_eq!(header.record_bytes(), Some(16));
        header.records = 2;
        let mut bytes = vec![];
        header.write(&mut bytes).unwrap();
        assert_eq!(bytes.len() as u64, start);
        for (t, x) in [(0.25f64, [1.0f32, 2.0]), (0.5, [3.0, 4.0])] {
            bytes.extend(t.to_be_bytes());
            bytes.extend(x.iter().flat_map(|x| x.to_be_bytes()));
        }
        let reader = Reader::new(bytes.clone()).unwrap();
        assert_eq!(reader.length("time_step"), Some(2));
        assert_eq!(reader.record("t", 1), [0.5]);
        assert_eq!(reader.record("x", 1), [3.0, 4.0]);
        assert!(reader.floats("x").unwrap_err().contains("each frame"));
        // the count of a writer stands where the reader looks
        let count = |records: u64| {
            let (at, count) = header.records_mark(records);
            let mut other = bytes.clone();
            other[at as usize..at as usize + count.len()].copy_from_slice(&count);
            Reader::new(other)
        };
        assert_eq!(count(1).unwrap().length("time_step"), Some(1));
        // more than there are
        for records in [3, 1 << 30] {
            let told = count(records).err().unwrap();
            assert!(told.contains("cut short"), "{told}");
        }
    }
}

#[test]
fn a_single_record_variable_is_not_filled_up() {
    let mut header = Header::new(Version::Offset64);
    let time = header.dimension("time", 0);
    header.variable("flag", Type::Char, &[time]);
    assert_eq!(header.record_bytes(), Some(1));
    header.variable("other", Type::Char, &[time]);
    assert_eq!(header.record_bytes(), Some(8));
}

#[test]
fn what_is_cut_short_is_told_at_every_byte() {
    for version in VERSIONS {
        let bytes = small(version);
        for length in 0..bytes.len() {
            let told = match Reader::new(bytes[..length].to_vec()) {
                Err(told) => told,
                Ok(reader) => match reader.floats("float") {
                    Err(told) => told,
                    Ok(_) => panic!("{length} of {} bytes are enough", bytes.len()),
                },
            };
            let known = told.contains("cut short") || told.contains("no netCDF file");
            assert!(known, "{length}: {told}");
        }
    }
}

#[test]
fn other_files_are_told_what_they_are() {
    let told = |bytes: &[u8]| Reader::new(bytes.to_vec()).err().unwrap();
    assert!(told(b"\x89HDF\r\n\x1a\n....").contains("cut short"));
    assert!(told(b"CDF\x03....").contains("unknown version, 3"));
    for text in [&b"*NODE"[..], b"", b"CDF", &[0; 4000]] {
        assert!(told(text).contains("begins neither with CDF"));
    }
}

#[test]
fn a_wrong_type_is_told() {
    let reader = Reader::new(small(Version::Offset64)).unwrap();
    let told = reader.floats("whole").unwrap_err();
    assert_eq!(told, "whole should hold numbers with a point, it holds Int");
    let told = reader.wholes("float").unwrap_err();
    assert!(told.contains("whole numbers"), "{told}");
    assert!(reader.texts("double").unwrap_err().contains("text"));
}

#[test]
fn lengths_beyond_all_numbers_are_cut_short_not_asked_for() {
    // CDF-5 with dimensions of 2^62: their product has no 64 bits
    let mut header = Header::new(Version::Data64);
    let large = header.dimension("large", 1 << 62);
    header.variable("x", Type::Double, &[large, large]);
    header.variable("text", Type::Char, &[large]);
    assert!(lay_out(&mut header.clone()).is_err());
    let mut bytes = vec![];
    header.write(&mut bytes).unwrap();
    let reader = Reader::new(bytes).unwrap();
    assert!(reader.floats("x").unwrap_err().contains("cut short"));
    assert!(reader.texts("text").unwrap_err().contains("cut short"));
    // a list, a name or an attribute that promises more than there is
    let mut short = b"CDF\x05".to_vec();
    short.extend([0; 8]);
    for promise in [u64::MAX, u64::MAX >> 1, 1 << 40] {
        let mut list = short.clone();
        list.extend(DIMENSIONS.to_be_bytes());
        list.extend(promise.to_be_bytes());
        assert!(Reader::new(list).err().unwrap().contains("cut short"));
        let mut name = short.clone();
        name.extend(DIMENSIONS.to_be_bytes());
        name.extend(1u64.to_be_bytes());
        name.extend(promise.to_be_bytes());
        assert!(Reader::new(name).err().unwrap().contains("cut short"));
    }
}

#[test]
fn names_stay_on_one_line() {
    let mut header = Header::new(Version::Data64);
    let time = header.dimension("time", 0);
    let large = header.dimension("large", 1 << 62);
    header.variable("two\nlines", Type::Double, &[time, large, large]);
    let mut bytes = vec![];
    header.write(&mut bytes).unwrap();
    let why = Reader::new(bytes).err().unwrap();
    assert!(why.contains(r"'two\nlines'"), "{why}");
}

#[test]
fn a_version_says_what_it_cannot_hold() {
    for (version, length, fits) in [
        (Version::Offset64, 1 << 28, true),
        (Version::Offset64, 1 << 29, false),
        (Version::Data64, 1 << 29, true),
    ] {
        let mut header = Header::new(version);
        let n = header.dimension("n", length);
        header.variable("x", Type::Double, &[n]);
        assert_eq!(lay_out(&mut header).is_ok(), fits, "{version:?} {length}");
    }
}

proptest! {
    #[test]
    fn damaged_files_are_read_or_refused(
        version in prop::sample::select(VERSIONS.to_vec()),
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = small(version);
        for (place, byte) in places {
            let at = place.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(reader) = Reader::new(bytes) {
            for name in ["words", "whole", "double", "float"] {
                let _ = (reader.floats(name), reader.wholes(name), reader.texts(name));
            }
        }
    }
}
