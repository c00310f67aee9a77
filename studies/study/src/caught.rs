//! Catches panics that stored data may cause, and returns them as messages.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};

thread_local! {
    /// True while [`caught`] runs work on this thread.
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Returns the result of the work, or the message of the panic that ended it.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    let before = CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    CAUGHT.set(before);
    result.map_err(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        format!("a panic ended the check: {}", said.unwrap_or("no message"))
    })
}

/// Prints nothing for panics that [`caught`] reports. All other panics print as before.
pub fn silence_caught_panics() {
    let print = take_hook();
    set_hook(Box::new(move |panic| {
        if !CAUGHT.get() {
            print(panic);
        }
    }));
}

#[cfg(test)]
mod tests {
    use super::caught;

    #[test]
    fn a_panic_becomes_words() {
        assert_eq!(caught(|| 1), Ok(1));
        assert_eq!(caught(|| panic!("no {}", 2)), Err::<(), _>("a panic ended the check: no 2".into()));
    }
}
