//! Flexibilities that are computed once for a problem and its certificate.

use super::shape::Form;
use crate::model::geometry::Vec2;
use nalgebra::{DMatrix, Matrix2};
use std::cell::RefCell;
use std::marker::PhantomData;
use std::sync::Arc;

/// C̃ of a shape at points in its frame.
struct Local {
    form: Form,
    points: Vec<Vec2>,
    flexibility: Arc<DMatrix<f64>>,
}

/// Q C̃ Qᵀ / (E width).
struct Placed {
    /// C̃.
    local: Arc<DMatrix<f64>>,
    /// Q, and 1 / (E width).
    placement: (Matrix2<f64>, f64),
    flexibility: Arc<DMatrix<f64>>,
}

/// Stored flexibilities.
#[derive(Default)]
struct Stored {
    local: Vec<Local>,
    placed: Vec<Placed>,
}

thread_local! {
    static STORED: RefCell<Option<Stored>> = const { RefCell::new(None) };
}

/// While it lives, flexibilities that its thread computes are stored. If the same shape and the same points are given
/// again, to the last bit, the stored matrix is used: a problem and its certificate condense the same bodies.
pub struct SharedFlexibilities {
    /// True if another one already stored them.
    is_inner: bool,
    of_thread: PhantomData<*const ()>,
}

impl SharedFlexibilities {
    /// Begins to store flexibilities.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        let before = STORED.take();
        let is_inner = before.is_some();
        STORED.set(Some(before.unwrap_or_default()));
        SharedFlexibilities { is_inner, of_thread: PhantomData }
    }
}

impl Drop for SharedFlexibilities {
    fn drop(&mut self) {
        if !self.is_inner {
            STORED.set(None);
        }
    }
}

/// Returns C̃ of a shape at points in its frame, stored or computed.
pub(super) fn local(
    form: &Form,
    points: &[Vec2],
    compute: impl FnOnce() -> Result<DMatrix<f64>, String>,
) -> Result<Arc<DMatrix<f64>>, String> {
    let known = STORED.with_borrow(|stored| {
        let all = &stored.as_ref()?.local;
        all.iter().find(|own| own.form == *form && own.points == points).map(|own| own.flexibility.clone())
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let found = Arc::new(compute()?);
    STORED.with_borrow_mut(|stored| {
        let entry = || Local { form: form.clone(), points: points.to_vec(), flexibility: found.clone() };
        stored.iter_mut().for_each(|stored| stored.local.push(entry()));
    });
    Ok(found)
}

/// Returns C̃ in the axes of a body, stored or computed.
pub(super) fn placed(
    local: &Arc<DMatrix<f64>>,
    placement: (Matrix2<f64>, f64),
    compute: impl FnOnce() -> DMatrix<f64>,
) -> Arc<DMatrix<f64>> {
    let known = STORED.with_borrow(|stored| {
        let all = &stored.as_ref()?.placed;
        let same = |own: &&Placed| Arc::ptr_eq(&own.local, local) && own.placement == placement;
        all.iter().find(same).map(|own| own.flexibility.clone())
    });
    known.unwrap_or_else(|| {
        let found = Arc::new(compute());
        STORED.with_borrow_mut(|stored| {
            let entry = || Placed { local: local.clone(), placement, flexibility: found.clone() };
            stored.iter_mut().for_each(|stored| stored.placed.push(entry()));
        });
        found
    })
}
