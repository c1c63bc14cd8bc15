//! Linear bodies: the archives that [`crate::write::linear`] describes.

use super::Cells;
use super::body::Points;
use super::error::ReadError;
use super::npz::Npz;
use ndarray::{Array1, Array2, Array3};
use peridyne::spec::{AnyLinearBody, Cloud, LinearBody, LoadMap, MassMatrix};
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
    let mut file = Npz::open(path).map_err(error)?;
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
        ends: None,
        cells: Cells::default(),
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
    loads: Option<Loads>,
    masses: Option<Masses>,
}

/// Masses that couple points.
struct Masses {
    start: Array1<i64>,
    partner: Array1<i32>,
    block: Array3<f64>,
}

impl Masses {
    fn read(file: &mut Npz) -> Result<Masses, String> {
        Ok(Masses {
            start: file.array("mass_start")?,
            partner: file.array("mass_partner")?,
            block: file.array("mass_block")?,
        })
    }

    /// Of a body of `n` points in `d` dimensions.
    fn check(&self, n: usize, d: usize) -> Result<(), String> {
        let all = self.partner.len();
        if self.start.len() != n + 1 || self.block.dim() != (all, d, d) {
            return Err(format!(
                "`mass_start` and `mass_block` do not belong to `mass_partner`: expected {} and ({all}, {d}, {d}) entries",
                n + 1
            ));
        }
        if self.start.iter().any(|s| *s < 0) || self.partner.iter().any(|p| *p < 0) {
            return Err("`mass_start` and `mass_partner` must not be negative".into());
        }
        match self.block.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err("`mass_block` must be finite".into()),
        }
    }

    fn matrix<const D: usize>(&self) -> MassMatrix<D> {
        MassMatrix {
            start: self.start.iter().map(|s| *s as usize).collect(),
            partner: self.partner.iter().map(|p| *p as u32).collect(),
            block: blocks(&self.block),
        }
    }
}

/// Where the loads of a condensed body act.
struct Loads {
    position: Array2<f64>,
    volume: Array1<f64>,
    spacing: Array1<f64>,
    start: Array1<i64>,
    target: Array1<i32>,
    block: Array3<f64>,
}

impl Loads {
    fn read(file: &mut Npz) -> Result<Loads, String> {
        Ok(Loads {
            position: file.array("load_position")?,
            volume: file.array("load_volume")?,
            spacing: file.array("load_spacing")?,
            start: file.array("load_start")?,
            target: file.array("load_target")?,
            block: file.array("load_block")?,
        })
    }

    /// Of a body of `n` points in `d` dimensions.
    fn check(&self, n: usize, d: usize) -> Result<(), String> {
        let m = self.volume.len();
        let targets = self.target.len();
        if self.position.dim() != (m, d)
            || self.start.len() != m + 1
            || self.block.dim() != (targets, d, d)
            || self.spacing.len() != 1
        {
            return Err(format!(
                "`load_position`, `load_volume`, `load_spacing`, `load_start` and `load_block` do not belong together: expected (M, {d}), M, 1, M + 1 and ({targets}, {d}, {d}) entries"
            ));
        }
        let positive = |x: &f64| *x > 0.0 && x.is_finite();
        if !self.volume.iter().chain(&self.spacing).all(positive) {
            return Err("`load_volume` and `load_spacing` must be positive".into());
        }
        if self
            .position
            .iter()
            .chain(&self.block)
            .any(|x| !x.is_finite())
        {
            return Err("`load_position` and `load_block` must be finite".into());
        }
        let ascending = self.start.windows(2).into_iter().all(|w| w[0] <= w[1]);
        if !ascending || self.start[0] != 0 || self.start[m] != targets as i64 {
            return Err(format!(
                "`load_start` must ascend from 0 to the number of targets, {targets}"
            ));
        }
        match self.target.iter().find(|q| **q < 0 || **q as usize >= n) {
            Some(q) => Err(format!(
                "`load_target` names point {q}, the body has points 0 to {}",
                n.saturating_sub(1)
            )),
            None => Ok(()),
        }
    }

