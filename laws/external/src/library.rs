//! Shared libraries: the libraries that may be opened, and the values of their symbols.

use crate::data::Integrate;
use libloading::Library;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_char};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// Libraries that studies of this process may name, by their canonical paths.
static ALLOWED: LazyLock<Mutex<Vec<PathBuf>>> = LazyLock::new(Mutex::default);
/// Open libraries. They are never closed, since laws hold their functions.
static OPEN: LazyLock<Mutex<BTreeMap<PathBuf, &'static Library>>> = LazyLock::new(Mutex::default);

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Allows studies of this process to name a library. This does not run any of its code.
///
/// # Errors
/// If the path does not exist or cannot be read.
pub fn allow(path: &Path) -> io::Result<()> {
    let path = path.canonicalize()?;
    let mut allowed = locked(&ALLOWED);
    if !allowed.contains(&path) {
        allowed.push(path);
    }
    Ok(())
}

/// Returns the path of a library that is allowed.
pub(crate) fn allowed(name: &str) -> Result<PathBuf, String> {
    let path = Path::new(name).canonicalize().map_err(|error| format!("cannot read {name}: {error}"))?;
    if !locked(&ALLOWED).contains(&path) {
        return Err(format!("{name} is not allowed: a library is a program; run with --allow-library {name}"));
    }
    Ok(path)
}

/// Opens a library that is allowed.
pub(crate) fn open(name: &str) -> Result<&'static Library, String> {
    let path = allowed(name)?;
    let mut open = locked(&OPEN);
    if let Some(library) = open.get(&path) {
        return Ok(library);
    }
    // SAFETY: opening runs the initialisers of the library; the caller of `allow` has agreed to this.
    let library = unsafe { Library::new(&path) }.map_err(|error| format!("cannot open {name}: {error}"))?;
    let library: &'static Library = Box::leak(Box::new(library));
    open.insert(path, library);
    Ok(library)
}

/// The symbols of one behaviour of a library.
pub(crate) struct Symbols<'a> {
    pub library: &'static Library,
    pub behaviour: &'a str,
    /// Modelling hypothesis.
    pub hypothesis: &'a str,
}

impl Symbols<'_> {
    /// Returns the address of `BEHAVIOUR_HYPOTHESIS_name`, or of `BEHAVIOUR_name`.
    fn address<T>(&self, name: &str) -> Option<*const T> {
        let own = format!("{}_{}_{name}\0", self.behaviour, self.hypothesis);
        let general = format!("{}_{name}\0", self.behaviour);
        [own, general].iter().find_map(|symbol| {
            // SAFETY: the address of the symbol is used as a pointer; nothing is read here.
            let found = unsafe { self.library.get::<*const T>(symbol.as_bytes()) }.ok()?;
            (!found.is_null()).then_some(*found)
        })
    }

    /// Returns the integration function.
    pub fn function(&self) -> Option<Integrate> {
        let symbol = format!("{}_{}\0", self.behaviour, self.hypothesis);
        // SAFETY: the generic interface gives this symbol this type; `_mfront_interface` and `_api_version` confirm it.
        unsafe { self.library.get::<Integrate>(symbol.as_bytes()) }.ok().map(|found| *found)
    }

    /// Returns a small number.
    pub fn number(&self, name: &str) -> Option<u16> {
        // SAFETY: the interface declares these symbols as unsigned short.
        self.address::<u16>(name).map(|at| unsafe { at.read_unaligned() })
    }

    /// Returns a text.
    pub fn text(&self, name: &str) -> Option<String> {
        // SAFETY: the interface declares these symbols as const char*.
        self.address::<*const c_char>(name).and_then(|at| text(unsafe { at.read_unaligned() }))
    }

    /// Returns the list of texts called `name`, with the length in `nNAME`. `None` if either symbol is missing.
    pub fn names(&self, name: &str) -> Option<Vec<String>> {
        let count = usize::from(self.number(&format!("n{name}"))?);
        if count == 0 {
            return Some(Vec::new());
        }
        let at = self.address::<*const c_char>(name)?;
        // SAFETY: the interface declares these symbols as arrays of const char* of that length.
        (0..count).map(|i| text(unsafe { at.add(i).read_unaligned() })).collect()
    }

    /// Returns the list of types of the variables `names`.
    pub fn types(&self, name: &str, count: usize) -> Option<Vec<i32>> {
        if count == 0 {
            return Some(Vec::new());
        }
        let at = self.address::<i32>(&format!("{name}Types"))?;
        // SAFETY: the interface declares these symbols as arrays of int, one for each name.
        Some((0..count).map(|i| unsafe { at.add(i).read_unaligned() }).collect())
    }
}

fn text(at: *const c_char) -> Option<String> {
    // SAFETY: texts of the interface end with zero and live as long as the library.
    (!at.is_null()).then(|| unsafe { CStr::from_ptr(at) }.to_string_lossy().into_owned())
}
