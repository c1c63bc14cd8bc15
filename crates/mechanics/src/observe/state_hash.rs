//! What a model is, in two numbers of 64 bits.

use std::fmt;
use twox_hash::XxHash3_64;

/// XXH3 of a model and of its accounts: equal where all bits are, whatever the number of threads, the instruction set and the order of points and
/// bonds in memory; of unlike ones equal by chance, once in 2⁶⁴.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StateHash {
    /// Of the step, the time, and everything that a run which goes on elsewhere needs; forces too.
    pub state: u64,
    /// Of energies, and of what came in of quantities that spread. `None`: there are no accounts, or they do not add up.
    pub ledger: Option<u64>,
}

impl StateHash {
    /// Of something that is all in these numbers.
    pub fn of(numbers: impl IntoIterator<Item = f64>) -> StateHash {
        let mut words = Words::default();
        words.numbers(numbers);
        StateHash {
            state: words.hash(0),
            ledger: None,
        }
    }
}

/// 16 hexadecimal digits each; of a model without accounts those of the state alone.
impl fmt::Display for StateHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.state)?;
        match self.ledger {
            Some(ledger) => write!(f, " ledger {ledger:016x}"),
            None => Ok(()),
        }
    }
}

/// XXH3 of a name.
pub fn hash_of_name(name: &str) -> u64 {
    XxHash3_64::oneshot(name.as_bytes())
}

/// Words that wait to be hashed, least byte first.
#[derive(Default)]
pub struct Words(Vec<u8>);

impl Words {
    pub fn put(&mut self, words: impl IntoIterator<Item = u64>) {
        self.0.extend(words.into_iter().flat_map(u64::to_le_bytes));
    }

    /// Numbers as they are: 0 and −0 are two.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.put(numbers.into_iter().map(f64::to_bits));
    }

    /// XXH3 of all, after which there are none.
    pub fn hash(&mut self, seed: u64) -> u64 {
        let hash = XxHash3_64::oneshot_with_seed(seed, &self.0);
        self.0.clear();
        hash
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_that_of_the_bytes() {
        // xxHash, XXH3_64bits of nothing
        assert_eq!(Words::default().hash(0), 0x2d06_8005_38d3_94c2);
        let mut words = Words::default();
        words.put([1, 2]);
        let bytes = [1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(words.hash(5), XxHash3_64::oneshot_with_seed(5, &bytes));
        // they are gone
        assert_eq!(words.hash(0), Words::default().hash(0));
        assert_ne!(StateHash::of([0.0]), StateHash::of([-0.0]));
    }

    #[test]
    fn digits_are_sixteen_each() {
        let of = |ledger| {
            StateHash {
                state: 0xab,
                ledger,
            }
            .to_string()
        };
        assert_eq!(of(Some(1)), "00000000000000ab ledger 0000000000000001");
        assert_eq!(of(None), "00000000000000ab");
    }
}
