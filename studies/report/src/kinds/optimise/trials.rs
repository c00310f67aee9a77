//! The values that a search tries one after another, as numbered cases.

use voussoir_study::results::CaseResult;

/// The merit of a point (greater is better, `None` if there is no finite result) and its result; `None` if the point gives no valid
/// scene.
pub(super) type Answer = Option<(Option<f64>, CaseResult)>;

/// The trials of a search.
pub(super) struct Trials<'a> {
    solve: &'a (dyn Fn(usize, &[f64]) -> Answer + Sync),
    /// The results in order of id.
    pub results: Vec<CaseResult>,
    next: usize,
    most: usize,
}

impl<'a> Trials<'a> {
    /// Creates a search of at most `most` trials.
    pub fn new(solve: &'a (dyn Fn(usize, &[f64]) -> Answer + Sync), most: usize) -> Self {
        Trials { solve, results: Vec::new(), next: 0, most }
    }

    /// Adds the answer of the next trial, which was solved elsewhere. Returns its merit; `None` if it gives no valid scene.
    pub fn add(&mut self, answer: Answer) -> Option<Option<f64>> {
        self.next += 1;
        let (merit, result) = answer?;
        self.results.push(result);
        Some(merit)
    }

    /// Returns true if no trial is left.
    pub fn spent(&self) -> bool {
        self.next >= self.most
    }

    /// Solves the next trial. Returns its merit; `None` if it gives no valid scene, or no trial is left.
    pub fn at(&mut self, point: &[f64]) -> Option<Option<f64>> {
        if self.spent() {
            return None;
        }
        let answer = (self.solve)(self.next, point);
        self.add(answer)
    }
}
