//! Orders of convergence: what a series of errors says.

/// Which of the two lengths of a peridynamic model shrinks: horizon δ, spacing Δx; m = δ/Δx.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// δ → 0 at fixed m: towards an approximation of the local solution.
    Delta,
    /// Δx → 0 at fixed δ: towards the nonlocal solution.
    M,
    /// δ → 0 while m grows: towards the local solution.
    DeltaM,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Delta => "δ-convergence",
            Kind::M => "m-convergence",
            Kind::DeltaM => "δm-convergence",
        }
    }

    /// The study that these pairs of (δ, Δx) are; `None` if neither shrinks from each to the next.
    pub fn of(pairs: &[[f64; 2]]) -> Option<Kind> {
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs();
        let steps = || pairs.windows(2).map(|w| (w[0], w[1]));
        let ratio = |p: [f64; 2]| p[0] / p[1];
        if pairs.len() < 2 || steps().any(|(a, b)| b[1] >= a[1]) {
            return None;
        }
        if steps().all(|(a, b)| same(a[0], b[0])) {
            Some(Kind::M)
        } else if steps().any(|(a, b)| b[0] >= a[0]) {
            None
        } else if steps().all(|(a, b)| same(ratio(a), ratio(b))) {
            Some(Kind::Delta)
        } else if steps().all(|(a, b)| ratio(b) > ratio(a)) {
            Some(Kind::DeltaM)
        } else {
            None
        }
    }
}

/// What a series of errors says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Errors fall with one order.
    Converges,
    /// Errors fall, and the order has not settled.
    Preasymptotic,
    /// Errors stop falling: another error remains (of fixed m, of the time step, of round-off).
    Stalls,
    /// Errors do not fall.
    Diverges,
    /// There is one pair of levels: it has an order, and nothing says whether that is settled.
    Undecided,
}

/// Fitted order of `error ≈ C h^order`.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// Least squares over all logarithms.
    pub fitted: f64,
    /// C
    pub constant: f64,
    /// Between neighbours, from coarse to fine.
    pub pairwise: Vec<f64>,
    pub verdict: Verdict,
}

/// From `(h, error)`, in any order; `None` with fewer than two different h or without positive numbers.
pub fn order(series: &[(f64, f64)]) -> Option<Order> {
    let mut points: Vec<(f64, f64)> = series.to_vec();
    if points
        .iter()
        .any(|(h, e)| !(*h > 0.0 && *e > 0.0 && h.is_finite() && e.is_finite()))
    {
        return None;
    }
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    if points.len() < 2 || points.windows(2).any(|w| w[0].0 == w[1].0) {
        return None;
    }
    let n = points.len() as f64;
    let logs: Vec<[f64; 2]> = points
        .iter()
        .map(|(h, e)| [libm::log(*h), libm::log(*e)])
        .collect();
    let mean = |a: usize| logs.iter().map(|l| l[a]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let cross: f64 = logs.iter().map(|l| (l[0] - x) * (l[1] - y)).sum();
    let square: f64 = logs.iter().map(|l| (l[0] - x).powi(2)).sum();
    let fitted = cross / square;
    let pairwise: Vec<f64> = logs
        .windows(2)
        .map(|w| (w[0][1] - w[1][1]) / (w[0][0] - w[1][0]))
        .collect();
    Some(Order {
        fitted,
        constant: libm::exp(y - fitted * x),
        verdict: verdict(&pairwise, fitted),
        pairwise,
    })
}

fn verdict(pairwise: &[f64], fitted: f64) -> Verdict {
    let last = pairwise.last().copied().unwrap_or(fitted);
    let fastest = pairwise.iter().copied().fold(f64::MIN, f64::max);
    if pairwise.len() < 2 {
        Verdict::Undecided
    } else if fitted < 0.1 {
        Verdict::Diverges
    } else if last < 0.25 * fastest {
        Verdict::Stalls
    } else if pairwise
        .iter()
        .any(|p| (p - last).abs() > 0.15 * last.abs())
    {
        Verdict::Preasymptotic
    } else {
        Verdict::Converges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(f: impl Fn(f64) -> f64) -> Order {
        let series: Vec<_> = [0.8, 0.1, 0.4, 0.2].iter().map(|h| (*h, f(*h))).collect();
        order(&series).unwrap()
    }

    #[test]
    fn powers_are_found() {
        let o = errors(|h| 3.0 * h * h);
        assert!((o.fitted - 2.0).abs() < 1e-13 && (o.constant - 3.0).abs() < 1e-12);
        assert_eq!((o.pairwise.len(), o.verdict), (3, Verdict::Converges));
    }

    #[test]
    fn verdicts() {
        assert_eq!(errors(|h| h * h + 0.1).verdict, Verdict::Stalls);
        assert_eq!(
            errors(|h| h.powi(4) + 0.1 * h).verdict,
            Verdict::Preasymptotic
        );
        assert_eq!(errors(|h| 1.0 / h).verdict, Verdict::Diverges);
        let pair = order(&[(1.0, 1.0), (0.5, 0.25)]).unwrap();
        assert_eq!((pair.pairwise[0], pair.verdict), (2.0, Verdict::Undecided));
        assert_eq!(order(&[(1.0, 1.0)]), None);
        assert_eq!(order(&[(1.0, 1.0), (1.0, 2.0)]), None);
        assert_eq!(order(&[(1.0, 1.0), (0.5, 0.0)]), None);
    }

    #[test]
    fn studies_have_names() {
        let name = |pairs: &[[f64; 2]]| Kind::of(pairs).map(Kind::name);
        assert_eq!(name(&[[0.4, 0.1], [0.2, 0.05]]), Some("δ-convergence"));
        assert_eq!(name(&[[0.4, 0.1], [0.4, 0.05]]), Some("m-convergence"));
        assert_eq!(name(&[[0.4, 0.1], [0.3, 0.05]]), Some("δm-convergence"));
        assert_eq!(name(&[[0.4, 0.1], [0.1, 0.05]]), None);
        assert_eq!(name(&[[0.4, 0.1], [0.4, 0.1]]), None);
    }
}
