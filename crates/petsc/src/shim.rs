//! The functions of `shim.c`, safe to call: lengths are checked here, and nowhere else is `unsafe`.
//!
//! MPI is started as `MPI_THREAD_FUNNELED`: all calls come from the thread that started it, which is that of the run.

use std::ffi::{CStr, CString, c_char, c_int, c_void};

/// An entry of a matrix, as the shim has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Entry {
    pub row: u32,
    pub column: u32,
    pub value: f64,
}

#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

unsafe extern "C" {
    fn sig_start() -> c_int;
    fn sig_rank() -> c_int;
    fn sig_size() -> c_int;
    fn sig_abort(code: c_int);
    fn sig_end() -> c_int;
    fn sig_broadcast(data: *mut c_void, bytes: c_int, from: c_int) -> c_int;
    fn sig_least(own: c_int) -> c_int;
    fn sig_to_all(
        send: *const f64,
        send_counts: *const c_int,
        send_starts: *const c_int,
        receive: *mut f64,
        receive_counts: *const c_int,
        receive_starts: *const c_int,
    ) -> c_int;
    fn sig_gather(own: *const f64, count: c_int, all: *mut f64, counts: *const c_int, starts: *const c_int) -> c_int;
    fn sig_exchange_counts(send: *const c_int, receive: *mut c_int) -> c_int;
    fn sig_exchange(
        send: *const Entry,
        send_counts: *const c_int,
        send_starts: *const c_int,
        receive: *mut Entry,
        receive_counts: *const c_int,
        receive_starts: *const c_int,
    ) -> c_int;
    fn sig_options(text: *const c_char) -> c_int;
    fn sig_unused_options(text: *mut c_char, length: c_int) -> c_int;
    fn sig_new(
        rows: c_int,
        all: c_int,
        start: *const c_int,
        columns: *const c_int,
        values: *const f64,
        tolerance: f64,
        most: c_int,
        out: *mut *mut Opaque,
    ) -> c_int;
    fn sig_new_glued(
        rows: c_int,
        all: c_int,
        start: *const c_int,
        columns: *const c_int,
        values: *const f64,
        body_rows: c_int,
        body_all: c_int,
        glued_start: *const c_int,
        glued_columns: *const c_int,
        glued_values: *const f64,
        pull: *const f64,
        spring: *const f64,
        touched: *const c_int,
        touched_count: c_int,
        motions: *const f64,
        motion_count: c_int,
        components: c_int,
        tolerance: f64,
        most: c_int,
        out: *mut *mut Opaque,
    ) -> c_int;
    fn sig_option(name: *const c_char, text: *mut c_char, length: c_int) -> c_int;
    fn sig_free(system: *mut Opaque) -> c_int;
    fn sig_solve(
        system: *mut Opaque,
        right: *const f64,
        found: *mut f64,
        rows: c_int,
        iterations: *mut c_int,
        reason: *mut c_int,
    ) -> c_int;
    fn sig_iterates(system: *mut Opaque) -> c_int;
}

/// What PETSc or MPI returned other than 0.
pub type Code = c_int;

fn checked(code: c_int) -> Result<(), Code> {
    if code == 0 { Ok(()) } else { Err(code) }
}

/// Ends all processes where MPI itself fails: none can go on.
fn or_end(code: c_int) {
    if code != 0 {
        abort(1);
    }
}

pub fn start() -> Result<(), Code> {
    checked(unsafe { sig_start() })
}

pub fn rank() -> usize {
    (unsafe { sig_rank() }) as usize
}

pub fn size() -> usize {
    (unsafe { sig_size() }) as usize
}

pub fn abort(code: u8) -> ! {
    unsafe { sig_abort(c_int::from(code)) };
    std::process::exit(i32::from(code))
}

pub fn end() {
    let _ = unsafe { sig_end() };
}

/// The least of the numbers of all processes.
pub fn least(own: usize) -> usize {
    (unsafe { sig_least(own as c_int) }) as usize
}

/// Replaces bytes by those of one process.
pub fn broadcast(data: &mut [u8], from: usize) {
    or_end(unsafe { sig_broadcast(data.as_mut_ptr().cast(), data.len() as c_int, from as c_int) });
}

