//! `isolate = true`: the behaviour runs in a separate process, so that its crash ends one case and not the program.
//!
//! The other process is a program that calls [`serve`], as the command line does; [`isolate_with`] sets it. The two
//! processes communicate through a socket that is the standard input of the other process, or through a port of this
//! machine on systems without such sockets. The output of a library is discarded. First one line of JSON in each direction
//! describes the behaviour and its state. Then each step is a row of numbers in each direction.

use crate::behaviour::{Behaviour, Family, INELASTIC, Request, Step, Wrong, check_step, message, names, wrong};
use crate::library::{allow, allowed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Duration;
use voussoir_core::law::{UpdateBranch, UpdateFailure};

/// The program that runs behaviours, and its arguments.
static WORKER: OnceLock<(PathBuf, Vec<OsString>)> = OnceLock::new();

/// Sets the program, with its arguments, that calls [`serve`]. Only the first call has an effect.
pub fn isolate_with(program: PathBuf, arguments: Vec<OsString>) {
    let _ = WORKER.set((program, arguments));
}

/// The first request to the other process.
#[derive(Serialize, Deserialize)]
struct Asked {
    /// Numbers of a gradient: 2 for joints, 6 for materials.
    size: usize,
    library: String,
    behaviour: String,
    properties: BTreeMap<String, f64>,
    variables: BTreeMap<String, f64>,
    temperature: f64,
    density: f64,
}

/// Its reply to this request.
#[derive(Serialize, Deserialize)]
enum Answered {
    /// Names of the state.
    Names(Vec<String>),
    /// Keys and faults.
    Wrong(Wrong),
}

/// A running process with both directions of its socket.
#[derive(Debug)]
struct Process {
    child: Child,
    to: Box<dyn Channel>,
    from: BufReader<Box<dyn Channel>>,
}

trait Channel: Read + Write + Send + std::fmt::Debug {}
impl<T: Read + Write + Send + std::fmt::Debug> Channel for T {}

impl Drop for Process {
    fn drop(&mut self) {
        // A process that waits for a step has no data to lose.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// A behaviour in another process.
#[derive(Debug)]
pub(crate) struct Isolated {
    /// `None` after it has ended.
    process: Mutex<Option<Process>>,
    /// Names of the whole state.
    pub names: &'static [&'static str],
}

/// Time after which a process without an answer is ended.
const LONGEST_STEP: Duration = Duration::from_secs(10);
/// Longest line and longest message of a process \[bytes\].
const MAX_LINE: u64 = 1 << 20;

const NO_WORKER: &str = "isolate = true needs the command line, or a program that has called isolate_with";

#[cfg(unix)]
fn started() -> io::Result<Process> {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;
    use std::process::{Command, Stdio};
    let (program, arguments) = WORKER.get().ok_or_else(|| io::Error::other(NO_WORKER))?;
    let (own, other) = UnixStream::pair()?;
    let child = Command::new(program).args(arguments).stdin(OwnedFd::from(other)).stdout(Stdio::null()).spawn()?;
    own.set_read_timeout(Some(LONGEST_STEP))?;
    own.set_write_timeout(Some(LONGEST_STEP))?;
    let from = BufReader::new(Box::new(own.try_clone()?) as Box<dyn Channel>);
    Ok(Process { child, to: Box::new(own), from })
}

#[cfg(not(unix))]
fn started() -> io::Result<Process> {
    use std::process::{Command, Stdio};
    let (program, arguments) = WORKER.get().ok_or_else(|| io::Error::other(NO_WORKER))?;
    let door = crate::loopback::Door::open()?;
    let mut child = Command::new(program).args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).spawn()?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(door.invitation()?.as_bytes())?;
    }
    let own = door.accept(LONGEST_STEP)?;
    own.set_read_timeout(Some(LONGEST_STEP))?;
    own.set_write_timeout(Some(LONGEST_STEP))?;
    let from = BufReader::new(Box::new(own.try_clone()?) as Box<dyn Channel>);
    Ok(Process { child, to: Box::new(own), from })
}

