//! Linear bodies: the archives that [`crate::write::linear`] describes.

use super::{Points, ReadError};
use ndarray::{Array1, Array2, Array3, OwnedRepr};
use ndarray_npy::{NpzReader, ReadableElement};
use peridyne::spec::Cloud;
use peridyne::statics::{AnyLinearBody, LinearBody};
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Reads and checks an archive.
///
/// # Errors
/// The file cannot be read; an array is missing, of another type or shape; a partner that there is not, a value that is not finite.
pub fn read(path: &Path) -> Result<Points, ReadError> {
    let error = |message: String| ReadError {
        file: path.display().to_string(),
        line: None,
        message,
    };
    let file = File::open(path).map_err(|e| error(format!("cannot read it: {e}")))?;
    let mut file =
        NpzReader::new(file).map_err(|e| error(format!("it is no .npz archive: {e}")))?;
    let arrays = Arrays::read(&mut file).map_err(error)?;
    let dimension = arrays.position.ncols();
    let body = match dimension {
        1 => arrays.body::<1>(),
        2 => arrays.body::<2>(),
        3 => arrays.body::<3>(),
        d => Err(format!("`position` has {d} columns, expected 1, 2 or 3")),
    }
    .map_err(error)?;
    Ok(Points {
        cloud: arrays.cloud(),
        dimension: Some(dimension),
        atoms: None,
        micromoduli: Some(Arc::new(body)),
        notes: vec![],
    })
}

struct Arrays {
    position: Array2<f64>,
    volume: Array1<f64>,
    density: Array1<f64>,
    period: Array1<f64>,
    start: Array1<i64>,
    partner: Array1<i32>,
    block: Array3<f64>,
}

fn array<T: ReadableElement, D: ndarray::Dimension>(
    file: &mut NpzReader<File>,
    name: &str,
) -> Result<ndarray::ArrayBase<OwnedRepr<T>, D>, String> {
    file.by_name(name)
        .map_err(|e| format!("the array `{name}` cannot be read: {e}"))
}

impl Arrays {
    fn read(file: &mut NpzReader<File>) -> Result<Arrays, String> {
        let arrays = Arrays {
            position: array(file, "position")?,
            volume: array(file, "volume")?,
            density: array(file, "density")?,
            period: array(file, "period")?,
            start: array(file, "start")?,
            partner: array(file, "partner")?,
            block: array(file, "block")?,
        };
        arrays.check()?;
        Ok(arrays)
    }

    fn check(&self) -> Result<(), String> {
        let (n, d) = self.position.dim();
        let bonds = self.partner.len();
        for (name, found, expected) in [
            ("volume", self.volume.len(), n),
            ("density", self.density.len(), n),
            ("period", self.period.len(), d),
            ("start", self.start.len(), n + 1),
        ] {
            if found != expected {
                return Err(format!(
                    "`{name}` has {found} entries, expected {expected} for {n} points in {d} dimensions"
                ));
            }
        }
        if self.block.dim() != (bonds, d, d) {
            return Err(format!(
                "`block` has the shape {:?}, expected ({bonds}, {d}, {d})",
                self.block.dim()
            ));
        }
        let positive = |x: &f64| *x > 0.0 && x.is_finite();
        if let Some(i) =
            (0..n).find(|i| !positive(&self.volume[*i]) || !positive(&self.density[*i]))
        {
            return Err(format!(
                "point {i} has the volume {} and the density {}, expected positive numbers",
                self.volume[i], self.density[i]
            ));
        }
        if self
            .position
            .iter()
            .chain(&self.block)
            .any(|x| !x.is_finite())
        {
            return Err("`position` and `block` must be finite".into());
        }
        let ascending = self.start.windows(2).into_iter().all(|w| w[0] <= w[1]);
        if !ascending || self.start[0] != 0 || self.start[n] != bonds as i64 {
            return Err(format!(
                "`start` must ascend from 0 to the number of bonds, {bonds}"
            ));
        }
        for i in 0..n {
            let row = self.start[i] as usize..self.start[i + 1] as usize;
            let mut before = -1;
            for k in row {
                let j = self.partner[k];
                if j <= before || j as usize >= n || j as usize == i {
                    return Err(format!(
                        "partner {j} of point {i}: partners are other points, 0 to {}, in ascending order",
                        n.saturating_sub(1)
                    ));
                }
                before = j;
            }
        }
        Ok(())
    }

    fn body<const D: usize>(&self) -> Result<AnyLinearBody, String> {
        let body = LinearBody::<D> {
            position: self
                .position
                .outer_iter()
                .map(|x| std::array::from_fn(|a| x[a]))
                .collect(),
            volume: self.volume.to_vec(),
            density: self.density.to_vec(),
            period: std::array::from_fn(|a| Some(self.period[a]).filter(|p| !p.is_nan())),
            start: self.start.iter().map(|s| *s as usize).collect(),
            partner: self.partner.iter().map(|p| *p as u32).collect(),
            block: self
                .block
                .outer_iter()
                .map(|c| std::array::from_fn(|a| std::array::from_fn(|b| c[[a, b]])))
                .collect(),
        };
        AnyLinearBody::new(body).ok_or_else(|| format!("{D} dimensions"))
    }

    fn cloud(&self) -> Cloud {
        let at =
            |x: ndarray::ArrayView1<f64>| std::array::from_fn(|a| x.get(a).copied().unwrap_or(0.0));
        Cloud {
            position: self.position.outer_iter().map(at).collect(),
            volume: self.volume.to_vec(),
            density: self.density.to_vec(),
            ..Cloud::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::linear::write_linear;

    fn chain() -> LinearBody<1> {
        LinearBody {
            position: vec![[0.0], [1.0], [3.0]],
            volume: vec![1.0, 2.0, 1.0],
            density: vec![1.5; 3],
            period: [None],
            start: vec![0, 1, 3, 4],
            partner: vec![1, 0, 2, 1],
            block: [1.0, 0.5, 1.0, 2.0].map(|c| [[c]]).to_vec(),
        }
    }

    #[test]
    fn what_was_written_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("body.npz");
        write_linear(&path, &chain()).unwrap();
        let points = read(&path).unwrap();
        let body = Arc::unwrap_or_clone(points.micromoduli.unwrap())
            .of::<1>()
            .unwrap();
        assert_eq!(body, chain());
        assert_eq!(points.cloud.position[2], [3.0, 0.0, 0.0]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("body.npz");
        let told = |body: LinearBody<1>| {
            write_linear(&path, &body).unwrap();
            read(&path).unwrap_err().to_string()
        };
        let mut bad = chain();
        bad.partner[2] = 7;
        assert!(told(bad).contains("partner 7 of point 1"));
        let mut bad = chain();
        bad.volume[1] = 0.0;
        assert!(told(bad).contains("point 1 has the volume 0"));
        let mut bad = chain();
        bad.start[3] = 5;
        assert!(told(bad).contains("`start` must ascend"));
        std::fs::write(&path, "no archive").unwrap();
        assert!(
            read(&path)
                .unwrap_err()
                .to_string()
                .contains("no .npz archive")
        );
    }
}
