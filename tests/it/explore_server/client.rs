//! A server of the live page as a process, and requests to it by hand.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};

use serde_json::{Value, json};

use crate::common;

/// A server that runs until it is dropped.
pub struct Served {
    child: Child,
    out: BufReader<ChildStdout>,
    pub address: SocketAddr,
    /// Path of the page, with the token between its strokes.
    pub page: String,
}

impl Served {
    pub fn start(words: &[&str]) -> Self {
        Self::with(&[words, &["--no-open"]].concat(), |_| {})
    }

    /// Starts one in a changed environment, and reads its address.
    pub fn with(words: &[&str], change: impl FnOnce(&mut Command)) -> Self {
        let mut command = common::that_signals_end(&common::program(["explore"].iter().chain(words)));
        change(&mut command);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        out.read_line(&mut line).unwrap();
        let (host, path) = line.trim_end().strip_prefix("http://").unwrap().split_once('/').unwrap();
        Self { child, out, address: host.parse().unwrap(), page: format!("/{path}") }
    }

    pub fn id(&self) -> String {
        self.child.id().to_string()
    }

    /// Waits for its end: status, and what it printed after the address.
    pub fn end(mut self) -> (ExitStatus, String, String) {
        let (mut out, mut err) = (String::new(), String::new());
        self.out.read_to_string(&mut out).unwrap();
        self.child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
        (self.child.wait().unwrap(), out, err)
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(common::PATIENCE)).unwrap();
        stream
    }

    /// Sends a request with its length, and waits for nothing.
    pub fn begin(&self, method: &str, path: &str, body: &[u8]) -> TcpStream {
        self.written(method, path, &[("Host", self.address.to_string())], body)
    }

    fn written(&self, method: &str, path: &str, fields: &[(&str, String)], body: &[u8]) -> TcpStream {
        let fields: String = fields.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let mut stream = self.connect();
        let head = format!("{method} {path} HTTP/1.1\r\n{fields}Content-Length: {}\r\n\r\n", body.len());
        // Whoever refuses a body may close before its end.
        let _ = stream.write_all(&[head.as_bytes(), body].concat());
        stream
    }

    pub fn send(&self, method: &str, path: &str, fields: &[(&str, String)], body: &[u8]) -> Reply {
        Reply::read(&mut self.written(method, path, fields, body)).unwrap()
    }

    pub fn get(&self, path: &str) -> Reply {
        Reply::read(&mut self.begin("GET", path, &[])).unwrap()
    }

    pub fn post(&self, path: &str, body: &[u8]) -> Reply {
        Reply::read(&mut self.begin("POST", path, body)).unwrap()
    }

    pub fn raw(&self, request: &[u8]) -> Reply {
        let mut stream = self.connect();
        let _ = stream.write_all(request);
        Reply::read(&mut stream).unwrap()
    }

    fn status(&self, name: &str) -> String {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix(&format!("{name}:")));
        line.unwrap().trim().trim_end_matches(" kB").to_owned()
    }

    pub fn kilobytes(&self, name: &str) -> u64 {
        self.status(name).parse().unwrap()
    }

    pub fn threads(&self) -> usize {
        self.status("Threads").parse().unwrap()
    }

    /// Waits until it accepts connections and has none, and returns the number of its threads then.
    pub fn idle(&self) -> usize {
        self.get("/");
        let tasks = || std::fs::read_dir(format!("/proc/{}/task", self.child.id())).unwrap();
        let name = |task: io::Result<std::fs::DirEntry>| std::fs::read_to_string(task.ok()?.path().join("comm")).ok();
        common::until("no connection is left", || !tasks().filter_map(name).any(|name| name.trim() == "connection"));
        self.threads()
    }

    /// Sockets that the process has open.
    pub fn sockets(&self) -> usize {
        let open = std::fs::read_dir(format!("/proc/{}/fd", self.child.id())).unwrap();
        let targets = open.filter_map(|entry| std::fs::read_link(entry.ok()?.path()).ok());
        targets.filter(|to| to.to_string_lossy().starts_with("socket:")).count()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A response.
#[derive(Debug)]
pub struct Reply {
    pub status: u16,
    /// Status line and header fields.
    pub head: String,
    pub body: String,
}

impl Reply {
    /// Reads one until the connection is closed.
    pub fn read(stream: &mut TcpStream) -> io::Result<Self> {
        let mut bytes = Vec::new();
        let read = stream.read_to_end(&mut bytes);
        if bytes.is_empty() {
            read?;
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let text = String::from_utf8(bytes).unwrap();
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or_else(|| panic!("{text:?}"));
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        let reply = Self { status, head: head.to_owned(), body: body.to_owned() };
        assert_eq!(reply.field("content-length"), Some(body.len().to_string().as_str()), "{head}");
        assert_eq!(reply.field("connection"), Some("close"), "{head}");
        Ok(reply)
    }

    pub fn field(&self, name: &str) -> Option<&str> {
        let mut fields = self.head.lines().skip(1).filter_map(|line| line.split_once(": "));
        fields.find(|(other, _)| other.eq_ignore_ascii_case(name)).map(|(_, value)| value)
    }
}

/// A question about the paper's model.
pub fn question(view: &str, fields: &Value) -> String {
    let mut question = json!({ "model": { "file": "osorio-2008.toml", "text": null, "set": {} }, "view": view });
    for (name, value) in fields.as_object().unwrap() {
        question[name] = value.clone();
    }
    question.to_string()
}

/// Status of the response that comes, if one does.
pub fn status_of(stream: &mut TcpStream) -> Option<u16> {
    Reply::read(stream).ok().map(|reply| reply.status)
}
