//! What is done to sets of points: values held, fluxes, sources, exchange with the surroundings.

use super::account::Gained;
use crate::boundary_condition::Program;
use crate::expression::Expression;
use crate::space::Point;

/// One expression on a list of points.
type One = Program<1>;

fn one(e: &Expression, points: &[Point]) -> One {
    Program::new(&[Some(e.clone()), None, None], points)
}

#[derive(Debug, Clone)]
enum Kind {
    Held(One),
    /// Power per volume or area, and the volume or area of each point.
    Power(One, Vec<f64>),
    Convection([One; 2], Vec<f64>),
    Radiation([One; 2], Vec<f64>),
}

/// On points, by their places.
#[derive(Debug, Clone)]
pub struct Condition {
    kind: Kind,
    places: Vec<u32>,
    points: Vec<Point>,
}

impl Condition {
    fn new(kind: Kind, places: Vec<u32>, points: Vec<Point>) -> Self {
        Condition {
            kind,
            places,
            points,
        }
    }

    pub fn held(value: &Expression, places: Vec<u32>, points: Vec<Point>) -> Self {
        Self::new(Kind::Held(one(value, &points)), places, points)
    }

    /// `size`: volume, or share of the area, of each point.
    pub fn power(value: &Expression, size: Vec<f64>, places: Vec<u32>, points: Vec<Point>) -> Self {
        Self::new(Kind::Power(one(value, &points), size), places, points)
    }

    pub fn convection(
        [h, ambient]: [&Expression; 2],
        area: Vec<f64>,
        places: Vec<u32>,
        points: Vec<Point>,
    ) -> Self {
        let programs = [one(h, &points), one(ambient, &points)];
        Self::new(Kind::Convection(programs, area), places, points)
    }

    pub fn radiation(
        [c, ambient]: [&Expression; 2],
        area: Vec<f64>,
        places: Vec<u32>,
        points: Vec<Point>,
    ) -> Self {
        let programs = [one(c, &points), one(ambient, &points)];
        Self::new(Kind::Radiation(programs, area), places, points)
    }

    /// Places whose value is held.
    pub fn holds(&self) -> &[u32] {
        match self.kind {
            Kind::Held(_) => &self.places,
            Kind::Power(..) | Kind::Convection(..) | Kind::Radiation(..) => &[],
        }
    }

    /// Places that give the more the higher their value is.
    pub fn exchanges(&self) -> &[u32] {
        match self.kind {
            Kind::Held(_) | Kind::Power(..) => &[],
            Kind::Convection(..) | Kind::Radiation(..) => &self.places,
        }
    }

    /// Sets held values to those of time `t`.
    pub fn place(&self, value: &mut [f64], t: f64) {
        if let Kind::Held(program) = &self.kind {
            for (k, i) in self.places.iter().enumerate() {
                value[*i as usize] = program.at(0, k, &self.points[k], t);
            }
        }
    }

    /// Visits `(place, power, −∂power/∂T)` at values and a time.
    fn each(&self, value: &[f64], t: f64, mut visit: impl FnMut(usize, f64, f64)) {
        let at = |p: &One, k: usize| p.at(0, k, &self.points[k], t);
        for (k, i) in self.places.iter().enumerate() {
            let i = *i as usize;
            match &self.kind {
                Kind::Held(_) => return,
                Kind::Power(p, size) => visit(i, size[k] * at(p, k), 0.0),
                Kind::Convection([h, ambient], area) => {
                    let slope = area[k] * at(h, k);
                    visit(i, slope * (at(ambient, k) - value[i]), slope);
                }
                Kind::Radiation([c, ambient], area) => {
                    let (slope, around) = (area[k] * at(c, k), at(ambient, k));
                    let now = value[i];
                    visit(
                        i,
                        slope * (around.powi(4) - now.powi(4)),
                        4.0 * slope * now.powi(3),
                    );
                }
            }
        }
    }

    /// Adds its powers to `into`, and `time` times them to the account.
    pub(super) fn add(
        &self,
        value: &[f64],
        (t, time): (f64, f64),
        into: &mut [f64],
        account: &mut Gained,
    ) {
        let sum = match self.kind {
            Kind::Held(_) => return,
            Kind::Power(..) => &mut account.supplied,
            Kind::Convection(..) | Kind::Radiation(..) => &mut account.exchanged,
        };
        self.each(value, t, |i, power, _| {
            into[i] += power;
            sum.add(time * power);
        });
    }

    /// Adds the slopes alone.
    pub fn add_slope(&self, value: &[f64], t: f64, slope: &mut [f64]) {
        self.each(value, t, |i, _, by_value| slope[i] += by_value);
    }
}
