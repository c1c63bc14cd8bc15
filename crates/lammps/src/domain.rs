//! The simulation box and its faces.

/// How an axis ends on one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    Periodic,
    Fixed,
    /// Follows the atoms.
    Shrink,
    /// Follows the atoms, but never inside the first box.
    ShrinkMinimum,
}

impl Face {
    pub fn parse(c: char) -> Option<Face> {
        Some(match c {
            'p' => Face::Periodic,
            'f' => Face::Fixed,
            's' => Face::Shrink,
            'm' => Face::ShrinkMinimum,
            _ => return None,
        })
    }
    pub fn letter(self) -> char {
        match self {
            Face::Periodic => 'p',
            Face::Fixed => 'f',
            Face::Shrink => 's',
            Face::ShrinkMinimum => 'm',
        }
    }
    fn moves(self) -> bool {
        matches!(self, Face::Shrink | Face::ShrinkMinimum)
    }
}

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimBox {
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// `[axis][0 low, 1 high]`
    pub faces: [[Face; 2]; 3],
    /// Distance that a moving face keeps from the outermost atom.
    gap: [f64; 3],
    first: [[f64; 3]; 2],
}

impl SimBox {
    /// A box around `low..high`; moving faces are pushed out by 1e-4 of the edge.
    pub fn new(low: [f64; 3], high: [f64; 3], faces: [[Face; 2]; 3]) -> SimBox {
        let gap = [0, 1, 2].map(|a| 1e-4 * (high[a] - low[a]));
        let mut b = SimBox {
            low,
            high,
            faces,
            gap,
            first: [low, high],
        };
        for a in 0..3 {
            if faces[a][0] == Face::Shrink {
                b.low[a] -= gap[a];
            }
            if faces[a][1] == Face::Shrink {
                b.high[a] += gap[a];
            }
        }
        b
    }

    pub fn periodic(&self, axis: usize) -> bool {
        self.faces[axis][0] == Face::Periodic
    }

    pub fn edge(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// Does any face follow the atoms?
    pub fn moves(&self) -> bool {
        self.faces.iter().flatten().any(|f| f.moves())
    }

    /// Moves the moving faces to the extent of the atoms of one axis.
    pub fn follow(&mut self, axis: usize, least: f64, greatest: f64) {
        match self.faces[axis][0] {
            Face::Shrink => self.low[axis] = least - self.gap[axis],
            Face::ShrinkMinimum => {
                self.low[axis] = (least - self.gap[axis]).min(self.first[0][axis])
            }
            Face::Periodic | Face::Fixed => {}
        }
        match self.faces[axis][1] {
            Face::Shrink => self.high[axis] = greatest + self.gap[axis],
            Face::ShrinkMinimum => {
                self.high[axis] = (greatest + self.gap[axis]).max(self.first[1][axis])
            }
            Face::Periodic | Face::Fixed => {}
        }
    }

    /// Box of one rank as LAMMPS's `create_atoms` sees it: the upper face does not belong to it, and a periodic
    /// one is moved in by 2e-6 of the edge so that an atom is not made twice.
    pub fn owns(&self, x: [f64; 3]) -> bool {
        (0..3).all(|a| {
            let high = if self.periodic(a) {
                self.high[a] - 2e-6 * self.edge(a)
            } else {
                self.high[a]
            };
            x[a] >= self.low[a] && x[a] < high
        })
    }

    /// Position inside the box and how many periods away it was.
    pub fn wrap(&self, axis: usize, x: f64) -> (f64, i64) {
        let edge = self.edge(axis);
        if !self.periodic(axis) || (x >= self.low[axis] && x < self.high[axis]) {
            return (x, 0);
        }
        let n = ((x - self.low[axis]) / edge).floor();
        let y = x - n * edge;
        if y >= self.high[axis] {
            return (self.low[axis], n as i64 + 1);
        }
        (y.max(self.low[axis]), n as i64)
    }

    /// `(xlo ylo zlo) to (xhi yhi zhi)`
    pub fn describe(&self) -> String {
        corners(self.low, self.high)
    }
}

/// `(xlo ylo zlo) to (xhi yhi zhi)`
pub fn corners(low: [f64; 3], high: [f64; 3]) -> String {
    let three = |v: [f64; 3]| v.map(|x| super::printf::general(x, 8, false)).join(" ");
    format!("({}) to ({})", three(low), three(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periodic_positions_wrap() {
        let b = SimBox::new([0.0; 3], [2.0; 3], [[Face::Periodic; 2]; 3]);
        assert_eq!(b.wrap(0, 2.5), (0.5, 1));
        assert_eq!(b.wrap(0, -0.5), (1.5, -1));
        assert_eq!(b.wrap(0, 2.0), (0.0, 1));
        assert_eq!(b.wrap(0, 1.0), (1.0, 0));
    }

    /// LAMMPS prints -0.0370074 for the box of the impact.
    #[test]
    fn moving_faces_keep_a_gap() {
        let s = [[Face::Shrink; 2]; 3];
        let b = SimBox::new([-0.037, -0.0025, -0.037], [0.037, 0.0, 0.037], s);
        assert_eq!(
            b.describe(),
            "(-0.0370074 -0.00250025 -0.0370074) to (0.0370074 2.5e-07 0.0370074)"
        );
    }
}
