//! The one door through which text comes in: UTF-8 with or without a byte-order mark, UTF-16 with one, and line ends of any system.
//!
//! A byte that is no UTF-8 is taken as Latin-1 in comments (behind `#`, and lines that begin with `**`) and in titles; elsewhere it could
//! be part of a name, and is refused with its place.

use std::io::BufRead;

/// Bytes of a line of a file that is read line by line.
const LONGEST: usize = 1 << 20;
/// UTF-8's byte-order mark.
const MARK: &[u8] = b"\xef\xbb\xbf";
const HOW: &str = "save the file as UTF-8";

/// Bytes that are no text, and what to do about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{message}", line.map_or(String::new(), |l| format!("line {l}: ")))]
pub struct NotText {
    /// 1-based; `None`: the file as a whole.
    pub line: Option<usize>,
    pub message: String,
}

/// The text of a whole file, of which the first `titles` lines may say anything.
///
/// # Errors
/// UTF-16 that is damaged or has no mark; bytes that are no UTF-8, unless they are in a comment or title.
pub fn text(mut bytes: Vec<u8>, titles: usize) -> Result<String, NotText> {
    let whole = |what: &str| NotText {
        line: None,
        message: format!("{what}: {HOW}"),
    };
    let order: fn([u8; 2]) -> u16 = match bytes[..] {
        [0xff, 0xfe, 0, 0, ..] => return Err(whole("it is UTF-32")),
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => {
            if bytes.starts_with(MARK) {
                bytes.drain(..MARK.len());
            }
            if is_wide(&bytes) {
                return Err(whole("it looks like UTF-16 without a byte-order mark"));
            }
            return match String::from_utf8(ends(bytes)) {
                Ok(text) => Ok(text),
                Err(e) => lines(e.as_bytes(), titles),
            };
        }
    };
    // half a character at the end is none
    let units = bytes[2..].chunks(2).map(|pair| match *pair {
        [a, b] => order([a, b]),
        _ => 0xd800,
    });
    let read: Result<String, _> = char::decode_utf16(units).collect();
    let text = read.map_err(|_| whole("it begins like UTF-16 and is damaged"))?;
    Ok(text.replace("\r\n", "\n").replace('\r', "\n"))
}

/// Is every other byte 0 at the head, as in UTF-16?
fn is_wide(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(512)];
    let zeros = |first: usize| head.iter().skip(first).step_by(2).all(|b| *b == 0);
    head.len() >= 4 && zeros(0) != zeros(1)
}

/// Returns alone end lines, too, as on old Macs.
fn ends(bytes: Vec<u8>) -> Vec<u8> {
    let next = |k: usize| bytes.get(k + 1) == Some(&b'\n');
    if !(0..bytes.len()).any(|k| bytes[k] == b'\r' && !next(k)) {
        return bytes;
    }
    let all = bytes.iter().enumerate();
    let kept = all.filter(|(k, b)| **b != b'\r' || !next(*k));
    kept.map(|(_, b)| if *b == b'\r' { b'\n' } else { *b })
        .collect()
}

/// Line by line, where some byte is no UTF-8.
fn lines(bytes: &[u8], titles: usize) -> Result<String, NotText> {
    let mut text = String::with_capacity(bytes.len());
    for (n, raw) in bytes.split_inclusive(|b| *b == b'\n').enumerate() {
        push(raw, n < titles, &mut text).map_err(|message| NotText {
            line: Some(n + 1),
            message,
        })?;
    }
    Ok(text)
}

/// Adds a line to a text.
fn push(raw: &[u8], title: bool, text: &mut String) -> Result<(), String> {
    let error = match std::str::from_utf8(raw) {
        Ok(line) => {
            text.push_str(line);
            return Ok(());
        }
        Err(error) => error,
    };
    let (before, rest) = raw.split_at(error.valid_up_to());
    let control = |b: &u8| *b < b' ' && !b"\t\n\r\x0c".contains(b);
    if raw.iter().any(control) {
        return Err("this line is not text (binary or compressed file?)".into());
    }
    if title || before.contains(&b'#') || raw.trim_ascii_start().starts_with(b"**") {
        text.extend(raw.iter().map(|b| char::from(*b)));
        return Ok(());
    }
    let column = String::from_utf8_lossy(before).chars().count() + 1;
    let byte = rest.first().copied().unwrap_or_default();
    let likely = match char::from(byte) {
        c if c.is_alphabetic() || "°µ²³±×".contains(c) => format!("`{c}` "),
        _ => String::new(),
    };
    Err(format!(
        "the byte 0x{byte:02X} in column {column} is no UTF-8, likely {likely}in Latin-1 or Windows-1252: {HOW} (iconv -f WINDOWS-1252 -t UTF-8)"
    ))
}

/// What is wrong with a line of a file that is read line by line.
pub(super) enum Bad {
    /// The operating system's, or that of what is packed.
    Read(std::io::Error),
    Text(String),
}

