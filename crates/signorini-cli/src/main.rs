//! The `signorini` command.

// What cannot be printed must not panic: see `console`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod bar;
mod begin;
mod commands;
mod console;
mod import;
mod report;
mod sweeps;

use clap::{CommandFactory, Parser, Subcommand};
use console::tell;
use signorini::problem::{CaseError, Limits};
use signorini::processes;
use signorini_report::draw::Wanted;
use std::path::PathBuf;
use std::process::ExitCode;

/// That of musl maps and unmaps every large block: runs would take a third longer.
#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

const EXAMPLES: &str = "Examples:
  signorini gallery                                   list the gallery
  signorini gallery run cosine_disc                   run one of its cases
  signorini run case.toml                             results into ./case
  signorini run case.toml -o out --set loads.press.normal=-0.3
  signorini sweep case.toml --vary loads.press.normal=-0.1:-1:10
  signorini closest queries.json -o answers.json      closest points of pairs of shapes
  signorini fit blister.toml                          adhesion from measurements
  signorini report out                                one HTML page of the results in ./out
  signorini draw out --field displacement --view iso  a picture of them
  signorini check case.toml                           check the case and report its size
  signorini new flat_disc                             a new case from a template
  signorini explain iteration_limit                   explain a word of the results

Exit status: 0 done, 1 wrong input or output that cannot be written, 2 not converged or refused by the audit (results so far are on
disk), 3 a fault of the program, 130 interrupted.";

const CLOSEST_HELP: &str = r#"Examples:
  signorini closest points.npy --to part.stl -o answers.npy
  echo '{"format": "cpp-corpus-1", "cases": [{"id": "first",
    "a": {"type": "point", "p": [0, 0, 2]},
    "b": {"type": "segment", "p0": [1, 0, 0], "p1": [3, 0, 0]}}]}' > queries.json
  signorini closest queries.json -o answers.json

A wrong query is answered with an error, and the exit status is 1. The other queries are answered."#;

const DRAW_HELP: &str = "Examples:
  signorini draw out
  signorini draw out -o cut.png --field von_mises --clip 'x<0.5' --range 0:250
  signorini draw out -o side.pdf --view -y --time 0.5 --scale 10
  signorini draw out -o film.gif --view 30,20

PNG, SVG and PDF show one time, GIF, WebP and APNG all of them. An unknown field is answered with the
fields that there are.";

/// Computational contact mechanics.
#[derive(Parser)]
#[command(name = "signorini", version, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Print results and errors as JSON
    #[arg(long, global = true)]
    json: bool,
    /// Number of threads (default: all). Results do not depend on it
    #[arg(long, global = true, value_name = "N")]
    threads: Option<usize>,
}

