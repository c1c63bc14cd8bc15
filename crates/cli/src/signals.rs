//! SIGINT (Ctrl-C), SIGTERM, and SIGHUP (the terminal is closed) where nobody has said that it is to be passed over, as `nohup` does.
//!
//! Until a run steps there is nothing to keep, and a signal ends the program at once. From its first step on
//! ([`received`]) the first signal is a request to end at the next step, and a second one ends the program at once. SIGUSR1 asks for a
//! state from which the run can go on ([`asked_for_checkpoint`]).

#[cfg(unix)]
use signal_hook::consts::{SIGHUP, SIGUSR1};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

/// Windows has none: it is passed over.
#[cfg(not(unix))]
const SIGHUP: i32 = 1;

/// A signal that ends runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    Interrupt,
    Terminate,
    Hangup,
}

impl Signal {
    const ALL: [Signal; 3] = [Signal::Interrupt, Signal::Terminate, Signal::Hangup];

    fn number(self) -> i32 {
        match self {
            Signal::Interrupt => SIGINT,
            Signal::Terminate => SIGTERM,
            Signal::Hangup => SIGHUP,
        }
    }

    /// 128 + its number, as shells say it.
    pub fn exit_code(self) -> u8 {
        128 + self.number() as u8
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Signal::Interrupt => "SIGINT",
            Signal::Terminate => "SIGTERM",
            Signal::Hangup => "SIGHUP",
        })
    }
}

/// Does the next signal end the program at once?
static AT_ONCE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));
/// Number of the last signal; 0: none.
static LAST: LazyLock<Arc<AtomicUsize>> = LazyLock::new(|| Arc::new(AtomicUsize::new(0)));

/// Is a signal passed over, whatever comes? Where the system does not say it (other than Linux), SIGHUP is left as it is.
fn passed_over(signal: Signal) -> bool {
    if signal != Signal::Hangup {
        return false;
    }
    let status = std::fs::read_to_string("/proc/self/status");
    let mask = status.ok().and_then(|text| {
        let line = text.lines().find_map(|l| l.strip_prefix("SigIgn:"))?;
        u64::from_str_radix(line.trim(), 16).ok()
    });
    mask.is_none_or(|mask| mask >> (signal.number() - 1) & 1 == 1)
}

/// Has somebody asked for a state to go on from, by SIGUSR1?
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(false)));

/// Was SIGUSR1 received since the last time that this was asked?
pub fn asked_for_checkpoint() -> bool {
    ASKED.swap(false, Ordering::SeqCst)
}

/// From now on signals end the program as said above.
///
/// # Errors
/// The operating system does not say when a signal comes.
pub fn listen() -> std::io::Result<()> {
    for signal in Signal::ALL.into_iter().filter(|s| !passed_over(*s)) {
        let number = signal.number();
        // in this order: a signal that finds `AT_ONCE` set never gets to the next two
        flag::register_conditional_shutdown(number, signal.exit_code().into(), AT_ONCE.clone())
            .and_then(|_| flag::register_usize(number, LAST.clone(), number as usize))
            .and_then(|_| flag::register(number, AT_ONCE.clone()))?;
    }
    #[cfg(unix)]
    flag::register(SIGUSR1, ASKED.clone())?;
    Ok(())
}

/// The signal that this run is to end for. From the first call on the run ends at its next step instead of at once.
pub fn received() -> Option<Signal> {
    let last = LAST.load(Ordering::SeqCst);
    if last == 0 {
        AT_ONCE.store(false, Ordering::SeqCst);
    }
    Signal::ALL
        .into_iter()
        .find(|s| s.number() as usize == last)
}