fn numbers(from: &mut impl Read, count: usize) -> io::Result<Vec<f64>> {
    let mut bytes = vec![0; 8 * count];
    from.read_exact(&mut bytes)?;
    Ok(bytes.as_chunks::<8>().0.iter().map(|eight| f64::from_le_bytes(*eight)).collect())
}

fn bytes_of<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Vec<u8> {
    numbers.into_iter().flat_map(|number| number.to_le_bytes()).collect()
}

impl Process {
    fn asks(&mut self, asked: &Asked) -> io::Result<Answered> {
        let mut line = serde_json::to_string(asked)?;
        line.push('\n');
        self.to.write_all(line.as_bytes())?;
        line.clear();
        self.from.by_ref().take(MAX_LINE).read_line(&mut line)?;
        Ok(serde_json::from_str(&line)?)
    }

    /// Integrates a step and writes the new state to `new`. The inner error is the error of the behaviour.
    fn step<const N: usize>(&mut self, row: &[u8], new: &mut [f64]) -> io::Result<Result<Step<N>, String>> {
        self.to.write_all(row)?;
        let mut first = [0];
        self.from.read_exact(&mut first)?;
        if first[0] == REFUSED {
            let mut length = [0; 4];
            self.from.read_exact(&mut length)?;
            let length = u64::from(u32::from_le_bytes(length));
            if length > MAX_LINE {
                return Err(io::Error::other("a message that is too long"));
            }
            let mut words = vec![0; length as usize];
            self.from.read_exact(&mut words)?;
            return Ok(Err(String::from_utf8_lossy(&words).into_owned()));
        }
        if first[0] > CHANGED {
            return Err(io::Error::other("an answer of no kind"));
        }
        let read = numbers(&mut self.from, N + N * N + 2 + new.len())?;
        if !read.iter().all(|number| number.is_finite()) {
            return Ok(Err("the external behaviour gives a number that is not finite".into()));
        }
        let (forces, rest) = read.split_at(N);
        let (tangent, rest) = rest.split_at(N * N);
        new.copy_from_slice(&rest[2..]);
        Ok(Ok(Step {
            forces: std::array::from_fn(|i| forces[i]),
            tangent: std::array::from_fn(|i| std::array::from_fn(|j| tangent[i * N + j])),
            branch: if first[0] == CHANGED { INELASTIC } else { UpdateBranch::ELASTIC },
            stored: rest[0],
            dissipated: rest[1],
        }))
    }
}

/// First byte of an answer to a step.
const REFUSED: u8 = 0;
const UNCHANGED: u8 = 1;
const CHANGED: u8 = 2;

impl Isolated {
    /// Starts the process, which opens and checks the behaviour. An error names the key of the study and the fault.
    pub fn load<const N: usize>(request: &Request) -> Result<Self, Wrong> {
        let library = allowed(request.library).or_else(|why| wrong("library", why))?;
        let asked = Asked {
            size: N,
            library: library.display().to_string(),
            behaviour: request.behaviour.into(),
            properties: request.properties.clone(),
            variables: request.variables.clone(),
            temperature: request.temperature,
            density: request.density,
        };
        let mut process = started().or_else(|error| wrong("isolate", error.to_string()))?;
        match process.asks(&asked) {
            Ok(Answered::Names(own)) => Ok(Isolated { process: Mutex::new(Some(process)), names: names(&own) }),
            Ok(Answered::Wrong(complaints)) => Err(complaints),
            Err(_) => wrong("library", format!("its process ended while it was opened: {}", ending(process))),
        }
    }

