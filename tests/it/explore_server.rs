//! Does the server of the live page answer its own page as the command line does, and end with the page?

#![cfg(target_os = "linux")]

pub mod client;

use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::ExitStatusExt;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::browser::devtools::Page;
use crate::common;
use client::{Served, question, status_of};

const SIGINT: i32 = 2;

/// A question that takes minutes.
fn endless() -> String {
    let over = json!({ "name": "rpm", "low": 180, "high": 190, "count": 1000 });
    question("diagram", &json!({ "over": over, "transient": 99_000, "record": 1000 }))
}

/// Each answer names a command whose document or table has the same digits.
#[test]
#[ignore = "slow"]
fn answers_are_those_of_the_command_line() {
    let served = Served::start(&["--threads", "2"]);
    let ask = |lane: &str, question: &str| {
        let reply = served.post(&format!("{}1/answer?lane={lane}&sequence=1", served.page), question.as_bytes());
        assert_eq!((reply.status, reply.field("content-type")), (200, Some("application/json; charset=utf-8")));
        serde_json::from_str::<Value>(&reply.body).unwrap()
    };
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(concat!(env!("PROJECT"), "/models/damped-light.toml")).unwrap();
    std::fs::write(folder.path().join("my.toml"), &text).unwrap();
    let model = json!({ "file": "my.toml", "text": text, "set": { "follower.restitution": 0.75 } });
    let printed = |answer: &Value| {
        let command = answer["command"].as_str().unwrap().strip_prefix("corner-impact ").unwrap();
        assert!(command.contains(" my.toml --set follower.restitution=0.75"), "{command}");
        let run = common::program(command.split(' ')).current_dir(folder.path()).output().unwrap();
        assert_eq!(run.status.code(), Some(0), "{command}: {}", common::text(run.stderr));
        common::text(run.stdout)
    };
    for (view, fields) in [
        ("orbit", json!({ "rpm": 680 })),
        ("verify", json!({})),
        ("design", json!({ "count": 5 })),
        ("speeds", json!({ "over": { "name": "rpm", "low": 690, "high": 700, "count": 5 }, "starts": 4 })),
    ] {
        let mut asked: Value = serde_json::from_str(&question(view, &fields)).unwrap();
        asked["model"] = model.clone();
        let answer = ask(view, &asked.to_string());
        assert_eq!(answer["view"], view, "{answer}");
        let document: Value = serde_json::from_str(&printed(&answer)).unwrap();
        let said = answer["found"].as_object().unwrap();
        assert!(said.len() > 3, "{answer}");
        for (name, value) in said {
            assert_eq!(&document[name], value, "{view}: {name}");
        }
    }
    let mut asked: Value = serde_json::from_str(&question(
        "diagram",
        &json!({ "over": { "name": "rpm", "low": 180, "high": 190, "count": 7 }, "transient": 50, "record": 10 }),
    ))
    .unwrap();
    asked["model"] = model.clone();
    let answer = ask("diagram", &asked.to_string());
    printed(&answer);
    let table = std::fs::read_to_string(folder.path().join("diagram.csv")).unwrap();
    let mut lines = table.lines();
    let place = lines.next().unwrap().split(',').position(|name| name == "cam_angle_rad").unwrap();
    let impacts = lines.filter(|line| line.contains(",impact,"));
    let angles: Vec<f64> = impacts.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect();
    let found = answer["found"]["cam_angle_rad"].as_array().unwrap();
    assert!(angles.len() > 70 && angles.len() == found.len(), "{} {}", angles.len(), found.len());
    assert!(angles.iter().zip(found).all(|(written, found)| Some(*written) == found.as_f64()));

    // A model that cannot be run has the program's sentence.
    std::fs::write(folder.path().join("my.toml"), text.replace("[follower]", "[folower]")).unwrap();
    let refused = common::program(["cam", "my.toml"]).current_dir(folder.path()).output().unwrap();
    let said = common::text(refused.stderr);
    asked["model"]["text"] = text.replace("[follower]", "[folower]").into();
    let answer = ask("refused", &asked.to_string());
    let sentence = answer["error"]["sentence"].as_str().unwrap();
    assert_eq!(said.lines().next(), Some(format!("error: {sentence}").as_str()), "{answer}");
    for nonsense in ["", "{}", "[]", "null", "{\"view\": \"none\"}", "\u{0}"] {
        assert!(ask("nonsense", nonsense)["error"]["sentence"].as_str().is_some_and(|words| !words.is_empty()));
    }
    let refused = common::program(["explore", "my.toml", "--no-open"]).current_dir(folder.path()).output().unwrap();
    assert_eq!((refused.status.code(), common::text(refused.stderr)), (Some(2), said));
}