/// How many items go to each process, and where each of their lists begins.
pub struct Counts {
    counts: Vec<c_int>,
    starts: Vec<c_int>,
}

impl Counts {
    pub fn new(counts: impl IntoIterator<Item = usize>) -> Self {
        let counts: Vec<c_int> = counts.into_iter().map(|n| n as c_int).collect();
        let mut starts = Vec::with_capacity(counts.len());
        let mut done = 0;
        for n in &counts {
            starts.push(done);
            done += n;
        }
        Counts { counts, starts }
    }

    pub fn all(&self) -> usize {
        self.counts.iter().map(|n| *n as usize).sum()
    }

    pub fn ranges(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        self.starts.iter().zip(&self.counts).map(|(s, n)| *s as usize..(*s + *n) as usize)
    }
}

/// A function of the shim that sends lists: items, counts and starts of what is sent, and of what comes.
type Exchange<T> =
    unsafe extern "C" fn(*const T, *const c_int, *const c_int, *mut T, *const c_int, *const c_int) -> c_int;

/// Sends lists by a function of the shim, and returns what came. Callers have checked the lengths of what is sent.
fn exchanged<T: Clone + Default>(by: Exchange<T>, (send, sent): (&[T], &Counts), received: &Counts) -> Vec<T> {
    let mut out = vec![T::default(); received.all()];
    or_end(unsafe {
        by(
            send.as_ptr(),
            sent.counts.as_ptr(),
            sent.starts.as_ptr(),
            out.as_mut_ptr(),
            received.counts.as_ptr(),
            received.starts.as_ptr(),
        )
    });
    out
}

/// Sends a list to each process, and returns those that came from each, one after the other.
pub fn to_all(send: &[f64], sent: &Counts, received: &Counts) -> Vec<f64> {
    assert_eq!((send.len(), sent.counts.len()), (sent.all(), received.counts.len()));
    exchanged(sig_to_all, (send, sent), received)
}

/// The lists of all processes, one after the other.
pub fn gather(own: &[f64], counts: &Counts) -> Vec<f64> {
    assert_eq!(own.len(), counts.counts[rank()] as usize);
    let mut out = vec![0.0; counts.all()];
    or_end(unsafe {
        sig_gather(own.as_ptr(), own.len() as c_int, out.as_mut_ptr(), counts.counts.as_ptr(), counts.starts.as_ptr())
    });
    out
}

/// Sends entries to each process, and returns those that came, in the order of the processes.
pub fn exchange(send: &[Entry], sent: &Counts) -> Vec<Entry> {
    assert_eq!(send.len(), sent.all());
    let mut counts: Vec<c_int> = vec![0; sent.counts.len()];
    or_end(unsafe { sig_exchange_counts(sent.counts.as_ptr(), counts.as_mut_ptr()) });
    let received = Counts::new(counts.iter().map(|n| *n as usize));
    exchanged(sig_exchange, (send, sent), &received)
}

/// Adds options as PETSc has them on its command line.
pub fn options(text: &str) -> Result<(), Code> {
    let text = CString::new(text).map_err(|_| 1)?;
    checked(unsafe { sig_options(text.as_ptr()) })
}

/// A text that a function of the shim writes into a buffer of a length; none where it fails.
fn text(length: usize, write: impl FnOnce(*mut c_char, c_int) -> c_int) -> Option<String> {
    let mut buffer: Vec<c_char> = vec![0; length];
    let code = write(buffer.as_mut_ptr(), length as c_int);
    (code == 0).then(|| unsafe { CStr::from_ptr(buffer.as_ptr()) }.to_string_lossy().into_owned())
}

/// Options that nothing has asked for.
pub fn unused_options() -> Vec<String> {
    let found = text(4096, |buffer, length| unsafe { sig_unused_options(buffer, length) });
    found.unwrap_or_default().lines().map(str::to_string).collect()
}

/// The value of an option; none where it is not given.
pub fn option(name: &CStr) -> Option<String> {
    let found = text(256, |buffer, length| unsafe { sig_option(name.as_ptr(), buffer, length) });
    found.filter(|text| !text.is_empty())
}

