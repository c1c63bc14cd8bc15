//! Changes of a file: what happens to files on their way, and what somebody does who wishes no good.

/// Numbers that are the same for the same seed (splitmix64).
pub struct Dice(pub u64);

impl Dice {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `n`, 0 if there is nothing below it.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    pub fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

pub type Change = fn(&mut Dice, &mut Vec<u8>);

/// Each with its name.
pub const KINDS: [(&str, Change); 12] = [
    ("flip", |dice, file| flip(dice, file)),
    ("cut", |dice, file| {
        let end = dice.below(file.len());
        file.truncate(end);
    }),
    ("delete", |dice, file| {
        let part = range(dice, file, 40);
        file.drain(part);
    }),
    ("repeat", repeat),
    ("swap", |dice, file| {
        lines(file, |all| {
            let (a, b) = (dice.below(all.len()), dice.below(all.len()));
            all.swap(a, b);
        });
    }),
    ("line", |dice, file| {
        lines(file, |all| {
            all.remove(dice.below(all.len()));
        });
    }),
    ("number", number),
    ("word", word),
    ("insert", |dice, file| {
        let at = dice.below(file.len() + 1);
        let what = dice.pick(&INSERTED).as_bytes().to_vec();
        file.splice(at..at, what);
    }),
    ("wide", |dice, file| {
        let at = dice.below(file.len() + 1);
        let what = vec![*dice.pick(b"x1 [\"(#\t"); 70_000];
        file.splice(at..at, what);
    }),
    ("deep", |dice, file| {
        let at = dice.below(file.len() + 1);
        let what = dice.pick(&["[", "(", "{", "a = {", "-(", "<a>", "- "]);
        file.splice(at..at, what.repeat(3000).into_bytes());
    }),
    ("several", |dice, file| {
        for _ in 0..3 {
            KINDS[dice.below(9)].1(dice, file);
        }
    }),
];

const NUMBERS: [&str; 22] = [
    "0",
    "-1",
    "1",
    "2",
    "-0.0",
    "nan",
    "inf",
    "-inf",
    "1e300",
    "-1e300",
    "1e-300",
    "1e-9",
    "0.5",
    "1e9",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "99999999999",
    "9223372036854775807",
    "18446744073709551615",
    "340282366920938463463374607431768211456",
];

const INSERTED: [&str; 18] = [
    "\0",
    "\r",
    "\r\n",
    "\n",
    "\u{1b}[31m",
    "\u{1b}]0;owned\u{7}",
    "\u{9b}1m",
    "\u{202e}",
    "\u{7f}",
    "é",
    "\u{feff}",
    "\"",
    "'",
    "`",
    "#",
    ",",
    "{}",
    "$(1/0)",
];

fn range(dice: &mut Dice, file: &[u8], longest: usize) -> std::ops::Range<usize> {
    let start = dice.below(file.len());
    start..file.len().min(start + 1 + dice.below(longest))
}

fn flip(dice: &mut Dice, file: &mut [u8]) {
    for _ in 0..1 + dice.below(4) {
        let at = dice.below(file.len());
        let Some(byte) = file.get_mut(at) else { return };
        match dice.below(2) {
            0 => *byte ^= 1 << dice.below(8),
            _ => *byte = dice.next() as u8,
        }
    }
}

fn repeat(dice: &mut Dice, file: &mut Vec<u8>) {
    let part = range(dice, file, 200);
    let what = file[part.clone()].repeat([1, 2, 50][dice.below(3)]);
    file.splice(part.end..part.end, what);
}

fn lines(file: &mut Vec<u8>, change: impl FnOnce(&mut Vec<&[u8]>)) {
    let mut all: Vec<&[u8]> = file.split(|b| *b == b'\n').collect();
    change(&mut all);
    *file = all.join(&b'\n');
}

/// Is it read byte by byte?
fn binary(file: &[u8]) -> bool {
    std::str::from_utf8(file).is_err() || file.contains(&0)
}

/// Parts of a file of bytes that `is` holds of.
fn runs(file: &[u8], is: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let (mut all, mut start) = (vec![], None);
    for at in 0..=file.len() {
        match (start, file.get(at).is_some_and(|b| is(*b))) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                all.push(from..at);
                start = None;
            }
            _ => {}
        }
    }
    all
}

fn number(dice: &mut Dice, file: &mut Vec<u8>) {
    if binary(file) {
        let bytes = *dice.pick(&[
            0u64,
            1,
            u64::MAX,
            1 << 31,
            u64::MAX >> 1,
            f64::NAN.to_bits(),
            1000,
        ]);
        let bytes = match dice.below(4) {
            0 => bytes.to_be_bytes().to_vec(),
            1 => bytes.to_le_bytes().to_vec(),
            2 => (bytes as u32).to_be_bytes().to_vec(),
            _ => (bytes as u32).to_le_bytes().to_vec(),
        };
        let at = dice.below(file.len() / 4) * 4;
        let end = file.len().min(at + bytes.len());
        file.splice(at..end, bytes);
        return;
    }
    let all = runs(file, |b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    let all: Vec<_> = { all.into_iter() }
        .filter(|r| file[r.clone()].iter().any(u8::is_ascii_digit))
        .collect();
    if !all.is_empty() {
        let at = dice.pick(&all).clone();
        let what = dice.pick(&NUMBERS).as_bytes().to_vec();
        file.splice(at, what);
    }
}

/// A word for another of the same file.
fn word(dice: &mut Dice, file: &mut Vec<u8>) {
    let all = runs(file, |b| !b.is_ascii_whitespace() && !b",=\"".contains(&b));
    if !all.is_empty() {
        let what = file[dice.pick(&all).clone()].to_vec();
        let at = dice.pick(&all).clone();
        file.splice(at, what);
    }
}