#[derive(Subcommand)]
enum Command {
    /// Run a case
    #[command(
        after_help = "Examples:\n  signorini run gallery/cosine_disc/case.toml -o out --set steps.0.to=0.3\n  signorini run gallery/cosine_disc/case.toml -o out --resume"
    )]
    Run {
        /// The case file, or - for standard input
        case: PathBuf,
        #[command(flatten)]
        options: RunOptions,
        #[command(flatten)]
        limits: LimitOptions,
        /// Continue a run that was interrupted or killed. The results are the same to the last digit
        #[arg(long)]
        resume: bool,
    },
    /// Run a case with many values of some of its keys
    #[command(after_help = sweeps::HELP)]
    Sweep(sweeps::SweepOptions),
    /// Check a case without running it
    #[command(after_help = "Example:\n  signorini check case.toml --picture preview.png")]
    Check {
        /// The case file, or - for standard input
        case: PathBuf,
        /// Replace or add a key
        #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
        set: Vec<String>,
        /// Draw the initial state of the case, as PNG, SVG or PDF
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
    },
    /// Compute the adhesion energy from measured loads and contact radii
    #[command(after_help = "Example:\n  signorini fit gallery/blister/case.toml -o fitted")]
    Fit {
        /// The case file, with a table [fit]
        case: PathBuf,
        #[command(flatten)]
        options: RunOptions,
    },
    /// Closest points of pairs of shapes
    #[command(after_help = CLOSEST_HELP)]
    Closest {
        /// The queries as JSON (see docs/closest-points.md); with --to, points as CSV or NPY; - for standard input
        queries: PathBuf,
        /// The shape on which the points are projected: STL, OBJ, PLY, STEP, or JSON as in a query
        #[arg(long, value_name = "SHAPE")]
        to: Option<PathBuf>,
        /// File for the answers: .json, .csv or .npy
        #[arg(short, long, value_name = "ANSWERS")]
        output: PathBuf,
        /// Report all local minima too
        #[arg(long)]
        local_minima: bool,
    },
    /// Write the results of a run as one HTML page
    #[command(
        after_help = "Examples:\n  signorini report out\n  signorini report out -o hertz.html\n\nThe folder is one that signorini run, fit or gallery run has written. Failed and interrupted\nruns are shown as far as they came."
    )]
    Report {
        /// The folder of the results, or a JSON file of signorini closest
        folder: PathBuf,
        /// The file (default: report.html in the folder)
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Draw the results of a run anew, without solving
    #[command(after_help = DRAW_HELP)]
    Draw {
        /// The folder of the results, or a JSON file of signorini closest
        results: PathBuf,
        #[command(flatten)]
        options: DrawOptions,
    },
    /// Show the results of a run in a browser, also while it goes on
    #[command(after_help = "Example:\n  signorini view out")]
    View {
        /// The folder of the results
        folder: PathBuf,
        /// The port of the loopback address (default: any that is free)
        #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
        port: u16,
    },
    /// Create a folder with a new case from a commented template
    #[command(
        after_help = "Examples:\n  signorini new flat_disc\n  signorini new cosine_disc my_case\n\nThe templates are the cases of the gallery: signorini gallery lists them."
    )]
    New {
        /// A case of the gallery
        template: String,
        /// The new folder (default: the template's name)
        folder: Option<PathBuf>,
    },
    /// Write the case of an input deck of CalculiX or Abaqus (.inp), FEBio (.feb), MuJoCo (.xml), OpenSim (.osim) or MoorDyn (.txt,
    /// .dat)
    #[command(
        after_help = "Example:\n  signorini import deck.inp -o case.toml\n\nThe case refers to the deck for its mesh. What is left out or changed stands at its top. A deck that\nneeds what does not exist here is refused, with the line and the keyword."
    )]
    Import {
        /// The deck
        deck: PathBuf,
        /// The case file, or - for standard output (default: the name of the deck, with .toml)
        #[arg(short, long, value_name = "CASE")]
        output: Option<PathBuf>,
        /// Keep linear stiffnesses of contacts as compliances of the surfaces
        #[arg(long)]
        keep_stiffness: bool,
    },
    /// Rewrite case files of earlier versions with the present names of keys
    #[command(
        after_help = "Example:\n  signorini migrate case.toml\n\nComments and layout stay. Earlier names are read with a warning."
    )]
    Migrate {
        /// The case files; - prints standard input with the present names
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Explain a key of the case file or a word of the results
    #[command(
        after_help = "Examples:\n  signorini explain membrane.tension\n  signorini explain iteration_limit\n  signorini explain expressions"
    )]
    Explain {
        /// A key, the end of a key, or a word. If left out, all words are listed
        word: Option<String>,
    },
    /// Print the JSON Schema of case files, for editors, or of the summary, for programs
    #[command(
        after_help = "Examples:\n  signorini schema > case.schema.json\n\nand as the first line of a case\n  #:schema \
                      ./case.schema.json\n\nfor the results of a run:\n  signorini schema --summary"
    )]
    Schema {
        /// Print the schema of summary.json
        #[arg(long, conflicts_with = "markdown")]
        summary: bool,
        /// Print the keys of both as Markdown tables
        #[arg(long)]
        markdown: bool,
    },
    /// Run problems with known solutions
    #[command(after_help = "Example:\n  signorini verify")]
    Verify,
    /// Reproduce figures of the publication of the inequality level-set method
    #[command(
        after_help = "Examples:\n  signorini reproduce\n  signorini reproduce front_error\n  signorini reproduce all -o docs/validation"
    )]
    Reproduce {
        /// Names of figures, or all. If left out, the figures are listed
        names: Vec<String>,
        /// The folder for pages and pictures
        #[arg(short, long, default_value = "reproduced")]
        output: PathBuf,
    },
    /// Print the completions of a shell
    #[command(
        after_help = "Example:\n  signorini completions bash > ~/.local/share/bash-completion/completions/signorini"
    )]
    Completions { shell: clap_complete::Shell },
    /// Write the manual pages of all commands into a folder
    #[command(after_help = "Example:\n  signorini man ~/.local/share/man/man1\n  man signorini-run")]
    Man {
        /// The folder
        folder: PathBuf,
    },
    /// List the gallery, or run one of its cases
    #[command(
        after_help = "Examples:\n  signorini gallery\n  signorini gallery run flat_disc\n  signorini gallery show flat_disc > case.toml"
    )]
    Gallery {
        #[command(subcommand)]
        action: Option<GalleryAction>,
    },
}

