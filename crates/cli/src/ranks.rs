//! `peridyne ranks`: which MPI this program finds under a launcher, whether messages between all ranks come as they were sent, and how fast.

use crate::failure::{Failure, note, say};
use peridyne_comm::{Comm, Work, launcher};
use peridyne_io::drive::refused_threads;
use peridyne_io::write::checkpoint::work_before;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

#[derive(clap::Args)]
pub struct RanksArguments {
    /// So many threads of one process as ranks, without a launcher.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub on_threads: Option<u16>,
    /// As JSON.
    #[arg(long)]
    pub json: bool,
}

/// Messages of a few lengths go from each rank to each: nothing, a word, a page, and more than an MPI sends before the receiver asked.
const LENGTHS: [usize; 4] = [0, 8, 4 << 10, 1 << 20];
/// Messages there and back of which the time of one is taken, and how often: the least of them counts.
const ROUNDS: usize = 200;
const TRIES: usize = 5;
const BIG: usize = 4 << 20;
const BIG_ROUNDS: usize = 5;

fn no_launcher() -> Result<(), Failure> {
    match launcher::launched() {
        Some(launched) => Err(Failure::input(format!(
            "--on-threads has no launcher, and {launched}"
        ))),
        None => Ok(()),
    }
}

/// Does `work` on all ranks: of a launcher, or so many threads of this process. What the first says of it.
pub fn shared(
    on_threads: Option<u16>,
    work: impl Fn(&Arc<Comm>) -> Result<(), Failure> + Sync,
) -> Result<(), Failure> {
    let Some(threads) = on_threads else {
        return work(&Arc::new(Comm::of_launcher().map_err(input)?));
    };
    no_launcher()?;
    let mut all = peridyne_comm::on_threads(usize::from(threads), |comm| work(&Arc::new(comm)));
    // who found a mistake says it
    let told = all
        .iter()
        .position(|end| !matches!(end, Ok(()) | Err(Failure::Elsewhere)));
    all.swap_remove(told.unwrap_or(0))
}

/// Tells all ranks what those of an earlier run had to do, as the first one reads it.
pub fn share_as_before(comm: &Comm, dir: &Path) -> Result<(), Failure> {
    let work = match comm.rank() {
        0 => work_before(dir),
        _ => vec![],
    };
    let words = work
        .iter()
        .flat_map(|of| [of.points as u64, of.seconds.to_bits()]);
    let said: Vec<u8> = words.flat_map(u64::to_le_bytes).collect();
    let all = comm.all(&said).map_err(input)?;
    let words = all[0].as_chunks().0.iter().map(|w| u64::from_le_bytes(*w));
    let words: Vec<u64> = words.collect();
    let work = words.as_chunks().0.iter().map(|[points, seconds]| Work {
        points: *points as usize,
        seconds: f64::from_bits(*seconds),
    });
    comm.share_by(work.collect());
    Ok(())
}

/// What this rank made of the input; where one could not, one says why. All ranks come here at once.
pub fn agreed<T>(comm: &Comm, made: Result<T, Failure>) -> Result<T, Failure> {
    let all = comm
        .all(&[u8::from(made.is_err())])
        .map_err(input)?
        .concat();
    match all.iter().position(|failed| *failed == 1) {
        Some(first) if first != comm.rank() => Err(Failure::Elsewhere),
        Some(_) | None => made,
    }
}

/// Work that ranks do not share: the first one does it, and the others wait for it.
pub fn by_the_first(
    comm: &Comm,
    what: &str,
    work: impl FnOnce() -> Result<(), Failure>,
) -> Result<(), Failure> {
    if comm.rank() > 0 {
        return agreed(comm, Ok(()));
    }
    if comm.ranks() > 1 {
        let others = comm.ranks() - 1;
        note(&format!(
            "warning: ranks do not share {what}: the first one does all of it, {others} wait"
        ));
    }
    agreed(comm, work())
}

/// Can so many threads be begun?
pub fn some_threads(threads: Option<usize>) -> Result<(), Failure> {
    if threads == Some(0) {
        return Err(Failure::input("--threads 0: at least one thread must run"));
    }
    match threads.and_then(refused_threads) {
        Some(text) => Err(Failure::input(text)),
        None => Ok(()),
    }
}

