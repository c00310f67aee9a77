//! Gauss and Gauss–Lobatto points on \[−1, 1\], and Lagrange polynomials through points.
//! Sources: Abramowitz & Stegun 1964, 25.4.29 and 25.4.32; Berrut & Trefethen 2004.

/// Returns Legendre's polynomial P_n and its derivative at |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    if n == 0 {
        return (1.0, 0.0);
    }
    for k in 1..n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
    }
    (value, n as f64 * (before - x * value) / (1.0 - x * x))
}

/// Makes points and weights symmetric to the last bit.
fn symmetric(mut points: Vec<f64>, mut weights: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let n = points.len();
    for i in 0..n / 2 {
        points[n - 1 - i] = -points[i];
        weights[n - 1 - i] = weights[i];
    }
    if n % 2 == 1 {
        points[n / 2] = 0.0;
    }
    (points, weights)
}

/// Returns Gauss's rule of n points, ascending: exact up to degree 2n − 1.
pub fn gauss(n: usize) -> (Vec<f64>, Vec<f64>) {
    let point = |i: usize| {
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..20 {
            let (value, slope) = legendre(n, x);
            x -= value / slope;
        }
        x
    };
    let points: Vec<f64> = (0..n).map(point).collect();
    let weight = |&x: &f64| 2.0 / ((1.0 - x * x) * legendre(n, x).1.powi(2));
    let weights = points.iter().map(weight).collect();
    symmetric(points, weights)
}

/// Returns the Gauss–Lobatto rule of n ≥ 2 points, ascending, with both ends: exact up to degree 2n − 3.
pub fn lobatto(n: usize) -> (Vec<f64>, Vec<f64>) {
    let degree = n - 1;
    let m = degree as f64;
    let point = |i: usize| {
        if i == 0 {
            return -1.0;
        }
        if i == degree {
            return 1.0;
        }
        // Zeros of P'_m by Newton's method; (1 − x²) P'' = 2 x P' − m (m + 1) P.
        let mut x = -(std::f64::consts::PI * i as f64 / m).cos();
        for _ in 0..20 {
            let (value, slope) = legendre(degree, x);
            x -= slope * (1.0 - x * x) / (2.0 * x * slope - m * (m + 1.0) * value);
        }
        x
    };
    let points: Vec<f64> = (0..n).map(point).collect();
    let weight = |&x: &f64| {
        let value = if x.abs() == 1.0 { 1.0 } else { legendre(degree, x).0 };
        2.0 / (m * (m + 1.0) * value * value)
    };
    let weights = points.iter().map(weight).collect();
    symmetric(points, weights)
}

/// Returns the values of the Lagrange polynomials through `nodes` at x.
pub fn lagrange(nodes: &[f64], x: f64) -> Vec<f64> {
    let factor = |i: usize| move |(j, node): (usize, &f64)| (j != i).then(|| (x - node) / (nodes[i] - node));
    (0..nodes.len()).map(|i| nodes.iter().enumerate().filter_map(factor(i)).product()).collect()
}

/// Returns the derivatives of the Lagrange polynomials through `nodes` at x.
pub fn lagrange_slopes(nodes: &[f64], x: f64) -> Vec<f64> {
    let slope = |i: usize| -> f64 {
        let others = || (0..nodes.len()).filter(move |&j| j != i);
        let term = |k: usize| -> f64 {
            let rest: f64 = others().filter(|&j| j != k).map(|j| (x - nodes[j]) / (nodes[i] - nodes[j])).product();
            rest / (nodes[i] - nodes[k])
        };
        others().map(term).sum()
    };
    (0..nodes.len()).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment((points, weights): &(Vec<f64>, Vec<f64>), power: i32) -> f64 {
        points.iter().zip(weights).map(|(x, w)| w * x.powi(power)).sum()
    }

    /// Both rules integrate every power up to their degree exactly.
    #[test]
    fn rules_are_exact_to_their_degree() {
        for n in 1..=8 {
            let exact = |power: i32| if power % 2 == 0 { 2.0 / (f64::from(power) + 1.0) } else { 0.0 };
            for power in 0..2 * n {
                assert!((moment(&gauss(n as usize), power) - exact(power)).abs() < 1e-14, "Gauss {n}, x^{power}");
            }
            for power in 0..2 * n - 2 {
                assert!((moment(&lobatto(n as usize), power) - exact(power)).abs() < 1e-14, "Lobatto {n}, x^{power}");
            }
        }
        assert!((lobatto(4).0[1] + 0.2f64.sqrt()).abs() < 1e-16);
    }

    /// Interpolation and its derivative are exact for polynomials of the same degree.
    #[test]
    fn lagrange_polynomials_interpolate() {
        let nodes = lobatto(4).0;
        for x in [-1.0, -0.3, 0.9, 1.0] {
            let cubic = |x: f64| x * x * x - 2.0 * x + 1.0;
            let value: f64 = lagrange(&nodes, x).iter().zip(&nodes).map(|(l, n)| l * cubic(*n)).sum();
            let slope: f64 = lagrange_slopes(&nodes, x).iter().zip(&nodes).map(|(l, n)| l * cubic(*n)).sum();
            assert!((value - cubic(x)).abs() < 1e-14 && (slope - 3.0 * x * x + 2.0).abs() < 1e-13);
        }
    }
}
