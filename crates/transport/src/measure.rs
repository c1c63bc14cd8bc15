//! What a state says: integrals, extremes, entropy production, the place, width and overshoot of a shock, orders of convergence.

/// `∫u` (u · length^D), summed without loss of digits (Neumaier).
pub fn mass(u: &[f64], cell: f64) -> f64 {
    cell * exact_sum(u.iter().copied())
}

/// `∫u²/2`
pub fn energy(u: &[f64], cell: f64) -> f64 {
    0.5 * product(u, u, cell)
}

/// `∫ab`, summed in the same way.
pub fn product(a: &[f64], b: &[f64], cell: f64) -> f64 {
    cell * exact_sum(a.iter().zip(b).map(|(a, b)| a * b))
}

fn exact_sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut rest) = (0.0, 0.0);
    for v in values {
        let next: f64 = sum + v;
        rest += if f64::abs(sum) >= f64::abs(v) {
            (sum - next) + v
        } else {
            (v - next) + sum
        };
        sum = next;
    }
    sum + rest
}

/// Smallest and largest value.
pub fn extremes(u: &[f64]) -> [f64; 2] {
    // eight at once: one after the other waits for the last
    let (mut low, mut high) = ([f64::INFINITY; 8], [f64::NEG_INFINITY; 8]);
    for part in u.chunks(8) {
        for ((low, high), u) in low.iter_mut().zip(&mut high).zip(part) {
            *low = low.min(*u);
            *high = high.max(*u);
        }
    }
    [
        low.into_iter().fold(f64::INFINITY, f64::min),
        high.into_iter().fold(f64::NEG_INFINITY, f64::max),
    ]
}

/// Total variation along the axes: `Σ |u_{i+1} − u_i|`, over the ends too where the grid is periodic; in a plane times the spacing of the rows.
pub fn total_variation(u: &[f64], cells: [usize; 2], spacing: f64, periodic: bool) -> f64 {
    let [n, rows] = cells;
    let along = |count: usize, lines: usize, at: &dyn Fn(usize, usize) -> f64| -> f64 {
        let steps = if periodic { count } else { count - 1 };
        let line = |l: usize| {
            (0..steps)
                .map(|k| (at(l, (k + 1) % count) - at(l, k)).abs())
                .sum::<f64>()
        };
        (0..lines).map(line).sum()
    };
    let x = along(n, rows, &|j, i| u[j * n + i]);
    match rows {
        1 => x,
        _ => spacing * (x + along(rows, n, &|i, j| u[j * n + i])),
    }
}

/// Production of the entropy η, with flux q, on an interval: `−d/dt ∫η(u) − [q(u)]`, from `η′`, `u_t` and the values at both ends (equal on periodic
/// grids). What solutions of the local law that are limits of viscous ones have is not negative, for convex η.
pub fn entropy_production(
    slope: impl Fn(f64) -> f64,
    flux: impl Fn(f64) -> f64,
    u: &[f64],
    rate: &[f64],
    cell: f64,
    ends: [f64; 2],
) -> f64 {
    let change = cell * exact_sum(u.iter().zip(rate).map(|(u, r)| slope(*u) * r));
    -change - (flux(ends[1]) - flux(ends[0]))
}

/// A front that goes down from `left` to `right`, as a profile shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// Where u is in the middle of both: the last such place, cubically interpolated.
    pub position: f64,
    /// `(left − right)/max|u_x|`
    pub width: f64,
    /// How far u goes beyond `left` and `right` at most; 0 where it does not.
    pub overshoot: f64,
    pub undershoot: f64,
}

