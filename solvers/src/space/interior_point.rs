//! A homogeneous primal–dual interior point method with Mehrotra's predictor and corrector.
//!
//! The greatest λ with A y + λ p + w = 0 and y in the cones has the dual problem: least −w·q with p·q = 1 and z = Aᵀ q in
//! the cones. The homogeneous model is
//!
//! ```text
//! A y + λ p + τ w = 0,   Aᵀ q − z = 0,   p·q − τ = 0,   w·q + λ − κ = 0,   y·z = 0,   τ κ = 0
//! ```
//!
//! It is its own dual, and always has a solution. With τ > 0, y/τ and q/τ are the optimum. With κ > 0, y is a ray
//! (λ > 0), or q is a motion on which the fixed loads do work that nothing resists. Sources: Ye, Todd and Mizuno (1994);
//! Andersen, Roos and Terlaky (2003), *Math. Program.* 95, 249–277; Mehrotra (1992).

use super::cone::{Cone, Scaling, UNIT, inner, plus, product, quotient, step_length};
use super::program::{Bodies, Program};
use super::settings::SETTINGS;
use super::stiffness::Stiffness;

/// A point of the homogeneous model, or a change of it.
#[derive(Debug, Clone)]
pub struct State {
    /// Forces of the points.
    pub y: Vec<Cone>,
    /// Rates of the points.
    pub z: Vec<Cone>,
    /// Velocities of the bodies.
    pub q: Bodies,
    /// Load factor.
    pub lambda: f64,
    /// Scale of the optimum.
    pub tau: f64,
    /// Scale of the refutation.
    pub kappa: f64,
}

/// Residuals of the linear equations.
pub struct Residuals {
    /// Equilibrium of the bodies.
    pub equilibrium: Bodies,
    /// Rates of the points.
    pub rates: Vec<Cone>,
    /// Power of the varying loads, and the gap.
    pub scalars: [f64; 2],
}

/// Solves one program step by step.
pub struct InteriorPoint<'a> {
    /// The program.
    pub program: &'a Program,
    /// Stiffness at the present state.
    pub stiffness: Stiffness,
    /// The present state.
    pub state: State,
    /// Scalings at the present state.
    pub scalings: Vec<Scaling>,
    residuals: Residuals,
    roots: Vec<[Cone; 3]>,
    /// Motions caused by the varying loads and by the loads at the start.
    responses: [Bodies; 2],
    /// Inverse of the system of λ and τ.
    inverse: [[f64; 2]; 2],
    /// True if λ stays zero.
    pub held: bool,
    /// True if τ stays one: the optimum exists, and residuals vanish after a full step.
    pub settled: bool,
    /// True once a full step has made the rates compatible with the motion.
    compatible: bool,
}

/// Returns a·b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the greatest absolute entry.
pub fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Adds s b to a.
pub fn add(a: &mut [f64], s: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += s * b);
}

impl State {
    fn start(program: &Program) -> Self {
        let units = vec![UNIT; program.points.len()];
        State { y: units.clone(), z: units, q: vec![0.0; program.base.len()], lambda: 0.0, tau: 1.0, kappa: 1.0 }
    }

    /// Returns the mean product of forces and rates, with τ κ.
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.y.iter().zip(&self.z).map(|(y, z)| inner(y, z)).sum();
        let scalars = self.tau * self.kappa;
        (sum + scalars) / (self.y.len() + usize::from(scalars > 0.0)) as f64
    }

    /// Returns all forces divided by a number.
    pub fn forces(&self, by: f64) -> Vec<Cone> {
        self.y.iter().map(|y| y.map(|x| x / by)).collect()
    }

    /// Returns the longest steps of forces and of rates along a direction within all cones. With τ and κ both are equal.
    fn longest(&self, step: &State) -> [f64; 2] {
        let scalar = |x: f64, d: f64| if d < 0.0 { -x / d } else { f64::INFINITY };
        let most = scalar(self.tau, step.tau).min(scalar(self.kappa, step.kappa));
        let of = |x: &[Cone], d: &[Cone]| x.iter().zip(d).fold(most, |most, (x, d)| step_length(x, d, most));
        let lengths = [of(&self.y, &step.y), of(&self.z, &step.z)];
        if self.kappa > 0.0 { [lengths[0].min(lengths[1]); 2] } else { lengths }
    }

    /// Returns the mean product after steps of forces and of rates.
    fn mean_after(&self, [p, d]: [f64; 2], step: &State) -> f64 {
        let forces = self.y.iter().zip(&step.y).map(|(y, dy)| plus(y, p, dy));
        let rates = self.z.iter().zip(&step.z).map(|(z, dz)| plus(z, d, dz));
        forces.zip(rates).map(|(y, z)| inner(&y, &z)).sum::<f64>() / self.y.len() as f64
    }

    fn advance(&mut self, [p, d]: [f64; 2], step: &State) {
        self.y.iter_mut().zip(&step.y).for_each(|(y, dy)| *y = plus(y, p, dy));
        self.z.iter_mut().zip(&step.z).for_each(|(z, dz)| *z = plus(z, d, dz));
        add(&mut self.q, d, &step.q);
        self.lambda += p * step.lambda;
        self.tau += p * step.tau;
        self.kappa += p * step.kappa;
    }
}