#[derive(clap::Args)]
struct RunOptions {
    /// Folder for the results (default: the case's name in the current folder)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace or add a key
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
}

#[derive(clap::Args)]
struct LimitOptions {
    /// Stop after this time, store the results, and exit with status 2
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    max_time: Option<f64>,
    /// Stop after this number of iterations over all increments
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i64).range(1..))]
    max_iterations: Option<i64>,
}

#[derive(clap::Args)]
struct DrawOptions {
    /// The file: png, svg, pdf, gif, webp or apng (default: pictures/drawn_FIELD.png in the folder)
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// What the colours show, by its name in the files; `none` for no colours (default: that of most interest)
    #[arg(long, value_name = "NAME")]
    field: Option<String>,
    /// The time, the nearest that is stored; `first` or `last` (default: last, and all in files that move)
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    time: Option<String>,
    /// From where: x, -x, y, -y, z, -z, iso, or AZIMUTH,ELEVATION in degrees (default: as the run draws it)
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true)]
    view: Option<String>,
    /// Keep a half-space, such as 'x<0.5' or 'x+2*z>1'; 'y=0' keeps what is behind. May be repeated
    #[arg(long = "clip", value_name = "PLANE", allow_hyphen_values = true)]
    clips: Vec<String>,
    /// The ends of the colour map, in the unit of the field
    #[arg(long, value_name = "LOW:HIGH", allow_hyphen_values = true)]
    range: Option<String>,
    /// Multiply displacements, or heights of membranes, by this
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    scale: Option<f64>,
    /// Size in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT")]
    size: Option<String>,
}

impl DrawOptions {
    fn wanted(self) -> (Option<PathBuf>, Wanted) {
        let Self { output, field, time, view, clips, range, scale, size } = self;
        (output, Wanted { field, time, view, clips, range, scale, size })
    }
}

impl RunOptions {
    fn wanted(self, limits: &LimitOptions, resume: bool) -> commands::Wanted {
        let limits = Limits { max_time: limits.max_time, max_iterations: limits.max_iterations };
        commands::Wanted { output: self.output, set: self.set, limits, resume }
    }
}

/// A positive number.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().map_err(|e| e.to_string())?;
    if number > 0.0 { Ok(number) } else { Err("it must be positive".into()) }
}

