//! The command line: its commands, their options, and the function that runs each.

use crate::commands;
pub use crate::commands::clock::processor_time;
use crate::commands::new::Template;
use crate::commands::options::{Options, Shard, at_least_one, case_id};
pub use crate::commands::{CliError, ErrorKind, Outcome, Verdict};
use clap::{Args, CommandFactory, Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Version and commit of the program.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("VOUSSOIR_COMMIT"), ")");

/// Stability and collapse of masonry made of blocks.
#[derive(Parser)]
#[command(name = "voussoir", version = VERSION)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Let studies run this shared library (law = "external"); may be given several times
    #[cfg(feature = "external")]
    #[arg(long, global = true, value_name = "PATH")]
    allow_library: Vec<PathBuf>,
}

#[derive(Subcommand)]
enum Command {
    /// Solve studies of any kind and write results, figures and a report
    Run {
        /// Study files (TOML)
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Folder for results; several studies get one folder each inside it (default: results/NAME)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set joints.dry.friction=0.5
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Number of cases in parallel
        #[arg(long, default_value_t = 1, value_parser = at_least_one)]
        jobs: usize,
        /// Solve only the case with this id
        #[arg(long, allow_negative_numbers = true, value_parser = case_id)]
        case: Option<usize>,
        /// Continue from the finished cases of an interrupted run
        #[arg(long)]
        resume: bool,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
        /// Solve one part of the study, for example 2/8 on the second of eight machines (see `merge`)
        #[arg(long, value_name = "M/N", conflicts_with_all = ["case", "open"])]
        shard: Option<Shard>,
        /// Print each answered case as a line of JSON, and nothing else on standard output
        #[arg(long)]
        json: bool,
        /// Print id, hash and parameters of each case as a line of JSON, and solve nothing
        #[arg(long)]
        list: bool,
        /// Open the report in a browser when it is written
        #[arg(long)]
        open: bool,
    },
    /// Merge the parts of a study that were solved with `run --shard`
    Merge {
        /// Folders with parts, or parts
        #[arg(required = true, value_name = "DIR")]
        dirs: Vec<PathBuf>,
        /// Folder for the results (default: the given folder, if there is only one)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Number of cases checked in parallel
        #[arg(long, default_value_t = 1, value_parser = at_least_one)]
        jobs: usize,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Compare a study's variants, or all compatible solvers: processor time and error
    Bench {
        /// Study files (TOML), measured together
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Folder for bench.csv and figures (default: results/NAME/bench)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Runs of each contestant; the fastest counts
        #[arg(long, default_value_t = 3, value_parser = at_least_one)]
        runs: usize,
        /// Reference of the errors: a variant, a contestant, or a known load factor
        #[arg(long, value_name = "NAME|NUMBER")]
        reference: Option<String>,
        /// CSV file with measurements of other programs, shown in the same charts
        #[arg(long, value_name = "FILE")]
        others: Option<PathBuf>,
        /// Greatest relative error of a solved problem in the performance profile
        #[arg(long, default_value_t = 1e-3)]
        within: f64,
        /// Measure each case with five values of each setting: tolerance, first_step, mesh
        #[arg(long, value_name = "NAME,…", value_delimiter = ',', conflicts_with_all = ["reference", "others", "out"])]
        sweep: Vec<String>,
        /// CSV file for the ladders of --sweep
        #[arg(long, value_name = "FILE", requires = "sweep")]
        output: Option<PathBuf>,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Open a study in a browser on this machine, with sliders for its numbers
    Serve {
        /// Study file (TOML)
        study: PathBuf,
        /// Override a key of the study
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Open the page in a browser
        #[arg(long)]
        open: bool,
        /// Port of the page; 0 chooses a free port
        #[arg(long, value_name = "PORT", default_value_t = 0)]
        port: u16,
    },
    /// Write a commented study that runs without changes, a law, or a crate with a law
    New {
        /// Kind of the new study, or a law or crate
        #[command(subcommand)]
        what: New,
    },
    /// Check a study file without computing anything
    Check {
        /// Study files (TOML)
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Override a key of the study
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
    },
    /// Same as `run`, which accepts studies of every kind
    #[command(hide = true)]
    Point {
        /// Study files (TOML) with kind = "point"
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Folder for results; several studies get one folder each inside it (default: results/NAME)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set point.length=0.1
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Explain a plug-in, a key, a word, or how a study will be solved
    Explain {
        /// Tag of a plug-in, key of a study file, a word such as `units`, or a study file
        what: String,
        /// Print the first case as a study with every block by its vertices
        #[arg(long, value_name = "FORM", value_parser = commands::explain::EXPORTS)]
        export: Option<String>,
    },
    /// Check that a plug-in keeps the promises of its card and its trait
    Conform {
        /// Tags of plug-ins; without tags all but solvers and strategies
        tags: Vec<String>,
        /// Folder for studies that reproduce the findings
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// List plug-ins
    List {
        /// laws, materials, scenes, solvers, kinds, writers …; all if it is omitted
        kind: Option<String>,
    },
    /// Print the JSON Schema of study files, or of results.json
    Schema {
        /// Files that the schema describes
        #[arg(default_value = commands::explain::SCHEMAS[0], value_parser = commands::explain::SCHEMAS)]
        files: String,
    },
    /// Check results against their study
    Verify {
        /// Folder written by `run`
        dir: PathBuf,
        /// Study file to which the folder must belong
        study: Option<PathBuf>,
        /// Change one value of the study file, as in `run`; may be given several times
        #[arg(long, value_name = "KEY=VALUE", requires = "study")]
        set: Vec<String>,
        /// Accept a folder that holds only some cases of its study
        #[arg(long)]
        partial: bool,
        /// Number of cases in parallel
        #[arg(long, default_value_t = 1, value_parser = at_least_one)]
        jobs: usize,
    },
    /// Compare the results of two runs: cases, statuses, loads, mechanisms, and keys of the studies
    Diff {
        /// Results folder or results.json of the first run
        a: PathBuf,
        /// Results folder or results.json of the second run
        b: PathBuf,
        /// Greatest relative difference of numbers that count as equal
        #[arg(long, default_value_t = 1e-6, value_parser = commands::diff::tolerance)]
        tolerance: f64,
        /// Print all differences as one line of JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the completions of a shell
    Completions {
        /// Name of the shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page (`voussoir man | man -l -`)
    Man,
}

impl Command {
    /// Runs the command; `arguments` are the arguments after the program's name.
    fn answer(self, arguments: &[String]) -> Outcome {
        match self {
            Command::Run { studies, out, set, jobs, case, resume, quiet, shard, json, list, open } => {
                let again = commands::run::going_on(arguments);
                let options = Options { out, set, jobs, case, resume, quiet, shard, json, list, open, again };
                commands::run::run(&studies, &options)
            }
            Command::Point { studies, out, set, quiet } => {
                let options = Options { out, set, jobs: 1, quiet, ..Default::default() };
                commands::run::run(&studies, &options)
            }
            Command::Merge { dirs, out, jobs, quiet } => {
                commands::merge::merge(&dirs, &commands::merge::MergeOptions { out, jobs, quiet })
            }
            Command::Bench { studies, out, set, runs, reference, others, within, sweep, output, quiet } => {
                let arguments =
                    commands::bench::BenchArguments { out, set, runs, reference, others, within, sweep, output, quiet };
                commands::bench::measure(&studies, &arguments)
            }
            Command::Serve { study, set, open, port } => commands::serve::serve(&study, &set, open, port),
            Command::New { what } => what.answer(),
            Command::Check { studies, set } => commands::check::check(&studies, &set),
            Command::Explain { what, export: Some(_) } => commands::explain::export(std::path::Path::new(&what)),
            Command::Explain { what, export: None } => commands::explain::explain(&what),
            Command::Conform { tags, out } => commands::conform::conform_tags(&tags, out.as_deref()),
            Command::List { kind } => commands::explain::list(kind.as_deref()),
            Command::Schema { files } => commands::explain::schema(&files),
            Command::Verify { dir, study, set, partial, jobs } => {
                commands::verify::verify(&dir, &commands::verify::VerifyOptions { study, set, partial, jobs })
            }
            Command::Diff { a, b, tolerance, json } => {
                commands::diff::diff(&a, &b, &commands::diff::DiffOptions { tolerance, json })
            }
            Command::Completions { shell } => commands::pages::completions(shell, &mut Cli::command()),
            Command::Man => commands::pages::man(Cli::command()),
        }
    }
}

#[derive(Subcommand)]
enum New {
    /// An arch under a load above quarter span
    Arch(NewStudy),
    /// A wall that is pushed or shaken
    Wall(NewStudy),
    /// Blocks by their vertices
    Blocks(NewStudy),
    /// An arch bridge with fill under a moving axle
    Bridge(NewStudy),
    /// One law at one point
    Point(NewStudy),
    /// Several laws beside each other
    Compare(NewStudy),
    /// Load factors over the rise of an arch, as in a paper
    Paper(NewStudy),
    /// A law of joints: its file, its page and its test
    Law {
        /// Tag of the law, which is also the name of its file
        tag: String,
        /// Folder of its crate
        #[arg(long, default_value = ".")]
        out: PathBuf,
    },
    /// A crate with one law, its study and tests, and a program with the whole command line
    Crate {
        /// Name of the crate and of its folder
        name: String,
        /// Tag of its law (default: the name of the crate)
        #[arg(long, value_name = "TAG")]
        law: Option<String>,
        /// Folder in which the folder of the crate is written
        #[arg(long, default_value = ".")]
        out: PathBuf,
        /// Copy of the repository, on which the crate then depends by path (default: published versions)
        #[arg(long, value_name = "DIR")]
        repository: Option<PathBuf>,
    },
}

#[derive(Args)]
struct NewStudy {
    /// Name of the study; the file is NAME.toml (default: the word itself)
    name: Option<String>,
}

impl New {
    fn answer(self) -> Outcome {
        let (template, study) = match self {
            New::Arch(study) => (Template::Arch, study),
            New::Wall(study) => (Template::Wall, study),
            New::Blocks(study) => (Template::Blocks, study),
            New::Bridge(study) => (Template::Bridge, study),
            New::Point(study) => (Template::Point, study),
            New::Compare(study) => (Template::Compare, study),
            New::Paper(study) => (Template::Paper, study),
            New::Law { tag, out } => return commands::new_law::law(&tag, &out),
            New::Crate { name, law, out, repository } => {
                return commands::new_law::new_crate(&commands::new_law::NewCrate { name, law, out, repository });
            }
        };
        commands::new::new(template, study.name.as_deref())
    }
}

/// Runs the program with the arguments of the process. Exit code 0: all cases are answered and certified; 1: some case is
/// not; 2: wrong input; 3: a file cannot be read or written, or the program itself has an error.
pub fn main() -> ExitCode {
    #[cfg(feature = "external")]
    if let Some(code) = behaviour_for_another() {
        return code;
    }
    match std::panic::catch_unwind(|| main_from(std::env::args_os().skip(1))) {
        Err(_) => {
            let why = "voussoir: this is an error of the program, not of its input; please report it";
            ExitCode::from(commands::ended(Err(CliError::no_access(why))))
        }
        Ok(Ok(code)) => ExitCode::from(code),
        // Help, version or a usage error: `clap` has printed it and has set the exit code.
        Ok(Err(said)) => {
            commands::keep(said.print());
            let printed = commands::ended(Ok(Verdict::Proved));
            ExitCode::from(printed.max(u8::try_from(said.exit_code()).unwrap_or(2)))
        }
    }
}

/// First argument of a process that runs the behaviour of an external library for another process. It is not a command
/// for users.
#[cfg(feature = "external")]
const WORKER: &str = "run-behaviour";

/// Runs an external behaviour and returns its exit code if this process was started for that. Otherwise it registers the
/// separate process in which this program runs external behaviours.
#[cfg(feature = "external")]
fn behaviour_for_another() -> Option<ExitCode> {
    if std::env::args_os().nth(1).is_some_and(|word| word == WORKER) {
        let ended = crate::external::serve();
        return Some(if ended.is_ok() { ExitCode::SUCCESS } else { ExitCode::from(3) });
    }
    if let Ok(program) = std::env::current_exe() {
        crate::external::isolate_with(program, vec![WORKER.into()]);
    }
    None
}

/// Runs the program with given arguments, without the program's name. The error is the message of `clap`.
pub fn main_from(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> Result<u8, clap::Error> {
    outcome_of(arguments).map(commands::ended)
}

/// Returns the outcome for given arguments, without the program's name. Errors are not printed.
///
/// # Errors
/// The message of clap, if the arguments are not understood or ask for help or the version.
pub fn outcome_of(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> Result<Outcome, clap::Error> {
    let arguments: Vec<std::ffi::OsString> = arguments.into_iter().collect();
    let wrong = voussoir_core::plugin::audit();
    if !wrong.is_empty() {
        let lines = wrong.iter().map(|why| format!("voussoir: registry: {why}"));
        return Ok(Err(CliError::of_lines(ErrorKind::NoAccess, lines)));
    }
    let words: Vec<String> = arguments.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let cli = match Cli::try_parse_from(std::iter::once("voussoir".into()).chain(arguments)) {
        Err(wrong) if wrong.kind() == clap::error::ErrorKind::InvalidSubcommand => match words.first() {
            Some(file) if file.ends_with(".toml") => {
                let why =
                    format_args!("voussoir: {file} is no command; to solve this study, write `voussoir run {file}`");
                return Ok(Err(CliError::wrong_input(why)));
            }
            _ => return Err(wrong),
        },
        parsed => parsed?,
    };
    #[cfg(feature = "external")]
    for path in &cli.allow_library {
        if let Err(error) = crate::external::allow(path) {
            let why = format_args!("voussoir: --allow-library {}: {error}", path.display());
            return Ok(Err(CliError::no_access(why)));
        }
    }
    Ok(cli.command.answer(&words))
}