/// Looks at a front between the states `left > right`; `None` if u never crosses their middle downwards.
pub fn front(x: &[f64], u: &[f64], left: f64, right: f64) -> Option<Front> {
    let middle = 0.5 * (left + right);
    let n = u.len();
    let i = (0..n.checked_sub(1)?)
        .rev()
        .find(|i| u[*i] > middle && u[i + 1] <= middle)?;
    let first = i.saturating_sub(1).min(n.saturating_sub(4));
    let h = x[1] - x[0];
    let nodes = &u[first..(first + 4).min(n)];
    let value = |s: f64| -> f64 {
        let weight = |k: usize| -> f64 {
            let others = (0..nodes.len()).filter(|m| *m != k);
            others
                .map(|m| (s - m as f64) / (k as f64 - m as f64))
                .product()
        };
        nodes.iter().enumerate().map(|(k, u)| u * weight(k)).sum()
    };
    let (mut low, mut high) = ((i - first) as f64, (i - first + 1) as f64);
    for _ in 0..60 {
        let s = 0.5 * (low + high);
        match value(s) > middle {
            true => low = s,
            false => high = s,
        }
    }
    let steepest = u
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .fold(0.0, f64::max);
    let [least, most] = extremes(u);
    Some(Front {
        position: x[first] + h * 0.5 * (low + high),
        width: (left - right) * h / steepest,
        overshoot: (most - left).max(0.0),
        undershoot: (right - least).max(0.0),
    })
}

/// Largest difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// `∫|a − b|`
pub fn mean_distance(a: &[f64], b: &[f64], cell: f64) -> f64 {
    cell * a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>()
}

/// How far a is from b, over b, in the mean, in the mean square and where it is most: `‖a − b‖/‖b‖` of L1, L2 and L∞; 0 of what is 0 beside 0.
pub fn relative_distances(a: &[f64], b: &[f64]) -> [f64; 3] {
    let norms = |values: &dyn Fn(usize) -> f64| {
        let all = || (0..b.len()).map(|n| values(n).abs());
        let most = all().fold(0.0, f64::max);
        [
            all().sum::<f64>(),
            all().map(|v| v * v).sum::<f64>().sqrt(),
            most,
        ]
    };
    let (off, size) = (norms(&|n| a[n] - b[n]), norms(&|n| b[n]));
    std::array::from_fn(|k| if off[k] == 0.0 { 0.0 } else { off[k] / size[k] })
}

/// Order of convergence from one resolution to the next: slopes of log error over log size.
pub fn orders(sizes: &[f64], errors: &[f64]) -> Vec<f64> {
    let pairs = sizes.windows(2).zip(errors.windows(2));
    pairs
        .map(|(s, e)| libm::log(e[1] / e[0]) / libm::log(s[1] / s[0]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_found_where_it_is() {
        let x: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
        let u: Vec<f64> = x
            .iter()
            .map(|x| 0.5 * (1.0 - ((x - 1.2345) / 0.1).tanh()))
            .collect();
        let f = front(&x, &u, 1.0, 0.0).unwrap();
        assert!((f.position - 1.2345).abs() < 1e-6, "{f:?}");
        assert!((f.width - 0.2).abs() < 1e-3, "{f:?}");
        assert_eq!((f.overshoot, f.undershoot), (0.0, 0.0));
        assert!(front(&x, &vec![1.0; 400], 1.0, 0.0).is_none());
    }

    #[test]
    fn distances_are_those_of_three_norms() {
        let found = relative_distances(&[1.0, 5.0, 2.0], &[1.0, 2.0, -2.0]);
        let exact = [7.0 / 5.0, 5.0 / 3.0, 2.0];
        assert!(found.iter().zip(exact).all(|(f, e)| (f - e).abs() < 1e-15));
        assert_eq!(relative_distances(&[0.0], &[0.0]), [0.0; 3]);
        assert_eq!(relative_distances(&[1.0], &[0.0]), [f64::INFINITY; 3]);
    }

    #[test]
    fn variations_and_orders() {
        assert_eq!(total_variation(&[0.0, 2.0, 1.0], [3, 1], 0.1, true), 4.0);
        assert_eq!(total_variation(&[0.0, 2.0, 1.0], [3, 1], 0.1, false), 3.0);
        assert!((total_variation(&[0.0, 1.0, 0.0, 1.0], [2, 2], 0.5, true) - 2.0).abs() < 1e-15);
        let o = orders(&[0.4, 0.2, 0.1], &[16.0, 4.0, 1.0]);
        assert!(o.iter().all(|o| (o - 2.0).abs() < 1e-12));
    }
}