#[derive(Subcommand)]
enum GalleryAction {
    /// Run a case of the gallery
    #[command(after_help = "Example:\n  signorini gallery run cosine_square -o square")]
    Run {
        name: String,
        #[command(flatten)]
        options: RunOptions,
        #[command(flatten)]
        limits: LimitOptions,
    },
    /// Print a case of the gallery
    #[command(after_help = "Example:\n  signorini gallery show string > case.toml")]
    Show { name: String },
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Asking for help is no error; a wrong command line is wrong input.
            if error.use_stderr() {
                let _ = error.print();
                return ExitCode::from(commands::WRONG_INPUT);
            }
            console::note(error.print());
            return ExitCode::from(console::finish(commands::DONE));
        }
    };
    let threads = arguments.threads.unwrap_or(match processes::started() {
        1 => 0,
        // Processes share the cores of a machine.
        _ => std::thread::available_parallelism().map_or(1, |n| (n.get() / processes::started_here()).max(1)),
    });
    if arguments.threads == Some(0) || threads > 1024 {
        tell!("error: --threads {threads}: give a number from 1 to 1024");
        return ExitCode::from(1);
    }
    // A pool that cannot be built leaves the default one.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    let json = arguments.json;
    if processes::started() > 1
        && let Err(error) = together(&arguments.command)
    {
        return ExitCode::from(commands::report(&error, json));
    }
    let result = std::panic::catch_unwind(|| match arguments.command {
        Command::Run { case, options, limits, resume } => {
            commands::run_file(&case, &options.wanted(&limits, resume), json)
        }
        Command::Sweep(options) => sweeps::sweep(options, json),
        Command::Check { case, set, picture } => commands::check(&case, &set, picture.as_deref(), json),
        Command::Fit { case, options } => commands::fit_file(&case, options.output, &options.set, json),
        Command::Closest { queries, to, output, local_minima } => {
            commands::closest(&queries, to.as_deref(), &output, local_minima, json)
        }
        Command::Report { folder, output } => report::write(&folder, output.as_deref(), json),
        Command::Draw { results, options } => {
            let (output, wanted) = options.wanted();
            report::draw(&results, output.as_deref(), &wanted, json)
        }
        Command::View { folder, port } => report::view(&folder, port, json),
        Command::New { template, folder } => begin::new(&template, folder, json),
        Command::Import { deck, output, keep_stiffness } => import::import(&deck, output, keep_stiffness, json),
        Command::Migrate { files } => begin::migrate(&files, json),
        Command::Explain { word } => begin::explain(word.as_deref(), json),
        Command::Schema { summary, markdown } => begin::schema(summary, markdown),
        Command::Verify => begin::verify(json),
        Command::Reproduce { names, output } => begin::reproduce(&names, &output),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "signorini", &mut text);
            console::print(format_args!("{}", String::from_utf8_lossy(&text)));
            commands::DONE
        }
        Command::Man { folder } => begin::man(Arguments::command(), &folder, json),
        Command::Gallery { action: None } => commands::gallery(json),
        Command::Gallery { action: Some(GalleryAction::Run { name, options, limits }) } => {
            commands::run_example(&name, &options.wanted(&limits, false), json)
        }
        Command::Gallery { action: Some(GalleryAction::Show { name }) } => commands::show_example(&name, json),
    });
    match result {
        Ok(code) => {
            let code = console::finish(code);
            processes::end();
            ExitCode::from(code)
        }
        Err(_) => {
            tell!("signorini has an internal fault: please report the case and the message above.");
            processes::abort(3);
            ExitCode::from(3)
        }
    }
}

/// Connects processes that were started together: they run one case.
fn together(command: &Command) -> Result<(), CaseError> {
    let runs = matches!(command, Command::Run { .. } | Command::Gallery { action: Some(GalleryAction::Run { .. }) });
    if !runs {
        let message = format!("{} processes were started together, which is for  signorini run", processes::started());
        return Err(CaseError::new(message).help("start one process for other commands"));
    }
    processes::connect()
}