/// Threads of this rank: those that were asked for, else its share of the cores that it may use.
pub fn threads_here(comm: &Comm, asked: Option<usize>) -> Result<Option<usize>, Failure> {
    agreed(comm, some_threads(asked))?;
    if asked.is_some() || comm.ranks() == 1 {
        return Ok(asked);
    }
    let own = format!("{} {}", host(), cores());
    let all = comm.all(own.as_bytes()).map_err(input)?;
    let sharing = all.iter().filter(|other| **other == own.as_bytes()).count();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(Some((cores / sharing).max(1)))
}

/// Which cores this rank may use: launchers may give each rank its own.
fn cores() -> String {
    #[cfg(target_os = "linux")]
    {
        let asked = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = asked.lines().find(|l| l.starts_with("Cpus_allowed:"));
        line.unwrap_or_default().into()
    }
    #[cfg(not(target_os = "linux"))]
    String::new()
}

pub fn ranks(arguments: &RanksArguments) -> Result<(), Failure> {
    let found = match arguments.on_threads {
        Some(threads) => {
            no_launcher()?;
            let mut all = peridyne_comm::on_threads(usize::from(threads), |comm| of(&comm));
            all.swap_remove(0)
        }
        None => {
            let comm = Comm::of_launcher().map_err(input)?;
            let found = of(&comm);
            if let Err(e) = &found {
                crate::failure::note(&format!("error: {e}"));
                comm.abort(1);
            }
            match comm.rank() {
                0 => found,
                _ => return Ok(()),
            }
        }
    };
    let found = found.map_err(|e| Failure::Run(e.to_string()))?;
    match arguments.json {
        true => say(&found.json().to_string()),
        false => say(&found.text()),
    }
    Ok(())
}

/// One of the processes says it for all where the launcher is there but no MPI.
fn input(failure: peridyne_comm::Failure) -> Failure {
    match launcher::launched() {
        Some(launched) if launched.rank > 0 => std::process::exit(2),
        _ => Failure::input(failure.to_string()),
    }
}

/// What was found, the same on all ranks but for times.
struct Found {
    carrier: String,
    /// Name of each rank's machine.
    hosts: Vec<String>,
    /// Messages that came, byte by byte.
    messages: usize,
    /// From rank 0 to another and back: the other, seconds of a word in one direction, bytes per second of long messages.
    speeds: Vec<(usize, f64, f64)>,
}

fn of(comm: &Comm) -> Result<Found, peridyne_comm::Failure> {
    let hosts = comm.all(host().as_bytes())?;
    let hosts: Vec<String> = hosts
        .into_iter()
        .map(|host| String::from_utf8_lossy(&host).into_owned())
        .collect();
    let messages = everybody(comm)?;
    let mut speeds = vec![];
    // the neighbour, and the first one of another machine
    let away = hosts.iter().position(|host| *host != hosts[0]);
    let mut others: Vec<usize> = [(comm.ranks() > 1).then_some(1), away]
        .into_iter()
        .flatten()
        .collect();
    others.dedup();
    for other in others {
        let mut time = [0.0; 2];
        for (time, (bytes, rounds)) in time.iter_mut().zip([(8, ROUNDS), (BIG, BIG_ROUNDS)]) {
            *time = there_and_back(comm, other, bytes, rounds)?;
        }
        speeds.push((other, time[0], BIG as f64 / time[1]));
    }
    Ok(Found {
        carrier: comm.carrier(),
        hosts,
        messages,
        speeds,
    })
}

/// Name of this machine.
fn host() -> String {
    #[cfg(unix)]
    return rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    return std::env::var("COMPUTERNAME").unwrap_or_default();
}