    fn load_map<const D: usize>(&self) -> LoadMap<D> {
        LoadMap {
            position: (self.position.outer_iter())
                .map(|x| std::array::from_fn(|a| x[a]))
                .collect(),
            volume: self.volume.to_vec(),
            spacing: self.spacing[0],
            start: self.start.iter().map(|s| *s as usize).collect(),
            target: self.target.iter().map(|q| *q as u32).collect(),
            block: blocks(&self.block),
        }
    }
}

fn blocks<const D: usize>(block: &Array3<f64>) -> Vec<[[f64; D]; D]> {
    let of =
        |c: ndarray::ArrayView2<f64>| std::array::from_fn(|a| std::array::from_fn(|b| c[[a, b]]));
    block.outer_iter().map(of).collect()
}

impl Arrays {
    fn read(file: &mut Npz) -> Result<Arrays, String> {
        let arrays = Arrays {
            position: file.array("position")?,
            volume: file.array("volume")?,
            density: file.array("density")?,
            period: file.array("period")?,
            start: file.array("start")?,
            partner: file.array("partner")?,
            block: file.array("block")?,
            loads: match file.has("load_target") {
                true => Some(Loads::read(file)?),
                false => None,
            },
            masses: match file.has("mass_partner") {
                true => Some(Masses::read(file)?),
                false => None,
            },
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
        if let Some(masses) = &self.masses {
            masses.check(n, d)?;
        }
        match &self.loads {
            Some(loads) => loads.check(n, d),
            None => Ok(()),
        }
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
            block: blocks(&self.block),
            load_map: self.loads.as_ref().map(Loads::load_map),
            mass: self.masses.as_ref().map(Masses::matrix),
        };
        if let Some(mass) = &body.mass {
            mass.check(&body.masses())
                .map_err(|e| format!("`mass_block`: {e}"))?;
        }
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
            load_map: None,
            mass: None,
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
    fn loads_and_asymmetry_are_kept() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("body.npz");
        let mut body = chain();
        body.block[0][0][0] = 1.5;
        body.load_map = Some(LoadMap {
            position: vec![[0.0], [0.5], [1.0]],
            volume: vec![0.5; 3],
            spacing: 0.5,
            start: vec![0, 0, 2, 3],
            target: vec![0, 1, 1],
            block: vec![[[0.5]], [[0.5]], [[1.0]]],
        });
        write_linear(&path, &body).unwrap();
        let mut file = Npz::open(&path).unwrap();
        let asymmetry: Array1<f64> = file.array("asymmetry").unwrap();
        assert_eq!(asymmetry.to_vec(), [0.25]);
        let points = read(&path).unwrap();
        let found = Arc::unwrap_or_clone(points.micromoduli.unwrap()).of::<1>();
        assert_eq!(found.unwrap(), body);
        if let Some(load_map) = &mut body.load_map {
            load_map.target[2] = 3;
        }
        write_linear(&path, &body).unwrap();
        let said = read(&path).unwrap_err().to_string();
        assert!(said.contains("`load_target` names point 3"), "{said}");
    }

    #[test]
    fn masses_that_couple_points_are_kept_and_looked_at() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("body.npz");
        let mut body = chain();
        let own = body.masses();
        body.mass = Some(MassMatrix {
            start: vec![0, 2, 4, 5],
            partner: vec![0, 1, 0, 1, 2],
            block: [own[0] - 0.1, 0.1, 0.1, own[1] - 0.1, own[2]]
                .map(|m| [[m]])
                .to_vec(),
        });
        let back = |body: &LinearBody<1>| {
            write_linear(&path, body).unwrap();
            read(&path).map(|p| {
                Arc::unwrap_or_clone(p.micromoduli.unwrap())
                    .of::<1>()
                    .unwrap()
            })
        };
        assert_eq!(back(&body).unwrap(), body);
        let changed = |change: fn(&mut MassMatrix<1>)| {
            let mut body = body.clone();
            change(body.mass.as_mut().unwrap());
            back(&body).unwrap_err().to_string()
        };
        let said = changed(|m| m.block[1][0][0] = 0.2);
        assert!(said.contains("not the same from both ends"), "{said}");
        let said = changed(|m| m.block[4][0][0] += 0.2);
        assert!(said.contains("the sum of all masses"), "{said}");
        let said = changed(|m| m.partner[4] = 1);
        assert!(said.contains("itself among them"), "{said}");
        let said = changed(|m| m.start[3] = 4);
        assert!(said.contains("`mass_block`"), "{said}");
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