/// Rows of this process, in compressed form, columns in the numbers of all.
#[derive(Default)]
pub struct Compressed {
    pub start: Vec<c_int>,
    pub columns: Vec<c_int>,
    pub values: Vec<f64>,
    /// Rows of all processes.
    pub all: usize,
}

impl Compressed {
    fn rows(&self) -> usize {
        assert_eq!(self.columns.len(), self.values.len());
        assert_eq!(self.start.last().copied(), Some(self.columns.len() as c_int));
        self.start.len() - 1
    }
}

/// Bodies with springs in place of multipliers, which precondition: rows of bodies come first on each process.
#[derive(Default)]
pub struct Glued {
    pub matrix: Compressed,
    /// By multiplier of this process: its part of the load per residual, and the stiffness of its spring.
    pub pull: Vec<f64>,
    pub spring: Vec<f64>,
    /// Rows of `matrix` of this process that springs act on, in the numbers of all.
    pub touched: Vec<c_int>,
    /// Motions that stretch nothing, one after the other, in rows of this process.
    pub motions: Vec<f64>,
    pub components: usize,
}

/// A linear system of PETSc, with what solves it.
pub struct LinearSystem {
    system: *mut Opaque,
    rows: usize,
}

impl LinearSystem {
    /// Factorised, if the options say nothing else.
    pub fn direct(matrix: &Compressed, (tolerance, most): (f64, usize)) -> Result<Self, Code> {
        let rows = matrix.rows();
        let mut system = std::ptr::null_mut();
        checked(unsafe {
            sig_new(
                rows as c_int,
                matrix.all as c_int,
                matrix.start.as_ptr(),
                matrix.columns.as_ptr(),
                matrix.values.as_ptr(),
                tolerance,
                most as c_int,
                &mut system,
            )
        })?;
        Ok(LinearSystem { system, rows })
    }

    /// Solved by iterations.
    pub fn iterative(matrix: &Compressed, glued: &Glued, (tolerance, most): (f64, usize)) -> Result<Self, Code> {
        let (rows, of_bodies) = (matrix.rows(), glued.matrix.rows());
        assert_eq!([glued.pull.len(), glued.spring.len()], [rows - of_bodies; 2]);
        let motions = glued.motions.len() / of_bodies.max(1);
        let mut system = std::ptr::null_mut();
        checked(unsafe {
            sig_new_glued(
                rows as c_int,
                matrix.all as c_int,
                matrix.start.as_ptr(),
                matrix.columns.as_ptr(),
                matrix.values.as_ptr(),
                of_bodies as c_int,
                glued.matrix.all as c_int,
                glued.matrix.start.as_ptr(),
                glued.matrix.columns.as_ptr(),
                glued.matrix.values.as_ptr(),
                glued.pull.as_ptr(),
                glued.spring.as_ptr(),
                glued.touched.as_ptr(),
                glued.touched.len() as c_int,
                glued.motions.as_ptr(),
                motions as c_int,
                glued.components as c_int,
                tolerance,
                most as c_int,
                &mut system,
            )
        })?;
        Ok(LinearSystem { system, rows })
    }

    /// The solution on this process, the iterations, and PETSc's reason to stop: positive where it converged.
    pub fn solve(&self, right: &[f64]) -> Result<(Vec<f64>, usize, i32), Code> {
        assert_eq!(right.len(), self.rows);
        let mut found = vec![0.0; self.rows];
        let (mut iterations, mut reason) = (0, 0);
        checked(unsafe {
            sig_solve(self.system, right.as_ptr(), found.as_mut_ptr(), self.rows as c_int, &mut iterations, &mut reason)
        })?;
        Ok((found, iterations as usize, reason))
    }

    /// Whether its solver counts iterations.
    pub fn iterates(&self) -> bool {
        (unsafe { sig_iterates(self.system) }) != 0
    }
}

impl Drop for LinearSystem {
    fn drop(&mut self) {
        let _ = unsafe { sig_free(self.system) };
    }
}
