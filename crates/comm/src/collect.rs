//! What all ranks do together, made of exchanges.

use crate::comm::Comm;
use crate::failure::Failure;

impl Comm {
    /// The bytes of every rank, in the order of ranks, on all of them. In as many rounds as 2 has to be doubled to reach the number of ranks, each of which
    /// hands on what is there already (Bruck et al. 1997, concatenation).
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn all(&self, own: &[u8]) -> Result<Vec<Vec<u8>>, Failure> {
        let (rank, ranks) = (self.rank(), self.ranks());
        self.count_round();
        // those of this rank and of the ones after it, in a ring
        let mut there = vec![own.to_vec()];
        while there.len() < ranks {
            let have = there.len();
            let count = have.min(ranks - have);
            let to = (rank + ranks - have) % ranks;
            let from = (rank + have) % ranks;
            let sizes: Vec<u8> = { there[..count].iter() }
                .flat_map(|bytes| (bytes.len() as u64).to_le_bytes())
                .collect();
            let mut sizes_there = vec![0; sizes.len()];
            self.trade(&[(to, &sizes)], &mut [(from, &mut sizes_there)], || ())?;
            let sizes_there = sizes_there.chunks_exact(8);
            let mut new: Vec<Vec<u8>> = sizes_there
                .map(|size| vec![0; u64::from_le_bytes(size.try_into().unwrap()) as usize])
                .collect();
            // nothing is no message
            let send: Vec<(usize, &[u8])> = { there[..count].iter() }
                .filter(|bytes| !bytes.is_empty())
                .map(|bytes| (to, &bytes[..]))
                .collect();
            let mut receive: Vec<(usize, &mut [u8])> = { new.iter_mut() }
                .filter(|bytes| !bytes.is_empty())
                .map(|bytes| (from, &mut bytes[..]))
                .collect();
            self.trade(&send, &mut receive, || ())?;
            there.append(&mut new);
        }
        there.rotate_right(rank);
        Ok(there)
    }

    /// The bytes of every rank, in the order of ranks, on all of them, one after the other: all have as many. In as many rounds as [`Comm::all`] takes, with
    /// half of its messages.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn all_as_long(&self, own: &[u8]) -> Result<Vec<u8>, Failure> {
        let (rank, ranks, size) = (self.rank(), self.ranks(), own.len());
        self.count_round();
        let mut there = own.to_vec();
        let mut have = 1;
        while have < ranks && size > 0 {
            let count = have.min(ranks - have);
            let to = (rank + ranks - have) % ranks;
            let from = (rank + have) % ranks;
            let mut new = vec![0; count * size];
            self.trade(
                &[(to, &there[..count * size])],
                &mut [(from, &mut new)],
                || (),
            )?;
            there.append(&mut new);
            have += count;
        }
        there.rotate_right(rank * size);
        Ok(there)
    }

    /// What every rank has for this one, in their order; `own` is what this one has for each. Most have nothing for most.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn to_each(&self, mut own: Vec<Vec<u8>>) -> Result<Vec<Vec<u8>>, Failure> {
        let sizes: Vec<u8> = { own.iter() }
            .flat_map(|bytes| (bytes.len() as u64).to_le_bytes())
            .collect();
        let here = self.rank();
        let sizes = self.all(&sizes)?;
        let of_this = sizes.iter().map(|sizes| {
            let size = sizes[8 * here..][..8].try_into().expect("eight bytes");
            vec![0; u64::from_le_bytes(size) as usize]
        });
        let mut all: Vec<Vec<u8>> = of_this.collect();
        let there = |(rank, bytes): &(usize, &mut Vec<u8>)| *rank != here && !bytes.is_empty();
        let send: Vec<(usize, &[u8])> = { own.iter_mut().enumerate().filter(there) }
            .map(|(rank, bytes)| (rank, &bytes[..]))
            .collect();
        let mut receive: Vec<(usize, &mut [u8])> = { all.iter_mut().enumerate().filter(there) }
            .map(|(rank, bytes)| (rank, &mut bytes[..]))
            .collect();
        self.exchange(&send, &mut receive, || ())?;
        all[here] = std::mem::take(&mut own[here]);
        Ok(all)
    }

    /// The bytes of every rank, in the order of ranks, on the first; `None` on the others.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn first(&self, own: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, Failure> {
        let size = (own.len() as u64).to_le_bytes();
        if self.rank() > 0 {
            let none = &mut [];
            self.exchange(&[(0, &size)], none, || ())?;
            if !own.is_empty() {
                self.exchange(&[(0, &own)], none, || ())?;
            }
            return Ok(None);
        }
        let mut sizes = vec![[0; 8]; self.ranks()];
        let mut receive: Vec<(usize, &mut [u8])> = { sizes.iter_mut().enumerate().skip(1) }
            .map(|(rank, size)| (rank, &mut size[..]))
            .collect();
        self.exchange(&[], &mut receive, || ())?;
        let mut all: Vec<Vec<u8>> = { sizes.into_iter() }
            .map(|size| vec![0; u64::from_le_bytes(size) as usize])
            .collect();
        let mut receive: Vec<(usize, &mut [u8])> = { all.iter_mut().enumerate().skip(1) }
            .filter(|(_, bytes)| !bytes.is_empty())
            .map(|(rank, bytes)| (rank, &mut bytes[..]))
            .collect();
        self.exchange(&[], &mut receive, || ())?;
        all[0] = own;
        Ok(Some(all))
    }

    /// What the first rank has for each, in their order; the others have nothing to say.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn of_first(&self, mut all: Vec<Vec<u8>>) -> Result<Vec<u8>, Failure> {
        if self.rank() == 0 {
            let sizes: Vec<[u8; 8]> = { all.iter() }
                .map(|bytes| (bytes.len() as u64).to_le_bytes())
                .collect();
            let send = sizes.iter().enumerate().skip(1);
            let send: Vec<(usize, &[u8])> = send.map(|(rank, size)| (rank, &size[..])).collect();
            self.exchange(&send, &mut [], || ())?;
            let send = all
                .iter()
                .enumerate()
                .skip(1)
                .filter(|(_, bytes)| !bytes.is_empty());
            let send: Vec<(usize, &[u8])> = send.map(|(rank, bytes)| (rank, &bytes[..])).collect();
            self.exchange(&send, &mut [], || ())?;
            return Ok(all.swap_remove(0));
        }
        let mut size = [0; 8];
        self.exchange(&[], &mut [(0, &mut size)], || ())?;
        let mut own = vec![0; u64::from_le_bytes(size) as usize];
        if !own.is_empty() {
            self.exchange(&[], &mut [(0, &mut own)], || ())?;
        }
        Ok(own)
    }

    /// Returns when all ranks have come here.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn barrier(&self) -> Result<(), Failure> {
        self.all(&[]).map(|_| ())
    }
}