    /// Integrates a step, as [`Behaviour::step`]. A process that fails or is late is ended; all later steps are then errors.
    pub fn step<const N: usize>(
        &self,
        gradients: [f64; N],
        time_step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Step<N>, UpdateFailure> {
        check_step(&gradients, old, new, self.names.len())?;
        let mut process = self.process.lock().unwrap_or_else(PoisonError::into_inner);
        let running = process.as_mut().ok_or(UpdateFailure::Law("the process of the external behaviour has ended"))?;
        let row = bytes_of(gradients.iter().chain([&time_step]).chain(old));
        match running.step(&row, new) {
            Ok(step) => step.map_err(|words| UpdateFailure::Law(message(&words))),
            Err(error) => {
                let late = [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&error.kind());
                let how = process.take().map_or_else(String::new, ending);
                Err(UpdateFailure::Law(message(&match late {
                    true => format!("the external behaviour does not answer within {LONGEST_STEP:?}"),
                    false => format!("the process of the external behaviour has ended: {how}"),
                })))
            }
        }
    }
}

/// Describes the end of a process that does not answer.
fn ending(mut process: Process) -> String {
    // Do not wait for a process that has closed its side without ending.
    drop(process.child.kill());
    process.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string())
}

/// Runs a behaviour for another process until it sends no more steps. This is the whole work of a program that
/// [`isolate_with`] names.
///
/// # Errors
/// If the first line is not a request, or the connection fails.
pub fn serve() -> io::Result<()> {
    let socket = connected()?;
    let mut from = BufReader::new(socket.try_clone()?);
    let mut to = BufWriter::new(socket);
    let mut line = String::new();
    from.read_line(&mut line)?;
    let asked: Asked = serde_json::from_str(&line)?;
    match asked.size {
        2 => serve_steps::<2>(&asked, &Family::COHESIVE_ZONE, &mut from, &mut to),
        6 => serve_steps::<6>(&asked, &Family::SMALL_STRAIN, &mut from, &mut to),
        other => Err(io::Error::other(format!("no behaviour has gradients of {other} numbers"))),
    }
}

/// Returns the connection to the process that started this one: its standard input is a socket.
#[cfg(unix)]
fn connected() -> io::Result<std::os::unix::net::UnixStream> {
    use std::os::fd::AsFd;
    Ok(io::stdin().as_fd().try_clone_to_owned()?.into())
}

/// Returns the connection to the process that started this one: its standard input gives the address.
#[cfg(not(unix))]
fn connected() -> io::Result<std::net::TcpStream> {
    let mut invitation = String::new();
    io::stdin().read_line(&mut invitation)?;
    crate::loopback::enter(&invitation)
}

fn serve_steps<const N: usize>(
    asked: &Asked,
    family: &Family,
    from: &mut impl Read,
    to: &mut impl Write,
) -> io::Result<()> {
    // The process that started this one has allowed the library.
    allow(Path::new(&asked.library))?;
    let Asked { library, behaviour, properties, variables, temperature, density, .. } = asked;
    let (temperature, density) = (*temperature, *density);
    let request = Request { library, behaviour, properties, variables, temperature, density };
    let behaviour = match Behaviour::load::<N>(&request, family) {
        Ok(behaviour) => behaviour,
        Err(complaints) => {
            writeln!(to, "{}", serde_json::to_string(&Answered::Wrong(complaints))?)?;
            return to.flush();
        }
    };
    let names = behaviour.names.iter().map(ToString::to_string).collect();
    writeln!(to, "{}", serde_json::to_string(&Answered::Names(names))?)?;
    to.flush()?;
    let size = behaviour.names.len();
    let mut new = vec![0.0; size];
    loop {
        let row = match numbers(from, N + 1 + size) {
            Ok(row) => row,
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error),
        };
        let gradients: [f64; N] = std::array::from_fn(|i| row[i]);
        match behaviour.step(gradients, row[N], &row[N + 1..], &mut new) {
            Ok(step) => {
                to.write_all(&[if step.branch == INELASTIC { CHANGED } else { UNCHANGED }])?;
                let energies = [step.stored, step.dissipated];
                let all = step.forces.iter().chain(step.tangent.as_flattened()).chain(&energies).chain(&new);
                to.write_all(&bytes_of(all))?;
            }
            Err(why) => {
                let words = why.to_string();
                to.write_all(&[REFUSED])?;
                to.write_all(&(words.len() as u32).to_le_bytes())?;
                to.write_all(words.as_bytes())?;
            }
        }
        to.flush()?;
    }
}