/// A hundred questions of a moving slider: the last is answered, and the work on each other one ends.
#[test]
#[ignore = "slow"]
fn a_newer_question_stops_the_older_ones() {
    let served = Served::start(&[]);
    let page = served.page.clone();
    let ask = |lane: &str, sequence: u64, question: &str| {
        let path = format!("{page}{lane}&sequence={sequence}");
        served.begin("POST", &path, question.as_bytes())
    };
    let quick = question("template", &json!({ "law": "harmonic" }));
    let mut other = ask("answer?lane=other", 7, &endless());
    let mut of_other_page = ask("2/answer?lane=slider", 1_000, &endless());
    std::thread::sleep(Duration::from_millis(100));
    let mut older: Vec<TcpStream> = Vec::new();
    for sequence in 1..=100 {
        older.push(ask("answer?lane=slider", sequence, &endless()));
        std::thread::sleep(Duration::from_millis(5));
    }
    // Where the last but one is refused, the last has come.
    assert_eq!(status_of(&mut older.remove(98)), Some(409));
    // An older one that comes late is of no use.
    assert_eq!(status_of(&mut ask("answer?lane=slider", 99, &quick)), Some(409));
    let begun = Instant::now();
    assert_eq!(status_of(&mut ask("answer?lane=slider", 101, &quick)), Some(200));
    for older in &mut older {
        assert_eq!(status_of(older), Some(409));
    }
    assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
    // Where nothing is being worked on, a page may begin again.
    assert_eq!(status_of(&mut ask("answer?lane=slider", 1, &quick)), Some(200));
    // Another lane, and the same lane of another page, go on, until somebody asks there.
    for waiting in [&other, &of_other_page] {
        waiting.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
        assert!(waiting.peek(&mut [0]).is_err(), "it has ended");
        waiting.set_read_timeout(Some(common::PATIENCE)).unwrap();
    }
    assert_eq!(status_of(&mut ask("answer?lane=other", 8, &quick)), Some(200));
    assert_eq!(status_of(&mut other), Some(409));
    assert_eq!(status_of(&mut ask("2/answer?lane=slider", 1_001, &quick)), Some(200));
    assert_eq!(status_of(&mut of_other_page), Some(409));
}

/// Work that takes too long is answered by a sentence. Work that nobody waits for ends.
#[test]
#[ignore = "slow"]
fn work_has_an_end() {
    let served = Served::start(&["--hurried", "60"]);
    let answer = format!("{}answer?lane=a&sequence=1", served.page);
    let late = served.post(&answer, endless().as_bytes());
    assert_eq!(late.status, 200);
    let said: Value = serde_json::from_str(&late.body).unwrap();
    assert_eq!(said["view"], "diagram", "{said}");
    assert!(said["error"]["sentence"].as_str().unwrap().contains("longer than 1 s"), "{said}");
    drop(served);

    let served = Served::start(&["--threads", "1"]);
    let idle = served.idle();
    let left = served.begin("POST", &format!("{}answer?lane=a&sequence=1", served.page), endless().as_bytes());
    // Its connection, the question, and as many threads as were asked for, twice where the question starts its own.
    common::until("the work begins", || served.threads() >= idle + 3);
    for _ in 0..100 {
        assert!(served.threads() <= idle + 4, "{} and {idle}", served.threads());
        std::thread::sleep(Duration::from_millis(2));
    }
    drop(left);
    common::until("the work ends", || served.threads() <= idle);
}

#[test]
#[ignore = "slow"]
fn it_ends_with_the_page() {
    // A minute is a second here, and ten minutes are ten seconds.
    let served = Served::start(&["--hurried", "60"]);
    let begun = Instant::now();
    let (status, _, said) = served.end();
    assert_eq!(status.code(), Some(0));
    assert!(said.contains("nobody opened the page within ten minutes"), "{said}");
    assert!(begun.elapsed() > Duration::from_secs(9), "{:?}", begun.elapsed());

    let served = Served::start(&["--hurried", "60"]);
    assert_eq!(served.get(&served.page).status, 200);
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(4) {
        let asked = Instant::now();
        let alive = served.get(&format!("{}1/alive", served.page));
        assert_eq!(alive.status, 200);
        assert!(asked.elapsed() > Duration::from_millis(300), "it is answered after a while: {:?}", asked.elapsed());
    }
    // A page that is closed in the middle.
    drop(served.begin("GET", &format!("{}1/alive", served.page), &[]));
    let closed = Instant::now();
    let (status, _, said) = served.end();
    assert_eq!(status.code(), Some(0));
    assert!(said.contains("the page has been closed for a minute"), "{said}");
    assert!(closed.elapsed() > Duration::from_millis(900) && closed.elapsed() < Duration::from_secs(8), "{closed:?}");
}

