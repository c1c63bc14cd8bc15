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
            self.exchange(&[(to, &sizes)], &mut [(from, &mut sizes_there)], || ())?;
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
            self.exchange(&send, &mut receive, || ())?;
            there.append(&mut new);
        }
        there.rotate_right(rank);
        Ok(there)
    }

    /// Numbers of all ranks, one rank's after the other's, on all of them: with blocks in the order of ranks, the blocks of the whole body, whose sum
    /// does not depend on who computed which.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn all_numbers(&self, own: &[f64]) -> Result<Vec<f64>, Failure> {
        let bytes: Vec<u8> = own.iter().flat_map(|x| x.to_le_bytes()).collect();
        let all = self.all(&bytes)?.concat();
        let numbers = all.chunks_exact(8);
        Ok(numbers
            .map(|x| f64::from_le_bytes(x.try_into().unwrap()))
            .collect())
    }

    /// Returns when all ranks have come here.
    ///
    /// # Errors
    /// As of [`Comm::exchange`].
    pub fn barrier(&self) -> Result<(), Failure> {
        self.all(&[]).map(|_| ())
    }
}
