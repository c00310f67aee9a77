//! The command line: what can be asked for, and which command answers.

use crate::commands;
use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// How masonry made of blocks stands and collapses.
#[derive(Parser)]
#[command(name = "voussoir", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Solve studies of any kind and write results, figures and a report
    Run {
        /// Study files (TOML)
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Where results go; with several studies, a folder each inside \[default: results/NAME\]
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set joints.dry.friction=0.5
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Cases worked on side by side
        #[arg(long, default_value_t = 1)]
        jobs: usize,
        /// Solve only the case with this id
        #[arg(long)]
        case: Option<usize>,
        /// Go on from the finished cases of an interrupted run
        #[arg(long)]
        resume: bool,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
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
    /// The same as `run`, which takes studies of every kind
    #[command(hide = true)]
    Point {
        /// Study files (TOML) with kind = "point"
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Where results go; with several studies, a folder each inside \[default: results/NAME\]
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set point.length=0.1
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Explain a plug-in, or how a study will be solved
    Explain {
        /// Tag of a plug-in, or a study file
        what: String,
        /// Print the study's first case in another form instead: every block by its vertices
        #[arg(long, value_name = "FORM", value_parser = commands::explain::EXPORTS)]
        export: Option<String>,
    },
    /// Check whether a law keeps what its card and its trait promise
    Conform {
        /// Tags of laws of joints or materials; all where they are left out
        tags: Vec<String>,
        /// Folder for studies that show what was found
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// Write the files of something new
    New {
        #[command(subcommand)]
        what: New,
    },
    /// List plug-ins
    List {
        /// laws, materials, scenes, solvers, kinds, writers …; all where it is left out
        kind: Option<String>,
    },
    /// Print the JSON Schema of study files
    Schema,
    /// Check results against the study they answer
    Verify {
        /// Folder written by `run`
        dir: PathBuf,
        /// Cases worked on side by side
        #[arg(long, default_value_t = 1)]
        jobs: usize,
    },
}

#[derive(Subcommand)]
enum New {
    /// A law of joints: its file, its page and its test
    Law {
        /// Its tag, which is the name of its file
        tag: String,
        /// Folder of the crate that it goes into
        #[arg(long, default_value = ".")]
        out: PathBuf,
    },
}

/// Does what the arguments of the process ask for; 0 all cases answered and certified, 1 some case not,
/// 2 wrong input, 3 cannot read or write.
pub fn main() -> ExitCode {
    let wrong = voussoir_core::plugin::audit();
    if !wrong.is_empty() {
        wrong.iter().for_each(|why| eprintln!("voussoir: registry: {why}"));
        return ExitCode::from(commands::NO_ACCESS);
    }
    let code = match Cli::parse().command {
        Command::Run { studies, out, set, jobs, case, resume, quiet } => {
            let options = commands::run::Options { out, set, jobs, case, resume, quiet };
            commands::run::run(&studies, &options)
        }
        Command::Check { studies, set } => commands::check::check(&studies, &set),
        Command::Point { studies, out, set, quiet } => {
            let options = commands::run::Options { out, set, jobs: 1, case: None, resume: false, quiet };
            commands::run::run(&studies, &options)
        }
        Command::Explain { what, export: Some(_) } => commands::explain::export(std::path::Path::new(&what)),
        Command::Explain { what, export: None } => commands::explain::explain(&what),
        Command::Conform { tags, out } => commands::conform::conform_tags(&tags, out.as_deref()),
        Command::New { what: New::Law { tag, out } } => commands::new::law(&tag, &out),
        Command::List { kind } => commands::explain::list(kind.as_deref()),
        Command::Schema => commands::explain::schema(),
        Command::Verify { dir, jobs } => commands::verify::verify(&dir, jobs),
    };
    ExitCode::from(code)
}
