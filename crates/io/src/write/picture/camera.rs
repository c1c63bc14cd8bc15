//! Orthographic cameras, and what they see of some points.

/// An orthonormal frame: screen right, screen up, towards the viewer; and the elevation of the viewer above
/// the plane that he looks along (sine and cosine).
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    pub right: [f64; 3],
    pub up: [f64; 3],
    pub toward: [f64; 3],
    pub sine: f64,
    pub cosine: f64,
}

impl Camera {
    /// Looks at a body whose `right` and `top` directions are given (orthonormal) from the front, `elevation` (radian)
    /// above the horizon; π/2 looks straight down.
    pub fn new(right: [f64; 3], top: [f64; 3], elevation: f64) -> Self {
        let back = cross(top, right);
        let (mut sine, mut cosine) = libm::sincos(elevation);
        if cosine < 1e-9 {
            (sine, cosine) = (1.0, 0.0);
        }
        let combine = |a: f64, b: f64| std::array::from_fn(|i| a * top[i] + b * back[i]);
        Camera {
            right,
            up: combine(cosine, sine),
            toward: combine(sine, -cosine),
            sine,
            cosine,
        }
    }

    /// Screen right and up, and distance towards the viewer (length).
    pub fn project(&self, x: [f64; 3]) -> [f64; 3] {
        [dot(self.right, x), dot(self.up, x), dot(self.toward, x)]
    }
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What a camera sees of some points: the frame in the camera's coordinates (length).
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Frame {
    /// The smallest frame around points that are cubes of edge `spacing`; `None` without points.
    pub fn around(
        camera: &Camera,
        points: impl Iterator<Item = [f64; 3]>,
        spacing: f64,
    ) -> Option<Self> {
        let mut frame = Frame {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        };
        for x in points {
            let p = camera.project(x);
            for ((low, high), p) in frame.low.iter_mut().zip(&mut frame.high).zip(p) {
                *low = low.min(p - spacing);
                *high = high.max(p + spacing);
            }
        }
        (frame.low[0] <= frame.high[0]).then_some(frame)
    }

    pub fn size(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    /// The smallest one around both.
    pub fn with(&self, other: &Frame) -> Frame {
        Frame {
            low: std::array::from_fn(|a| self.low[a].min(other.low[a])),
            high: std::array::from_fn(|a| self.high[a].max(other.high[a])),
        }
    }
}
