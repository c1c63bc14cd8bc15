//! Rows of sparse matrices.

/// Blocks of one partner become one, in order of partners.
pub fn add_alike<const D: usize>(row: &mut Vec<(u32, [[f64; D]; D])>) {
    // stable: sums have one order
    row.sort_by_key(|r| r.0);
    row.dedup_by(|again, kept| {
        let same = again.0 == kept.0;
        if same {
            for a in 0..D {
                for b in 0..D {
                    kept.1[a][b] += again.1[a][b];
                }
            }
        }
        same
    });
}

/// Are `start` the beginnings of `n` rows in `all`, whose entries are below `most`?
pub(super) fn rows(start: &[usize], n: usize, all: &[u32], most: usize) -> Result<(), String> {
    let rises = start.is_sorted() && start.first() == Some(&0) && start.last() == Some(&all.len());
    if start.len() != n + 1 || !rises {
        return Err(format!(
            "the beginnings of {n} rows do not rise from 0 to their {} entries",
            all.len()
        ));
    }
    match all.iter().find(|j| **j as usize >= most) {
        Some(j) => Err(format!("there is no point {j} among {most}")),
        None => Ok(()),
    }
}
