//! Points that two sides of an rigid_body push alike: which of them does is decided by round-off, and a symmetric body is pushed
//! aside.

use peridyne::space::Point;
use peridyne::spec::{RigidBodyMotion, RigidBodySpec, Spec};

/// Parts of the path at which is looked.
const PARTS: u32 = 8;
/// How far around a point (spacings), and cosine of directions that are alike.
const AROUND: f64 = 1e-7;
const ALIKE: f64 = 0.9;

/// Number of such points of each driven rigid_body that does not turn, on its way until `until`.
pub(super) fn ties(spec: &Spec, points: &[Point], spacing: f64, until: f64) -> Vec<usize> {
    let each = spec.loading.rigid_bodies.iter();
    each.map(|i| of_one(i, points, spacing, until)).collect()
}

fn of_one(rigid_body: &RigidBodySpec, points: &[Point], spacing: f64, until: f64) -> usize {
    let (RigidBodyMotion::Kinematic(center), None) = (&rigid_body.motion, &rigid_body.turn) else {
        return 0;
    };
    let tied = |n: u32| {
        let t = until * f64::from(n) / f64::from(PARTS);
        let place: Point = std::array::from_fn(|a| center[a].eval(&[0.0; 3], t));
        let inside = points.iter().filter(|x| {
            let y: Point = std::array::from_fn(|a| x[a] - place[a]);
            let (distance, way) = rigid_body.shape.distance(&y);
            // what is deep inside is no contact; a sphere has its centre
            distance < 0.0 && distance > -spacing && kinks(rigid_body, y, way, spacing)
        });
        inside.count()
    };
    (1..=PARTS).map(tied).max().unwrap_or(0)
}

/// Does the direction jump at a point?
fn kinks(rigid_body: &RigidBodySpec, y: Point, way: Point, spacing: f64) -> bool {
    (0..3).any(|a| {
        [-1.0, 1.0].into_iter().any(|sign| {
            let mut beside = y;
            beside[a] += sign * AROUND * spacing;
            let (_, other) = rigid_body.shape.distance(&beside);
            (0..3).map(|k| way[k] * other[k]).sum::<f64>() < ALIKE
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne_io::deck::Deck;

    /// A box of 4 is pressed into the top layer, z = 0, of points on whole numbers or between them.
    fn tied(origin: f64) -> usize {
        let text = "horizon = { m_ratio = 2 }\nunits = \"none\"\nbody = { lattice = \"cubic\", spacing = 1, cells = [4, 4, 4] }\nmaterial = { density = 1, law = { pmb = { bulk = 1 } } }\nrun = { steps = 1 }\n[[rigid_body]]\nstiffness = 1\nshape = { box = { size = [4, 4, 4] } }\ncenter = [0, 0, \"2 - 0.05*t\"]\n";
        let deck = Deck::parse(text, "d.toml", &[]).unwrap();
        let points: Vec<Point> = (-3..=3)
            .flat_map(|i| (-3..=3).map(move |j| [origin + f64::from(i), f64::from(j), 0.0]))
            .collect();
        ties(&deck.spec, &points, 1.0, 1.0)[0]
    }

    #[test]
    fn points_on_an_edge_of_sides_are_tied_and_others_are_not() {
        assert_eq!(tied(0.0), 0, "points of the rim are on a side, not inside");
        assert_eq!(tied(0.5), 0);
        // deeper than the sides are far: on the diagonals of the corners
        let text = |half: f64| {
            let text = format!(
                "horizon = {{ m_ratio = 2 }}\nunits = \"none\"\nbody = {{ lattice = \"cubic\", spacing = 1, cells = [4, 4, 4] }}\nmaterial = {{ density = 1, law = {{ pmb = {{ bulk = 1 }} }} }}\nrun = {{ steps = 1 }}\n[[rigid_body]]\nstiffness = 1\nshape = {{ box = {{ size = [{0}, {0}, 4] }} }}\ncenter = [0, 0, \"2 - 0.5*t\"]\n",
                2.0 * half
            );
            Deck::parse(&text, "d.toml", &[]).unwrap().spec
        };
        let corner: Vec<Point> = [-2.0, 2.0]
            .into_iter()
            .flat_map(|x| [-2.0, 2.0].map(|y| [x, y, 0.0]))
            .collect();
        assert_eq!(ties(&text(2.1), &corner, 1.0, 1.0), [4]);
        assert_eq!(ties(&text(3.0), &corner, 1.0, 1.0), [0]);
    }
}
