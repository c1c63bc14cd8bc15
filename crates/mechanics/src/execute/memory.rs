//! How much memory is left, judged before it is asked for: an allocation that fails ends the program without a word, and
//! one that succeeds on paper ends it later.

use crate::error::{BuildError, size};
use crate::quantity::Message;
use std::fs::read_to_string;

/// Bytes that this process may still take: of the machine, of its control group, of its address space. `None` where the
/// system does not say (other than Linux).
pub fn available() -> Option<f64> {
    let limits = [machine(), group(), address_space()];
    limits.into_iter().flatten().reduce(f64::min)
}

/// Does `what` of so many bytes fit? `path` and `help` are the error's.
///
/// # Errors
/// It does not fit into what is left.
pub fn afford(
    path: &str,
    what: &str,
    bytes: f64,
    help: impl Into<Message>,
) -> Result<(), BuildError> {
    match available() {
        Some(left) if bytes > left => Err(BuildError::too_large(
            path,
            (bytes, Some(left)),
            format!(
                "{what} would take about {}; this machine has {} left",
                size(bytes),
                size(left)
            ),
        )
        .help(help)),
        _ => Ok(()),
    }
}

/// What the kernel could hand out without swapping.
fn machine() -> Option<f64> {
    kibibytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// What the control group (version 2) and those around it leave.
fn group() -> Option<f64> {
    let text = read_to_string("/proc/self/cgroup").ok()?;
    let own = text.lines().find_map(|line| line.strip_prefix("0::"))?;
    let number = |folder: &str, file: &str| -> Option<f64> {
        let text = read_to_string(format!("/sys/fs/cgroup{folder}/{file}")).ok()?;
        text.trim().parse().ok()
    };
    let mut folder = own.trim_end_matches('/');
    let mut least: Option<f64> = None;
    loop {
        if let (Some(most), Some(now)) = (
            number(folder, "memory.max"),
            number(folder, "memory.current"),
        ) {
            // files in the cache count as used, and are given up when memory is short
            let cached = read_to_string(format!("/sys/fs/cgroup{folder}/memory.stat"))
                .ok()
                .and_then(|text| {
                    let line = text
                        .lines()
                        .find_map(|l| l.strip_prefix("inactive_file "))?;
                    line.trim().parse::<f64>().ok()
                });
            let left = (most - now + cached.unwrap_or(0.0)).max(0.0);
            least = Some(least.map_or(left, |l| l.min(left)));
        }
        match folder.rfind('/') {
            Some(at) => folder = &folder[..at],
            None => return least,
        }
    }
}

/// What `ulimit -v` leaves.
fn address_space() -> Option<f64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let line = limits
        .lines()
        .find_map(|l| l.strip_prefix("Max address space"))?;
    let limit: f64 = line.split_whitespace().next()?.parse().ok()?;
    let used = kibibytes(&read_to_string("/proc/self/status").ok()?, "VmSize:")?;
    Some((limit - used).max(0.0))
}

/// `key   1234 kB` of a file of the kernel, where kB are 1024 bytes.
fn kibibytes(text: &str, key: &str) -> Option<f64> {
    let line = text.lines().find_map(|l| l.strip_prefix(key))?;
    let number: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::BuildErrorKind;

    #[test]
    fn the_kernel_counts_in_kibibytes() {
        let text = "MemFree:     7 kB\nMemAvailable:   2048 kB\n";
        assert_eq!(kibibytes(text, "MemAvailable:"), Some(2048.0 * 1024.0));
        assert_eq!(kibibytes(text, "VmSize:"), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_byte_fits_and_an_exabyte_does_not() {
        afford("body", "a byte", 1.0, "").unwrap();
        let error = afford("body", "an exabyte", 1e18, "take less").unwrap_err();
        assert!(
            error
                .message
                .contains("an exabyte would take about 1000000.000 TB"),
            "{error}"
        );
        assert_eq!(error.help.as_deref(), Some("take less"));
        let needed = match error.kind {
            BuildErrorKind::TooLarge { needed, .. } => needed,
            kind => panic!("{kind:?}"),
        };
        assert_eq!(needed, 1e18);
    }
}