#[test]
#[ignore = "slow"]
fn ctrl_c_ends_it_at_once() {
    for is_working in [false, true] {
        let served = Served::start(&["--hurried", "60"]);
        let path = format!("{}answer?lane=a&sequence=1", served.page);
        let _asked = is_working.then(|| served.begin("POST", &path, endless().as_bytes()));
        std::thread::sleep(Duration::from_millis(200));
        let begun = Instant::now();
        assert!(Command::new("kill").args(["-INT", &served.id()]).status().unwrap().success());
        let (status, _, _) = served.end();
        assert_eq!(status.signal(), Some(SIGINT));
        assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    }
}

#[test]
fn two_servers_are_two() {
    let (one, other) = (Served::start(&[]), Served::start(&["models/damped-light.toml"]));
    assert_ne!(one.address, other.address);
    assert_ne!(one.page, other.page);
    for (served, foreign) in [(&one, &other), (&other, &one)] {
        assert_eq!(served.get(&served.page).status, 200);
        assert_eq!(served.get(&foreign.page).status, 404);
    }
}

#[test]
fn a_port_may_be_chosen_if_it_is_free() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let refused = common::corner_impact(["explore", "--no-open", "--hurried", "600", "--port", &port]);
    let said = common::text(refused.stderr);
    assert_eq!((refused.status.code(), refused.stdout.as_slice()), (Some(2), &[][..]), "{said}");
    assert!(said.contains(&format!("error: --port {port}: no page can be served: Address already in use")), "{said}");
    drop(taken);
    let served = Served::start(&["--port", &port]);
    assert_eq!(served.address.port().to_string(), port);
    for wrong in ["0", "65536", "-1", "http"] {
        assert_eq!(common::corner_impact(["explore", "--no-open", "--port", wrong]).status.code(), Some(2), "{wrong}");
    }
}

/// The browser is led to the page by an address that works once: other users can read its command line.
#[test]
fn the_browser_is_opened_without_the_token() {
    let folder = tempfile::tempdir().unwrap();
    let (browser, seen) = (folder.path().join("xdg-open"), folder.path().join("seen"));
    std::fs::write(&browser, format!("#!/bin/sh\necho \"$1\" > {0}.part; mv {0}.part {0}\n", seen.display())).unwrap();
    std::fs::set_permissions(&browser, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let served = Served::with(&[], |command| {
        command.env("PATH", path);
    });
    common::until("the browser is opened", || seen.exists());
    let address = std::fs::read_to_string(&seen).unwrap();
    let first = address.trim().strip_prefix(&format!("http://{}", served.address)).unwrap();
    assert!(first.len() >= 22 && !address.contains(served.page.trim_matches('/')), "{address}");
    let own = ("Host", served.address.to_string());
    assert_eq!(served.send("GET", first, &[("Host", "evil.example".into())], &[]).status, 403);
    let led = served.send("GET", first, std::slice::from_ref(&own), &[]);
    assert_eq!((led.status, led.field("location")), (303, Some(served.page.as_str())));
    assert_eq!(served.send("GET", first, std::slice::from_ref(&own), &[]).status, 404);
}

/// All that the page does works under the policy that it is served with, in a real browser.
#[test]
#[ignore = "slow"]
fn a_browser_shows_the_page_without_a_complaint() {
    let served = Served::start(&["--hurried", "10"]);
    let root = format!("http://{}{}", served.address, served.page);
    let Some(mut page) = Page::visit(&root) else { return };
    let answers = "performance.getEntriesByType('resource').filter((each) => each.name.includes('/answer?') && each.responseStatus === 200).length";
    page.until(&format!("{answers} >= 5"));
    assert!(page.value("document.querySelectorAll('#explore canvas').length").as_u64().unwrap() >= 3);
    assert_eq!(page.complaints(), Vec::<String>::new());
    let outside = page.requests().into_iter().filter(|url| !url.starts_with(&root) && !url.starts_with("data:"));
    assert_eq!(outside.collect::<Vec<_>>(), Vec::<String>::new());
    // A script from elsewhere does not run.
    page.value(
        "document.body.append(Object.assign(document.createElement('script'), { textContent: 'window.foreign = 1' }))",
    );
    assert_eq!(page.value("window.foreign === undefined"), true);
    // The page is open, whether or not it asks.
    std::thread::sleep(Duration::from_secs(8));
    assert_eq!(served.get("/").status, 404);
    drop(page);
    let (status, _, said) = served.end();
    assert!(status.code() == Some(0) && said.contains("closed for a minute"), "{said}");
}
