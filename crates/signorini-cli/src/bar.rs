//! Progress on the terminal, and the key that interrupts.

use crate::console::tell;
use indicatif::{ProgressBar, ProgressStyle};
use signorini::run::{Iteration, Progress};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A bar per increment, with the current residual; silent where nobody watches.
pub struct Bar {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
    json: bool,
    started: std::time::Instant,
    spoke: std::time::Instant,
    /// The increment with which the run began.
    first: Option<usize>,
    /// About how long the run still takes, in words.
    left: String,
}

impl Bar {
    pub fn new(json: bool) -> Self {
        let bar = if json { ProgressBar::hidden() } else { ProgressBar::new(1) };
        let style = ProgressStyle::with_template("{bar:24.cyan/blue} {pos}/{len}  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let now = std::time::Instant::now();
        Self { bar, stop: stop_flag(), json, started: now, spoke: now, first: None, left: String::new() }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The number of queries answered so far.
pub struct Counter {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
}

impl Counter {
    pub fn new(json: bool) -> Self {
        let bar = if json { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
        let style = ProgressStyle::with_template("{spinner} {pos} queries, {per_sec}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        Self { bar, stop: stop_flag() }
    }

    /// Returns whether to go on.
    pub fn show(&self, answered: usize) -> bool {
        self.bar.set_position(answered as u64);
        !self.interrupted()
    }

    pub fn interrupted(&self) -> bool {
        self.stop.load(Ordering::SeqCst)
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The number of runs of a sweep that have ended.
pub struct Runs {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
    json: bool,
    started: std::time::Instant,
    count: usize,
    told: Mutex<Told>,
}

/// What was told of them so far.
struct Told {
    /// Runs that ended in this call.
    ended: usize,
    failed: usize,
    /// Runs that had ended before.
    before: usize,
    spoke: std::time::Instant,
}

impl Runs {
    pub fn new(count: usize, before: usize, json: bool) -> Self {
        let bar = if json { ProgressBar::hidden() } else { ProgressBar::new(count as u64) };
        let style = ProgressStyle::with_template("{bar:24.cyan/blue} {pos}/{len} runs  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_position(before as u64);
        let started = std::time::Instant::now();
        let told = Mutex::new(Told { ended: 0, failed: 0, before, spoke: started });
        Self { bar, stop: stop_flag(), json, started, count, told }
    }

    /// One more has ended.
    pub fn ended(&self, failed: bool) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        told.ended += 1;
        told.failed += usize::from(failed);
        let done = told.before + told.ended;
        let each = self.started.elapsed().as_secs_f64() / told.ended as f64;
        let left = format!("about {} left", in_words(each * self.count.saturating_sub(done) as f64));
        let failed = if told.failed > 0 { format!("  {} failed", told.failed) } else { String::new() };
        if self.bar.is_hidden() && !self.json && told.spoke.elapsed().as_secs() >= 10 {
            tell!("[{:.0} s] {done} of {} runs  {left}{failed}", self.started.elapsed().as_secs_f64(), self.count);
            told.spoke = std::time::Instant::now();
        }
        self.bar.set_position(done as u64);
        self.bar.set_message(format!("{left}{failed}"));
    }

    pub fn interrupted(&self) -> bool {
        self.stop.load(Ordering::SeqCst)
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Set by Ctrl-C; a second one ends the program at once.
fn stop_flag() -> Arc<AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let handler = flag.clone();
        let _ = ctrlc::set_handler(move || {
            if handler.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            tell!("stopping after this iteration; the increments computed so far are on disk");
        });
        flag
    })
    .clone()
}

impl Progress for Bar {
    fn size(&mut self, told: &str) {
        if !self.json {
            tell!("{told}");
        }
    }

    fn step(&mut self, index: usize, count: usize, time: f64) {
        self.bar.set_length(count as u64);
        self.bar.set_position(index as u64);
        let done = index.saturating_sub(*self.first.get_or_insert(index));
        self.left = match done {
            0 => String::new(),
            done => {
                let each = self.started.elapsed().as_secs_f64() / done as f64;
                format!("about {} left  ", in_words(each * count.saturating_sub(index) as f64))
            }
        };
        self.bar.set_message(format!("{}t = {time}", self.left));
    }

    fn iteration(&mut self, i: &Iteration) {
        let figures: Vec<String> = i.figures.iter().map(|(n, v)| format!("{n} {v}")).collect();
        let line = format!(
            "{}t = {}  solve {}  residual {:.1e}  {}  {}",
            self.left,
            i.time,
            i.iteration,
            i.residual,
            i.action,
            figures.join("  ")
        );
        // Where no bar can be drawn, a line now and then says that work goes on.
        if self.bar.is_hidden() && !self.json && self.spoke.elapsed().as_secs() >= 10 {
            tell!("[{:.0} s] {line}", self.started.elapsed().as_secs_f64());
            self.spoke = std::time::Instant::now();
        }
        self.bar.set_message(line);
    }

    fn interrupted(&self) -> bool {
        self.stop.load(Ordering::SeqCst)
    }
}

/// A time in words, as exactly as one can be told that is not known well.
fn in_words(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{:.0} s", s.ceil()),
        s if s < 6000.0 => format!("{:.0} min", (s / 60.0).ceil()),
        s => format!("{:.0} h", (s / 3600.0).ceil()),
    }
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn times_are_told_in_units_of_their_size() {
        assert_eq!([0.2, 61.0, 130.0, 7300.0].map(in_words), ["1 s", "61 s", "3 min", "3 h"]);
    }
}