impl<'a> InteriorPoint<'a> {
    /// Starts at the centre. `held`: λ stays zero, which asks if the loads at the start are carried. `None` if memory is
    /// short.
    pub fn new(program: &'a Program, held: bool) -> Option<Self> {
        let nothing = vec![0.0; program.base.len()];
        let residuals = Residuals { equilibrium: nothing.clone(), rates: Vec::new(), scalars: [0.0; 2] };
        let mut method = InteriorPoint {
            program,
            stiffness: Stiffness::new(program)?,
            state: State::start(program),
            scalings: Vec::new(),
            residuals,
            roots: Vec::new(),
            responses: [nothing.clone(), nothing],
            inverse: [[0.0; 2]; 2],
            held,
            settled: false,
            compatible: false,
        };
        method.residuals = method.present_residuals();
        Some(method)
    }

    fn present_residuals(&self) -> Residuals {
        let State { y, z, q, lambda, tau, kappa } = &self.state;
        let rates = self.program.rates(q).iter().zip(z).map(|(a, z)| plus(a, -1.0, z)).collect();
        let power = if self.held { 0.0 } else { dot(&self.program.varying, q) - tau };
        let gap = if self.settled { 0.0 } else { dot(&self.program.base, q) + lambda - kappa };
        Residuals { equilibrium: self.program.imbalance(y, *lambda, *tau), rates, scalars: [power, gap] }
    }

    /// Factorises at the present state. `None` if rounding has left the cones.
    pub fn factorise(&mut self) -> Option<()> {
        let State { y, z, .. } = &self.state;
        self.scalings = y.iter().zip(z).map(|(y, z)| Scaling::new(y, z)).collect::<Option<_>>()?;
        self.roots = self.scalings.iter().map(Scaling::root).collect();
        self.stiffness.factorise(self.program, self.roots.iter()).then_some(())?;
        let [v, w] = &mut self.responses;
        v.copy_from_slice(&self.program.varying);
        w.copy_from_slice(&self.program.base);
        self.stiffness.solve(v);
        self.stiffness.solve(w);
        let (p, b) = (&self.program.varying, &self.program.base);
        let ratio = self.state.kappa / self.state.tau;
        let [[k, l], [m, n]] = [[dot(p, v), dot(p, w) - 1.0], [dot(b, v) + 1.0, dot(b, w) + ratio]];
        let determinant = k * n - l * m;
        self.inverse = match (self.held, self.settled) {
            (false, false) => [[n / determinant, -l / determinant], [-m / determinant, k / determinant]],
            (false, true) => [[k.recip(), 0.0], [0.0, 0.0]],
            (true, false) => [[0.0, 0.0], [0.0, n.recip()]],
            (true, true) => [[0.0; 2]; 2],
        };
        self.inverse.iter().flatten().all(|x| x.is_finite()).then_some(())
    }

    /// Returns V² Aᵀ q for all points.
    fn flexed(&self, q: &[f64]) -> Vec<Cone> {
        self.program.rates(q).iter().zip(&self.scalings).map(|(z, scaling)| scaling.square(z)).collect()
    }

    /// Adds λ and τ to a motion so that it satisfies both scalar equations with these right-hand sides.
    fn bordered(&self, motion: &mut [f64], right: [f64; 2]) -> [f64; 2] {
        let [a, b] = [right[0] - dot(&self.program.varying, motion), right[1] - dot(&self.program.base, motion)];
        let scalars = self.inverse.map(|row| row[0] * a + row[1] * b);
        add(motion, scalars[0], &self.responses[0]);
        add(motion, scalars[1], &self.responses[1]);
        scalars
    }