/// Byte `n` of a message.
fn byte(from: usize, to: usize, length: usize, n: usize) -> u8 {
    let mut x = (from as u64) << 40
        ^ (to as u64) << 20
        ^ length as u64
        ^ (n as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x ^= x >> 29;
    x.wrapping_mul(0xbf58_476d_1ce4_e5b9) as u8 ^ (x >> 32) as u8
}

/// Each rank to each, itself too, and looked at; how many there were on all ranks.
fn everybody(comm: &Comm) -> Result<usize, peridyne_comm::Failure> {
    let (own, ranks) = (comm.rank(), comm.ranks());
    for length in LENGTHS {
        // one shift of the ring after the other, so that what is under way is two messages of this rank
        for shift in 0..ranks {
            let (to, from) = ((own + shift) % ranks, (own + ranks - shift) % ranks);
            let sent: Vec<u8> = (0..length).map(|n| byte(own, to, length, n)).collect();
            let mut got = vec![0; length];
            comm.exchange(&[(to, &sent)], &mut [(from, &mut got)], || ())?;
            if let Some(n) = (0..length).find(|&n| got[n] != byte(from, own, length, n)) {
                let message =
                    format!("byte {n} of {length} from rank {from} to rank {own} came as another");
                return Err(peridyne_comm::Failure::Mpi(message));
            }
        }
    }
    comm.barrier()?;
    Ok(LENGTHS.len() * ranks * ranks)
}

/// Seconds of one message of so many bytes between rank 0 and another, half of there and back; 0 on ranks between which none goes.
fn there_and_back(
    comm: &Comm,
    other: usize,
    bytes: usize,
    rounds: usize,
) -> Result<f64, peridyne_comm::Failure> {
    let mut least = f64::INFINITY;
    let sent = vec![1u8; bytes];
    let mut got = vec![0u8; bytes];
    for _ in 0..TRIES {
        comm.barrier()?;
        let begin = Instant::now();
        for _ in 0..rounds {
            match comm.rank() {
                0 => {
                    comm.exchange(&[(other, &sent)], &mut [], || ())?;
                    comm.exchange(&[], &mut [(other, &mut got)], || ())?;
                }
                rank if rank == other => {
                    comm.exchange(&[], &mut [(0, &mut got)], || ())?;
                    comm.exchange(&[(0, &sent)], &mut [], || ())?;
                }
                _ => {}
            }
        }
        least = least.min(begin.elapsed().as_secs_f64() / (2 * rounds) as f64);
    }
    Ok(least)
}

impl Found {
    /// Machines and how many ranks are on each, in the order of their first ranks.
    fn machines(&self) -> Vec<(&str, usize)> {
        let mut machines: Vec<(&str, usize)> = vec![];
        for host in &self.hosts {
            match machines.iter_mut().find(|(name, _)| name == host) {
                Some((_, ranks)) => *ranks += 1,
                None => machines.push((host, 1)),
            }
        }
        machines
    }

    fn text(&self) -> String {
        let ranks = self.hosts.len();
        let mut text = format!("ranks     {ranks}: {}", self.carrier);
        for (n, (host, ranks)) in self.machines().into_iter().enumerate() {
            let head = if n == 0 { "machines" } else { "" };
            write!(
                text,
                "\n{head:9} {host}: {ranks} {}",
                if ranks == 1 { "rank" } else { "ranks" }
            )
            .unwrap();
        }
        if ranks == 1 {
            text += "\nalone     mpiexec -n 4 peridyne ranks asks an MPI; --on-threads 4 asks threads of one process";
            return text;
        }
        write!(
            text,
            "\nmessages  {} of 0 to {} bytes, from each rank to each, came as they were sent",
            self.messages, LENGTHS[3]
        )
        .unwrap();
        for (other, latency, speed) in &self.speeds {
            write!(
                text,
                "\n0 to {other:<4} {:.2} µs for 8 bytes, {:.2} GB/s for {BIG} bytes",
                latency * 1e6,
                speed * 1e-9
            )
            .unwrap();
        }
        text
    }

    fn json(&self) -> serde_json::Value {
        let speed = |(other, latency, speed): &(usize, f64, f64)| json!({"between": [0, other], "latency_s": latency, "bytes_per_s": speed});
        json!({
            "ranks": self.hosts.len(),
            "carrier": self.carrier,
            "hosts": self.hosts,
            "messages": self.messages,
            "speeds": self.speeds.iter().map(speed).collect::<Vec<_>>(),
        })
    }
}
