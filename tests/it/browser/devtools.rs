//! A browser spoken to over its DevTools protocol: one page, its console, its requests, its hands.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

/// Names another browser than the first of those that are looked for.
const VARIABLE: &str = "CORNER_IMPACT_BROWSER";

/// The browser to test with, if there is one.
fn found() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os(VARIABLE) {
        return Some(named.into());
    }
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// One page of a running browser.
pub struct Page {
    process: Child,
    socket: WebSocket<TcpStream>,
    session: String,
    calls: u64,
    /// What it reported by itself: method and parameters.
    pub events: Vec<(String, Value)>,
    _profile: tempfile::TempDir,
}

impl Page {
    /// Opens a file from disk in a browser that starts for it; `None`, said plainly, where there is none.
    pub fn open(file: &Path) -> Option<Self> {
        Self::visit(&format!("file://{}", file.display()))
    }

    /// Opens an address in a browser that starts for it; `None`, said plainly, where there is none.
    pub fn visit(address: &str) -> Option<Self> {
        let Some(program) = found() else {
            // Past what the test harness keeps to itself of a test that passes.
            let words = "SKIPPED: no Chromium on this machine, so the page was not opened";
            let _ = writeln!(std::io::stderr(), "{words} ({VARIABLE} names another browser)");
            return None;
        };
        let mut page = Self::start(&program);
        for domain in ["Page", "Runtime", "Network", "Log", "DOM"] {
            page.call(&format!("{domain}.enable"), json!({}));
        }
        page.window(1280, 900, false);
        page.go(address);
        Some(page)
    }

    fn start(program: &Path) -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut process = Command::new(program)
            .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-extensions"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage"])
            .arg("--remote-debugging-port=0")
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{}: {error}", program.display()));
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines();
        let address = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| line.split_once("DevTools listening on ").map(|(_, address)| address.to_owned()))
            .expect("the browser ended before it said where it listens");
        // What it goes on to say is read, so that it never waits for a reader.
        std::thread::spawn(move || lines.map_while(Result::ok).for_each(drop));
        let host = address.trim_start_matches("ws://").split('/').next().unwrap().to_owned();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let (socket, _) = tungstenite::client(address, stream).unwrap();
        let mut page =
            Self { process, socket, session: String::new(), calls: 0, events: Vec::new(), _profile: profile };
        let target = page.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = page.call("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }));
        page.session = attached["sessionId"].as_str().unwrap().to_owned();
        page
    }

    fn receive(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().expect("the browser does not answer") {
                return serde_json::from_str(text.as_str()).unwrap();
            }
        }
    }

    /// Calls a method and waits for its result; what is reported meanwhile is kept.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let mut message = json!({ "id": self.calls, "method": method, "params": parameters });
        if !self.session.is_empty() {
            message["sessionId"] = self.session.clone().into();
        }
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let mut answer = self.receive();
            if answer["id"] == self.calls {
                assert!(answer.get("error").is_none(), "{method}: {}", answer["error"]);
                return answer["result"].take();
            }
            if let Some(method) = answer["method"].as_str() {
                let method = method.to_owned();
                self.events.push((method, answer["params"].take()));
            }
        }
    }

    /// Goes to an address and waits until it is loaded.
    pub fn go(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
        self.until("document.readyState === 'complete' && location.href !== 'about:blank'");
    }

    /// The value of an expression on the page.
    pub fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", parameters);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].take()
    }

    /// Waits until an expression is true.
    pub fn until(&mut self, expression: &str) {
        let begun = Instant::now();
        while self.value(expression) != true {
            assert!(begun.elapsed() < Duration::from_secs(300), "never came true: {expression}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The size of the window; a `mobile` one has a finger.
    pub fn window(&mut self, width: u32, height: u32, mobile: bool) {
        let parameters = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", parameters);
        self.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": mobile, "maxTouchPoints": 1 }));
    }

    /// What the page is shown on, and what its reader wants: `("prefers-color-scheme", "dark")`.
    pub fn media(&mut self, medium: &str, wishes: &[(&str, &str)]) {
        let features: Vec<Value> = wishes.iter().map(|(name, value)| json!({ "name": name, "value": value })).collect();
        self.call("Emulation.setEmulatedMedia", json!({ "media": medium, "features": features }));
    }

    /// Presses a key.
    pub fn key(&mut self, key: &str, code: u32) {
        for kind in ["keyDown", "keyUp"] {
            let parameters = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", parameters);
        }
    }

    /// A place in an element, as parts of its size, in the window, after it was scrolled there.
    pub fn place(&mut self, element: &str, [across, down]: [f64; 2]) -> [f64; 2] {
        let place = self.value(&format!(
            "(() => {{ const e = document.querySelector({element:?}); e.scrollIntoView({{ block: 'center', behavior: 'instant' }});
               const b = e.getBoundingClientRect(); return [b.left + {across} * b.width, b.top + {down} * b.height]; }})()"
        ));
        [place[0].as_f64().unwrap(), place[1].as_f64().unwrap()]
    }

    /// Touches a place of an element with a finger.
    pub fn touch(&mut self, element: &str, part: [f64; 2]) {
        let [x, y] = self.place(element, part);
        self.call("Input.dispatchTouchEvent", json!({ "type": "touchStart", "touchPoints": [{ "x": x, "y": y }] }));
        self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
    }

    /// Clicks in the middle of an element.
    pub fn click(&mut self, element: &str) {
        let at = self.place(element, [0.5, 0.5]);
        self.mouse("mousePressed", at);
        self.mouse("mouseReleased", at);
    }

    /// Moves the mouse to a place in the window (`mouseMoved`), or presses or releases its button there.
    pub fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        let parameters = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", parameters);
    }

    /// Console messages, exceptions and log entries.
    pub fn complaints(&self) -> Vec<String> {
        let loud =
            ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded", "Page.javascriptDialogOpening"];
        let events = self.events.iter().filter(|(method, _)| loud.contains(&method.as_str()));
        events.map(|(method, parameters)| format!("{method}: {parameters}")).collect()
    }

    /// Addresses that were asked for.
    pub fn requests(&self) -> Vec<String> {
        let asked = self.events.iter().filter(|(method, _)| method == "Network.requestWillBeSent");
        asked.filter_map(|(_, parameters)| Some(parameters["request"]["url"].as_str()?.to_owned())).collect()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
