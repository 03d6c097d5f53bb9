//! The command `sweep`: a case run many times with other values of some of its keys.

use crate::bar::Runs;
use crate::commands::{DONE, INTERRUPTED, NOT_CONVERGED, default_folder, output_error, read, report};
use crate::console::{say, tell};
use signorini::problem::CaseError;
use signorini::sweep::{
    Keep, Manifest, Record, Sample, Status, SweepError, SweepFolder, Table, Variation, Wanted, Watch, gather,
    run_missing, run_row, script,
};
use std::path::{Path, PathBuf};

/// More failed runs than this are not listed.
const LISTED: usize = 10;

pub const HELP: &str = "Examples:
  signorini sweep case.toml --vary loads.press.normal=-0.1:-1:10 -o pressed
  signorini sweep case.toml --vary contacts.foot.friction.coulomb.mu=0.1:0.5:5 --vary constants.heading=0,0.3,0.6 -j 4
  signorini sweep case.toml --vary bodies.block.solid.material.linear_elastic.youngs_modulus=1:1000:13:log --keep summary
  signorini sweep case.toml --vary loads.press.normal=-1:-0.1 --vary bodies.film.membrane.tension=0.5:2 --sample 50 --seed 7
  signorini sweep pressed                        go on with what is missing
  signorini sweep pressed --gather --collect contacts.touch.area,energy
  signorini sweep case.toml --vary … -o big --plan && sbatch big/sweep.slurm

Values: FROM:TO:COUNT in equal steps, FROM:TO:COUNT:log in equal factors, or a list a,b,c. Several --vary are combined to a grid.
Each run is one of its own in DIR/runs/0001, 0002, …; the table is DIR/sweep.csv, the picture DIR/sweep.png. A sweep that was
interrupted or killed goes on when it is called again.

Exit status: 0 all runs done, 1 wrong input, 2 some runs failed or are missing, 130 interrupted.";