    /// Returns the direction that removes the share `eta` of the residuals and changes forces by `wanted` − V² Δz, and
    /// the product τ κ by `product`.
    fn direction(&mut self, eta: f64, wanted: &[Cone], product: f64) -> State {
        let Residuals { equilibrium, rates, scalars } = &self.residuals;
        let fixed: Vec<Cone> = wanted
            .iter()
            .zip(rates)
            .zip(&self.scalings)
            .map(|((wanted, rate), scaling)| plus(wanted, -eta, &scaling.square(rate)))
            .collect();
        let mut motion: Bodies = equilibrium.iter().map(|r| eta * r).collect();
        self.program.press(&fixed, &mut motion);
        self.stiffness.solve(&mut motion);
        let State { tau, kappa, .. } = self.state;
        let right = [-eta * scalars[0], -eta * scalars[1] + product / tau];
        let [lambda, change] = self.bordered(&mut motion, right);
        let y = fixed.iter().zip(self.flexed(&motion)).map(|(y, d)| plus(y, -1.0, &d)).collect();
        let mut step = State { y, z: Vec::new(), q: motion, lambda, tau: change, kappa: 0.0 };
        self.refine(eta, &mut step);
        step.kappa = if self.settled { 0.0 } else { (product - kappa * step.tau) / tau };
        let rates = self.program.rates(&step.q);
        step.z = rates.iter().zip(&self.residuals.rates).map(|(z, r)| plus(z, eta, r)).collect();
        step
    }

    /// Corrects the forces of a direction until they remove the share `eta` of the error of equilibrium. Corrections are
    /// added to the forces, so that only the rounding of the last one is magnified by the flexibilities.
    fn refine(&mut self, eta: f64, step: &mut State) {
        let goal = SETTINGS.refined * greatest(&self.residuals.equilibrium);
        let mut least = f64::INFINITY;
        for _ in 0..SETTINGS.corrections {
            let mut left = self.program.imbalance(&step.y, step.lambda, step.tau);
            add(&mut left, eta, &self.residuals.equilibrium);
            let error = greatest(&left);
            if error <= goal || error > 0.5 * least || error.is_nan() {
                break;
            }
            least = error;
            self.stiffness.solve(&mut left);
            let [lambda, tau] = self.bordered(&mut left, [0.0; 2]);
            step.lambda += lambda;
            step.tau += tau;
            let change = self.flexed(&left);
            step.y.iter_mut().zip(&change).for_each(|(y, d)| *y = plus(y, -1.0, d));
            add(&mut step.q, 1.0, &left);
        }
    }

    /// Returns true if the residuals are so small that the optimum is near.
    pub fn is_solvable(&self) -> bool {
        let State { tau, kappa, .. } = self.state;
        let left = greatest(&self.residuals.equilibrium);
        let rates = self.residuals.rates.iter().map(|r| greatest(r)).fold(left, f64::max);
        !self.held && kappa < SETTINGS.solvable * tau && rates < SETTINGS.solvable * tau
    }

    /// Fixes τ at one.
    pub fn settle(&mut self) {
        let State { y, z, q, lambda, tau, kappa } = &mut self.state;
        let by = tau.recip();
        y.iter_mut().chain(z.iter_mut()).flatten().chain(q.iter_mut()).for_each(|x| *x *= by);
        *lambda *= by;
        (*tau, *kappa, self.settled) = (1.0, 0.0, true);
        self.residuals = self.present_residuals();
    }

    /// Moves the factorised state by one step and returns its length.
    pub fn step(&mut self) -> f64 {
        let before = self.state.y.iter().map(|y| y.map(|x| -x)).collect::<Vec<_>>();
        let product = -self.state.tau * self.state.kappa;
        let predictor = self.direction(1.0, &before, product);
        let affine = self.state.longest(&predictor).map(|length| length.min(1.0));
        let mean = self.state.mean();
        let sigma = if self.settled {
            let least = if self.compatible { 0.0 } else { SETTINGS.centring };
            (self.state.mean_after(affine, &predictor) / mean).clamp(0.0, 1.0).powi(3).max(least)
        } else {
            (1.0 - affine[0]).powi(3)
        };
        let wanted = self.corrected(&predictor, sigma);
        let product = sigma * mean + product - predictor.tau * predictor.kappa;
        let eta = if self.settled { 1.0 } else { 1.0 - sigma };
        let step = self.direction(eta, &wanted, product);
        let lengths = self.state.longest(&step).map(|length| (SETTINGS.boundary * length).min(1.0));
        self.state.advance(lengths, &step);
        self.compatible |= self.settled && lengths[1] == 1.0;
        self.residuals = self.present_residuals();
        lengths[0].max(lengths[1])
    }

    /// Returns V of the wanted change of the scaled products, with the centring share σ and the second order of the
    /// predictor.
    fn corrected(&self, predictor: &State, sigma: f64) -> Vec<Cone> {
        let centre = sigma * self.state.mean();
        let points = self.state.z.iter().zip(&self.scalings).zip(predictor.y.iter().zip(&predictor.z));
        let wanted = |((z, scaling), (dy, dz)): ((&Cone, &Scaling), (&Cone, &Cone))| {
            let v = scaling.times(z);
            let second = product(&scaling.divide(dy), &scaling.times(dz));
            let right = plus(&plus(&[centre, 0.0, 0.0], -1.0, &product(&v, &v)), -1.0, &second);
            scaling.times(&quotient(&v, &right))
        };
        points.map(wanted).collect()
    }
}
