//! Messages between threads of one process.

use crate::failure::Failure;
use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Messages on their way, and who has ended.
#[derive(Debug)]
struct Post {
    /// By receiver, then by sender: when it arrives, and what it is.
    boxes: Vec<Vec<VecDeque<(Instant, Vec<u8>)>>>,
    ended: Vec<bool>,
}

#[derive(Debug)]
struct Office {
    post: Mutex<Post>,
    news: Condvar,
    /// How long a message takes at least.
    delay: Duration,
}

impl Office {
    fn open(&self) -> MutexGuard<'_, Post> {
        // nobody panics with the post half sorted
        self.post.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// One of the threads. When it is gone, others do not wait for it.
#[derive(Debug)]
pub(crate) struct Thread {
    rank: usize,
    ranks: usize,
    office: Arc<Office>,
}

impl Drop for Thread {
    fn drop(&mut self) {
        self.office.open().ended[self.rank] = true;
        self.office.news.notify_all();
    }
}

impl Thread {
    /// So many of them, who write to each other messages that take so long at least.
    pub(crate) fn several(ranks: usize, delay: Duration) -> impl Iterator<Item = Thread> {
        let office = Arc::new(Office {
            post: Mutex::new(Post {
                boxes: vec![vec![VecDeque::new(); ranks]; ranks],
                ended: vec![false; ranks],
            }),
            news: Condvar::new(),
            delay,
        });
        (0..ranks).map(move |rank| Thread {
            rank,
            ranks,
            office: office.clone(),
        })
    }

    pub(crate) fn rank(&self) -> usize {
        self.rank
    }

    pub(crate) fn ranks(&self) -> usize {
        self.ranks
    }

    pub(crate) fn send<'a>(&self, send: impl Iterator<Item = &'a (usize, &'a [u8])>) {
        let arrives = Instant::now() + self.office.delay;
        let mut post = self.office.open();
        for (to, bytes) in send {
            post.boxes[*to][self.rank].push_back((arrives, bytes.to_vec()));
        }
        drop(post);
        self.office.news.notify_all();
    }

    pub(crate) fn receive<'a, 'b: 'a>(
        &self,
        receive: impl Iterator<Item = &'a mut (usize, &'b mut [u8])>,
    ) -> Result<(), Failure> {
        for (from, into) in receive {
            let message = self.next(*from)?;
            if message.len() != into.len() {
                return Err(Failure::Length {
                    from: *from,
                    sent: message.len(),
                    expected: into.len(),
                });
            }
            into.copy_from_slice(&message);
        }
        Ok(())
    }

    /// The next message of a rank; what it sent before it ended is still there.
    fn next(&self, from: usize) -> Result<Vec<u8>, Failure> {
        let mut post = self.office.open();
        loop {
            if let Some((arrives, message)) = post.boxes[self.rank][from].pop_front() {
                drop(post);
                std::thread::sleep(arrives.saturating_duration_since(Instant::now()));
                return Ok(message);
            }
            if post.ended[from] {
                return Err(Failure::Ended { rank: from });
            }
            post = { self.office.news.wait(post) }.unwrap_or_else(PoisonError::into_inner);
        }
    }
}