#[derive(clap::Args)]
pub struct SweepOptions {
    /// The case file, or - for standard input; or the folder of a sweep, to go on with it
    case: PathBuf,
    /// A key and its values. May be given several times
    #[arg(long, value_name = "KEY=VALUES", allow_hyphen_values = true)]
    vary: Vec<String>,
    /// Number of runs of a Latin hypercube over the ranges, in place of the grid
    #[arg(long, value_name = "N")]
    sample: Option<usize>,
    /// Seed of the sample
    #[arg(long, value_name = "S", default_value_t = 0, requires = "sample")]
    seed: u64,
    /// Replace or add a key in all runs
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// Folder for the results (default: the case's name, with .sweep)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Number of runs side by side (default: number of threads). Results do not depend on it
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// What stays of each run: all its files, or summary.json
    #[arg(long, value_enum, default_value_t = KeepOption::All)]
    keep: KeepOption,
    /// What the table collects from the summaries, by paths in summary.json or in its last increment (default: the main numbers)
    #[arg(long, value_name = "PATH,…", value_delimiter = ',')]
    collect: Vec<String>,
    /// Remove the results of an earlier sweep in the folder and begin anew
    #[arg(long)]
    restart: bool,
    /// Write the manifest and a script for Slurm, and run nothing
    #[arg(long, conflicts_with_all = ["gather", "task"])]
    plan: bool,
    /// Make the table of the runs that have ended, and run nothing
    #[arg(long, conflicts_with_all = ["task", "restart"])]
    gather: bool,
    /// Run the row of this number alone, from 1, in the folder of a sweep
    #[arg(long, value_name = "K", conflicts_with = "restart")]
    task: Option<usize>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum KeepOption {
    All,
    Summary,
}

/// Runs, plans or gathers a sweep.
pub fn sweep(options: SweepOptions, json: bool) -> u8 {
    match attempt(options, json) {
        Ok(code) => code,
        Err(SweepError::Case(error)) => report(&error, json),
        Err(SweepError::Output(error)) => report(&output_error(&error), json),
    }
}

fn attempt(options: SweepOptions, json: bool) -> Result<u8, SweepError> {
    let is_folder = options.case.is_dir();
    let path = match (&options.output, is_folder) {
        (None, true) => options.case.clone(),
        (Some(_), true) => {
            return Err(CaseError::new("-o together with the folder of a sweep").help("leave out -o").into());
        }
        (Some(output), false) => output.clone(),
        (None, false) => {
            let name = default_folder(&options.case).display().to_string();
            PathBuf::from(format!("{}.sweep", name.trim_end_matches(".results")))
        }
    };
    let folder = SweepFolder::new(&path);
    let prepared = if is_folder { None } else { Some(stated(&options)?) };
    if prepared.is_none() && (!options.vary.is_empty() || !options.set.is_empty() || options.sample.is_some()) {
        let error = CaseError::new(format!("the sweep in `{}` states already what is varied", path.display()));
        return Err(error
            .help("leave out --vary, --set and --sample, or give the case file in place of the folder")
            .into());
    }
    if let Some(number) = options.task {
        let manifest = Manifest::read(&folder)?;
        let _held = folder.lock(false)?;
        return one(&folder, &manifest, number, json);
    }
    if prepared.is_some() {
        folder.make()?;
    }
    let _held = if is_folder && !folder.is_begun() { None } else { folder.lock(true)? };
    let (manifest, resumed) = match prepared {
        Some(manifest) => manifest.enter(&folder, options.restart)?,
        None => {
            let mut manifest = Manifest::read(&folder)?;
            manifest.collects(&options.collect, &folder)?;
            if options.restart {
                folder.clear()?;
                manifest = manifest.enter(&folder, false)?.0;
            }
            (manifest, true)
        }
    };
    let missing = manifest.missing(&folder).len();
    if options.plan {
        return planned(&folder, &manifest, json);
    }
    if resumed && !json && !options.gather && missing < manifest.rows.len() {
        tell!("note: {} of {} runs have ended before", manifest.rows.len() - missing, manifest.rows.len());
    }
    let mut interrupted = false;
    if !options.gather {
        let all = rayon::current_num_threads();
        let jobs = options.jobs.map_or(all, usize::from).min(missing.max(1));
        let bar = Bar(Runs::new(manifest.rows.len(), manifest.rows.len() - missing, json));
        let counted = run_missing(&folder, &manifest, (jobs, (all / jobs).max(1)), &bar);
        bar.0.finish();
        interrupted = counted?.interrupted;
    }
    let table = gather(&folder, &manifest)?;
    if json {
        let mut out = table.to_json();
        out["output"] = path.display().to_string().into();
        out["interrupted"] = interrupted.into();
        say!("{out}");
    } else {
        show(&path, &manifest, &table, interrupted);
    }
    Ok(match table.count(Status::Done) == manifest.rows.len() {
        _ if interrupted => INTERRUPTED,
        true => DONE,
        false => NOT_CONVERGED,
    })
}

/// The sweep of a case as the options state it.
fn stated(options: &SweepOptions) -> Result<Manifest, CaseError> {
    let (name, text) = read(&options.case)?;
    let vary = options.vary.iter().map(|text| Variation::parse(text)).collect::<Result<Vec<_>, _>>()?;
    Manifest::new(&Wanted {
        name,
        text,
        set: options.set.clone(),
        vary,
        sample: options.sample.map(|count| Sample { count, seed: options.seed }),
        keep: match options.keep {
            KeepOption::All => Keep::All,
            KeepOption::Summary => Keep::Summary,
        },
        collect: options.collect.clone(),
    })
}

/// Runs one row.
fn one(folder: &SweepFolder, manifest: &Manifest, number: usize, json: bool) -> Result<u8, SweepError> {
    let count = manifest.rows.len();
    if number == 0 || number > count {
        return Err(CaseError::new(format!("there is no row {number}")).help(format!("valid are 1 to {count}")).into());
    }
    let record = match folder.record(number - 1)? {
        Some(record) => Some(record),
        None => {
            let mut bar = crate::bar::Bar::new(json);
            let record = run_row(folder, manifest, number - 1, &mut bar);
            bar.finish();
            record?
        }
    };
    let Some(record) = record else { return Ok(INTERRUPTED) };
    if json {
        let record = serde_json::json!({
            "run": number, "status": record.status.word(), "reason": record.reason, "message": record.message,
        });
        say!("{record}");
    } else {
        say!("{}", line(number, manifest, &record));
    }
    Ok(if record.status == Status::Done { DONE } else { NOT_CONVERGED })
}

/// Writes the script, and says what to do with it.
fn planned(folder: &SweepFolder, manifest: &Manifest, json: bool) -> Result<u8, SweepError> {
    folder.write("sweep.slurm", script(folder.path(), manifest).as_bytes())?;
    let (path, count) = (folder.path().display(), manifest.rows.len());
    if json {
        say!("{}", serde_json::json!({"runs": count, "output": path.to_string(), "script": "sweep.slurm"}));
        return Ok(DONE);
    }
    say!("{count} runs are planned in {path}. Adapt sweep.slurm and submit it:\n");
    say!("  sbatch {path}/sweep.slurm\n  signorini sweep {path} --gather    when all have ended: the table\n");
    say!("or run them here:\n\n  signorini sweep {path}");
    Ok(DONE)
}

/// A run in a line: its values, how it ended.
fn line(number: usize, manifest: &Manifest, record: &Record) -> String {
    let own = manifest.settings(number - 1).split_off(manifest.set.len());
    let message = if record.message.is_empty() { String::new() } else { format!(": {}", record.message) };
    format!("{number:04}  {}  {} ({}){message}", own.join("  "), record.status.word(), record.reason)
}

fn show(path: &Path, manifest: &Manifest, table: &Table, interrupted: bool) {
    let [done, failed, missing] = [Status::Done, Status::Failed, Status::Missing].map(|s| table.count(s));
    let rest = [(failed, "failed"), (missing, "missing")].map(|(n, what)| match n {
        0 => String::new(),
        n => format!(", {n} {what}"),
    });
    say!("{} runs: {done} done{}", manifest.rows.len(), rest.concat());
    let lines = table.records.iter().enumerate().filter(|(_, r)| r.status == Status::Failed);
    lines.take(LISTED).for_each(|(k, record)| say!("  {}", line(k + 1, manifest, record)));
    if failed > LISTED {
        say!("  and {} more: see the columns reason and message of sweep.csv", failed - LISTED);
    }
    let has_picture = path.join("sweep.png").is_file();
    let picture = if has_picture { "open sweep.png; " } else { "" };
    say!("\nResults in {}: {picture}numbers in sweep.csv; each run in runs.", path.display());
    if missing > 0 {
        let why = if interrupted { "Interrupted. " } else { "" };
        say!("{why}Go on with  signorini sweep {}", path.display());
    }
}

/// The bar as one who looks on.
struct Bar(Runs);

impl Watch for Bar {
    fn ended(&self, _: usize, record: &Record) {
        self.0.ended(record.status == Status::Failed);
    }
    fn interrupted(&self) -> bool {
        self.0.interrupted()
    }
}
