//! The page of a run that may go on, on this computer only.

use crate::error::ReportError;
use crate::folder::Results;
use crate::html::escaped;
use crate::page::{Purpose, page};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, UNIX_EPOCH};

/// Files that change when a run goes on.
const CHANGING: [&str; 6] = ["summary.json", "checkpoint.json", "fields.pvd", "bodies.pvd", "history.csv", "log.jsonl"];
/// A browser that says nothing for so long is not waited for.
const PATIENCE: Duration = Duration::from_secs(5);
/// The longest request that is read, in bytes.
const LONGEST: u64 = 16_384;

/// The page of a folder, and the state of the folder that it shows.
type Made = Option<(String, Arc<Vec<u8>>)>;

/// Serves the page of a folder on the loopback address.
pub struct Server {
    listener: TcpListener,
    folder: PathBuf,
    made: Mutex<Made>,
}

impl Server {
    /// Listens on a port, or on any that is free for 0.
    ///
    /// # Errors
    /// A folder without results, or a port that is taken.
    pub fn new(folder: &Path, port: u16) -> Result<Self, ReportError> {
        Results::read(folder)?;
        let listen = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = listen.map_err(|source| ReportError::Listen { port, source })?;
        Ok(Self { listener, folder: folder.to_path_buf(), made: Mutex::new(None) })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// A socket that is gone.
    pub fn address(&self) -> Result<SocketAddr, ReportError> {
        self.listener.local_addr().map_err(|source| ReportError::Listen { port: 0, source })
    }

    /// Answers for ever.
    pub fn run(self) {
        let server = Arc::new(self);
        for stream in server.listener.incoming().flatten() {
            let server = Arc::clone(&server);
            // A browser that goes away is no error.
            std::thread::spawn(move || server.answer(stream).ok());
        }
    }

    fn answer(&self, mut stream: TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let mut lines = BufReader::new(stream.try_clone()?.take(LONGEST)).lines();
        let request = lines.next().transpose()?.unwrap_or_default();
        let mut host = String::new();
        for line in lines {
            let line = line?;
            if line.is_empty() {
                break;
            }
            if let Some((name, value)) = line.split_once(':')
                && name.eq_ignore_ascii_case("host")
            {
                host = value.trim().to_string();
            }
        }
        let name = host.rsplit_once(':').map_or(host.as_str(), |(name, _)| name);
        let path = request.split(' ').nth(1).unwrap_or("/").split('?').next().unwrap_or("/");
        let plain = "text/plain; charset=utf-8";
        let (status, kind, body) = match () {
            // Pages of other names that lead here must not read results.
            () if !["localhost", "127.0.0.1"].contains(&name) => ("403 Forbidden", plain, Arc::default()),
            () if !request.starts_with("GET ") => ("405 Method Not Allowed", plain, Arc::default()),
            () if path == "/" => ("200 OK", "text/html; charset=utf-8", self.page()),
            () if path == "/state" => ("200 OK", plain, Arc::new(self.state().into_bytes())),
            () if path == "/favicon.ico" => ("204 No Content", plain, Arc::default()),
            () => ("404 Not Found", plain, Arc::new(b"not found\n".to_vec())),
        };
        let head = format!(
            "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
            body.len()
        );
        stream.write_all(head.as_bytes())?;
        stream.write_all(&body)?;
        stream.flush()
    }

    /// The page of what is there now; the one before where nothing has changed.
    fn page(&self) -> Arc<Vec<u8>> {
        let state = self.state();
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, page)) = &*made
            && *of == state
        {
            return Arc::clone(page);
        }
        let html = match Results::read(&self.folder) {
            Ok(results) => page(&results, Purpose::Served),
            // A run that begins again empties its folder first.
            Err(error) => format!(
                "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"2\"><title>signorini</title><p>{}</p>",
                escaped(&error.to_string())
            ),
        };
        let html = Arc::new(html.replace("{{state}}", &state).into_bytes());
        *made = Some((state, Arc::clone(&html)));
        html
    }

    /// A text that changes with the results.
    fn state(&self) -> String {
        let of = |name: &&str| {
            let found = std::fs::metadata(self.folder.join(name)).ok();
            found.map_or("-".to_string(), |m| {
                let time = m.modified().ok().and_then(|t| t.duration_since(UNIX_EPOCH).ok()).unwrap_or_default();
                format!("{}.{}", time.as_millis(), m.len())
            })
        };
        CHANGING.iter().map(of).collect::<Vec<_>>().join("/")
    }
}