/// The next line of a file into `line`, without its end; `false` at the end of the file. `number` is that of the line, from 1, `raw` room.
pub(super) fn next_line(
    reader: &mut impl BufRead,
    number: usize,
    raw: &mut Vec<u8>,
    line: &mut String,
) -> Result<bool, Bad> {
    line.clear();
    raw.clear();
    let mut any = false;
    loop {
        let room = reader.fill_buf().map_err(Bad::Read)?;
        if room.is_empty() {
            break;
        }
        any = true;
        let end = room.iter().position(|b| *b == b'\n' || *b == b'\r');
        let taken = end.unwrap_or(room.len());
        raw.extend_from_slice(&room[..taken]);
        let returned = end.is_some_and(|k| room[k] == b'\r');
        reader.consume(taken + usize::from(end.is_some()));
        if returned && reader.fill_buf().map_err(Bad::Read)?.first() == Some(&b'\n') {
            reader.consume(1);
        }
        if raw.len() > LONGEST {
            return Err(Bad::Text(format!(
                "this line is longer than {LONGEST} characters (binary file?)"
            )));
        }
        if end.is_some() {
            break;
        }
    }
    if number == 1 {
        if raw.starts_with(b"\xff\xfe") || raw.starts_with(b"\xfe\xff") {
            return Err(Bad::Text(format!("the file is UTF-16: {HOW}")));
        }
        if raw.starts_with(MARK) {
            raw.drain(..MARK.len());
        }
        if is_wide(raw) {
            let message = format!("it looks like UTF-16 without a byte-order mark: {HOW}");
            return Err(Bad::Text(message));
        }
    }
    push(raw, false, line).map_err(Bad::Text)?;
    Ok(any)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    const TEXT: &str = "*NODE\n1, 0.5, ü\n";

    fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
        let marked = format!("\u{feff}{text}");
        marked.encode_utf16().flat_map(order).collect()
    }

    #[test]
    fn marks_and_line_ends_of_all_systems_say_the_same() {
        let returns = TEXT.replace('\n', "\r");
        for bytes in [
            TEXT.as_bytes().to_vec(),
            [MARK, TEXT.as_bytes()].concat(),
            utf16(TEXT, u16::to_le_bytes),
            utf16(TEXT, u16::to_be_bytes),
            utf16(&returns, u16::to_le_bytes),
            returns.clone().into_bytes(),
            [MARK, returns.as_bytes()].concat(),
        ] {
            assert_eq!(text(bytes.clone(), 0).unwrap(), TEXT, "{bytes:?}");
        }
        // what lines() takes as it is stays as it is
        assert_eq!(text(b"a\r\nb\r\n".to_vec(), 0).unwrap(), "a\r\nb\r\n");
        assert_eq!(text(b"a\r\rb\r\nc".to_vec(), 0).unwrap(), "a\n\nb\nc");
    }

    #[test]
    fn other_bytes_are_told_with_their_place() {
        let latin = b"x\n# Gr\xf6\xdfe\nname = \"Gr\xf6\xdfe\"\n".to_vec();
        let error = text(latin, 0).unwrap_err();
        assert_eq!(error.line, Some(3));
        let told = "the byte 0xF6 in column 11 is no UTF-8, likely `ö` in Latin-1";
        assert!(error.message.starts_with(told), "{error}");
        let title = b"Gr\xf6\xdfe in \xb5m\n** \xe4\n1 # \xe4\n".to_vec();
        assert_eq!(
            text(title.clone(), 1).unwrap(),
            "Größe in µm\n** ä\n1 # ä\n"
        );
        assert_eq!(text(title, 0).unwrap_err().line, Some(1));
        for (bytes, part) in [
            (&b"\x89HDF\x00\x01"[..], "binary"),
            (b"*\0N\0O\0D\0E\0\n\0", "UTF-16 without a byte-order mark"),
            (b"\0*\0N\0O\0D\0E\0\n", "UTF-16 without a byte-order mark"),
            (b"\xff\xfe\0\0*\0\0\0", "UTF-32"),
            (b"\xff\xfe*\0N", "damaged"),
        ] {
            let error = text(bytes.to_vec(), 0).unwrap_err().to_string();
            assert!(error.contains(part), "{bytes:?}: {error}");
        }
    }

    fn streamed(bytes: &[u8], room: usize) -> Result<Vec<String>, String> {
        let mut reader = BufReader::with_capacity(room, bytes);
        let (mut raw, mut line, mut all) = (vec![], String::new(), vec![]);
        loop {
            match next_line(&mut reader, all.len() + 1, &mut raw, &mut line) {
                Ok(true) => all.push(line.clone()),
                Ok(false) => return Ok(all),
                Err(Bad::Text(why)) => return Err(why),
                Err(Bad::Read(why)) => return Err(why.to_string()),
            }
        }
    }

    #[test]
    fn lines_of_streams_end_alike() {
        let lines = ["1", "", "ä 2", "3"];
        for end in ["\n", "\r\n", "\r"] {
            for (last, mark) in [("", &b""[..]), (end, MARK)] {
                let bytes = [mark, lines.join(end).as_bytes(), last.as_bytes()].concat();
                for room in [1, 2, 3, 64] {
                    assert_eq!(streamed(&bytes, room).unwrap(), lines, "{end:?} {room}");
                }
            }
        }
        let error = streamed(&utf16(TEXT, u16::to_le_bytes), 64).unwrap_err();
        assert!(error.contains("UTF-16"), "{error}");
        let error = streamed(b"1\n\xe4 2\n", 64).unwrap_err();
        assert!(error.contains("0xE4 in column 1"), "{error}");
        let long = vec![b'7'; 3 << 20];
        assert!(
            streamed(&long, 1 << 16)
                .unwrap_err()
                .contains("longer than")
        );
    }
}
