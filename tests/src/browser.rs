//! A browser without a window, driven as a person would: by the WebDriver protocol, which `chromedriver` speaks.

use serde_json::{Value, json};
use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The longest time that a page may take for anything, while other tests keep the processors busy.
const PATIENCE: Duration = Duration::from_secs(120);

/// A page in a browser.
#[derive(Debug)]
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    /// Opens a file in a window of this width. Downloads go to a folder, and no network is reached.
    ///
    /// # Panics
    /// When there is no browser.
    #[must_use]
    pub fn open(page: &Path, width: u32, downloads: &Path) -> Self {
        let driver = Command::new("chromedriver").arg("--port=0").stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut driver = driver.expect("chromedriver; on Debian: apt-get install chromium chromium-driver");
        let said = BufReader::new(driver.stdout.take().expect("its output")).lines().map_while(Result::ok);
        let mut ports = said.filter_map(|line| line.split("successfully on port ").nth(1)?.trim_end_matches('.').parse().ok());
        let port = ports.next().expect("the port of chromedriver");
        // Whoever reads no more of its output ends it.
        thread::spawn(move || ports.for_each(drop));
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            &format!("--window-size={width},1000"),
        ];
        let options = json!({ "args": arguments, "prefs": { "download.default_directory": downloads } });
        let wanted = json!({ "goog:chromeOptions": options, "goog:loggingPrefs": { "browser": "ALL" } });
        let mut browser = Self { driver, port, session: String::new() };
        let answer = browser.ask("POST", "", &json!({ "capabilities": { "alwaysMatch": wanted } }));
        browser.session = format!("/{}", answer["sessionId"].as_str().expect("a session"));
        // A window has a frame, so its size is not that of the page.
        browser.ask(
            "POST",
            "/goog/cdp/execute",
            &json!({
                "cmd": "Emulation.setDeviceMetricsOverride",
                "params": { "width": width, "height": 1000, "deviceScaleFactor": 1, "mobile": false },
            }),
        );
        browser.ask("POST", "/url", &json!({ "url": format!("file://{}", page.display()) }));
        browser
    }

    /// Sends a request, and returns the value of the answer.
    fn ask(&self, method: &str, path: &str, body: &Value) -> Value {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("chromedriver listens");
        let body = body.to_string();
        let head = format!(
            "{method} /session{}{path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n",
            self.session,
            body.len()
        );
        stream.write_all((head + &body).as_bytes()).expect("it reads");
        let mut reader = BufReader::new(stream);
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line).expect("an answer");
            if line.trim().is_empty() {
                break;
            }
            let (name, value) = line.split_once(':').unwrap_or_default();
            if name.eq_ignore_ascii_case("content-length") {
                length = value.trim().parse().expect("a length");
            }
        }
        let mut answer = vec![0; length];
        reader.read_exact(&mut answer).expect("a whole answer");
        let answer: Value = serde_json::from_slice(&answer).expect("JSON");
        assert!(answer["value"]["error"].is_null(), "{path}: {}", answer["value"]["message"]);
        answer["value"].clone()
    }

    /// The value of a script's body.
    #[must_use]
    pub fn run(&self, script: &str) -> Value {
        self.ask("POST", "/execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// Waits until an expression is true.
    ///
    /// # Panics
    /// When it does not become true.
    #[track_caller]
    pub fn wait(&self, expression: &str) {
        let begin = Instant::now();
        while self.run(&format!("return Boolean({expression})")) != true {
            assert!(begin.elapsed() < PATIENCE, "not true in time: {expression}; {}", self.text("alert"));
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// The text of the element with this `id`.
    #[must_use]
    pub fn text(&self, id: &str) -> String {
        self.run(&format!("return document.getElementById('{id}').textContent")).as_str().unwrap_or_default().to_owned()
    }

    /// Sets a control, and tells the page as the browser does after a person has.
    pub fn choose(&self, id: &str, value: &str) {
        let _ = self.run(&format!(
            "const control = document.getElementById('{id}'); control.value = '{value}';
             control.dispatchEvent(new Event('input', {{ bubbles: true }}))"
        ));
    }

    /// Clicks on the element that a selector finds.
    pub fn click(&self, selector: &str) {
        let found = self.ask("POST", "/element", &json!({ "using": "css selector", "value": selector }));
        let number = found.as_object().and_then(|of| of.values().next()).and_then(Value::as_str).expect("an element");
        self.ask("POST", &format!("/element/{number}/click"), &json!({}));
    }

    /// Moves a pointer, a `mouse` or a finger (`touch`), along points, from the first to the last with its button down.
    pub fn drag(&self, pointer: &str, points: &[(i64, i64)]) {
        let step = |&(x, y): &(i64, i64)| json!({ "type": "pointerMove", "duration": 20, "x": x, "y": y });
        let mut actions: Vec<_> = points.iter().map(step).collect();
        actions.insert(1, json!({ "type": "pointerDown", "button": 0 }));
        actions.push(json!({ "type": "pointerUp", "button": 0 }));
        self.ask(
            "POST",
            "/actions",
            &json!({ "actions": [{ "type": "pointer", "id": pointer, "parameters": { "pointerType": pointer }, "actions": actions }] }),
        );
    }

    /// Presses a key, as WebDriver names it.
    pub fn press(&self, key: char) {
        let actions = ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": key }));
        self.ask("POST", "/actions", &json!({ "actions": [{ "type": "key", "id": "keys", "actions": actions }] }));
    }

    /// What the page has written to its console since it was asked last.
    #[must_use]
    pub fn console(&self) -> Vec<String> {
        let lines = self.ask("POST", "/se/log", &json!({ "type": "browser" }));
        lines.as_array().into_iter().flatten().map(ToString::to_string).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !thread::panicking() {
            self.ask("DELETE", "", &json!({}));
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
