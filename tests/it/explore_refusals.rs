//! Does the server of the live page refuse everybody but its own page, and all that is too large, too many or too slow?

#![cfg(target_os = "linux")]

use std::collections::VecDeque;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use serde_json::json;

use crate::common;
use crate::explore_server::client::{Reply, Served, question};

#[test]
fn only_its_own_page_is_answered() {
    let served = Served::start(&[]);
    let (port, page) = (served.address.port(), served.page.clone());
    let quick = question("template", &json!({ "law": "harmonic" }));
    let answer = format!("{page}answer?lane=a&sequence=1");
    let own = [("Host", format!("127.0.0.1:{port}")), ("Host", format!("localhost:{port}"))];
    for host in own {
        let origin = ("Origin", format!("http://{}", host.1));
        let same = ("Sec-Fetch-Site", "same-origin".to_owned());
        for fields in [vec![host.clone()], vec![host.clone(), origin, same]] {
            assert_eq!(served.send("POST", &answer, &fields, quick.as_bytes()).status, 200, "{fields:?}");
        }
    }

    let own = ("Host", format!("127.0.0.1:{port}"));
    let foreign = [
        vec![("Host", format!("evil.example:{port}"))],
        vec![("Host", "127.0.0.1".to_owned())],
        vec![("Host", format!("127.0.0.1:{}", port ^ 1))],
        vec![("Host", format!("127.0.0.1.evil.example:{port}"))],
        vec![("X-Forwarded-Host", format!("127.0.0.1:{port}"))],
        vec![own.clone(), ("Origin", "https://evil.example".to_owned())],
        vec![own.clone(), ("Origin", format!("http://127.0.0.1:{}", port ^ 1))],
        vec![own.clone(), ("Origin", format!("https://127.0.0.1:{port}"))],
        vec![own.clone(), ("Origin", format!("http://localhost:{port}"))],
        vec![own.clone(), ("Origin", "null".to_owned())],
        vec![own.clone(), ("Origin", "null".to_owned()), ("Sec-Fetch-Site", "cross-site".to_owned())],
        vec![own.clone(), ("Sec-Fetch-Site", "cross-site".to_owned())],
        vec![own.clone(), ("Sec-Fetch-Site", "same-site".to_owned())],
        vec![own.clone(), ("Sec-Fetch-Site", "cross-site".to_owned()), ("Sec-Fetch-Dest", "iframe".to_owned())],
    ];
    for fields in &foreign {
        assert_eq!(served.send("POST", &answer, fields, quick.as_bytes()).status, 403, "{fields:?}");
        assert_eq!(served.send("GET", &page, fields, &[]).status, 403, "{fields:?}");
    }
    // A link may lead to the page, but to nothing else.
    let followed = [own.clone(), ("Sec-Fetch-Site", "cross-site".into()), ("Sec-Fetch-Dest", "document".into())];
    assert_eq!(served.send("GET", &page, &followed, &[]).status, 200);
    assert_eq!(served.send("POST", &answer, &followed, quick.as_bytes()).status, 403);
    // Which of two is meant is not guessed.
    let twice = [own.clone(), ("Host", "evil.example".to_owned())];
    assert_eq!(served.send("GET", &page, &twice, &[]).status, 400);

    for (method, path) in [("POST", &page), ("HEAD", &page), ("GET", &answer), ("OPTIONS", &answer), ("PUT", &answer)] {
        let refused = served.send(method, path, std::slice::from_ref(&own), b"");
        assert_eq!(refused.status, 405, "{method} {path}");
        assert_eq!(refused.field("allow"), Some(if *path == page { "GET" } else { "POST" }), "{method} {path}");
        assert_eq!(refused.field("access-control-allow-origin"), None);
    }
}

/// Whoever has no token learns nothing: not what there is, nor that a method or an origin is wrong.
#[test]
fn a_wrong_token_says_nothing() {
    let served = Served::start(&[]);
    let token = served.page.trim_matches('/').to_owned();
    assert!(token.len() >= 22, "128 bits or more: {token}");
    let letter = if token.ends_with('A') { 'B' } else { 'A' };
    let wrong = [
        "/".to_owned(),
        "/favicon.ico".into(),
        "/alive".into(),
        "/answer?lane=a&sequence=1".into(),
        format!("/{}{letter}/", &token[..token.len() - 1]),
        format!("/{}/", &token[1..]),
        format!("/{token}{letter}/"),
        format!("//{token}/"),
        format!("/{}/", token.to_lowercase()),
        format!("/x/../{token}/"),
        format!("/?{token}"),
        format!("http://{}/{token}/", served.address),
        "*".into(),
    ];
    let own = ("Host", format!("127.0.0.1:{}", served.address.port()));
    let other = ("Host", "evil.example".to_owned());
    let nothing = served.send("GET", "/x", std::slice::from_ref(&own), &[]);
    for path in &wrong {
        for (method, host) in [("GET", &own), ("POST", &own), ("GET", &other), ("BREW", &other)] {
            let refused = served.send(method, path, std::slice::from_ref(host), &[]);
            assert_eq!((refused.status, refused.body.as_str()), (404, ""), "{method} {path}");
            assert_eq!(refused.head, nothing.head, "{method} {path}");
        }
    }
    for path in ["x", "answers?lane=a&sequence=1", "1/2/alive", "../"] {
        assert_eq!(served.get(&format!("{}{path}", served.page)).status, 404, "{path}");
    }
    // Nothing else of this machine leads there.
    assert!(TcpStream::connect(SocketAddr::from(([127, 0, 0, 2], served.address.port()))).is_err());
}

#[test]
fn the_page_may_load_nothing_from_elsewhere() {
    let served = Served::start(&[]);
    let page = served.get(&served.page);
    assert_eq!(page.status, 200);
    let policy = page.field("content-security-policy").unwrap();
    let nonce = policy.split("script-src 'nonce-").nth(1).unwrap().split('\'').next().unwrap();
    assert!(nonce.len() >= 22 && page.body.contains(nonce), "{policy}");
    for part in ["default-src 'none'", "connect-src 'self'", "worker-src blob:", "frame-ancestors 'none'"] {
        assert!(policy.contains(part), "{part} in {policy}");
    }
    assert!(!policy.contains("unsafe"), "{policy}");
    assert!(!page.body.contains("<script src") && !page.body.contains("stylesheet"), "it is one file");
    for (name, value) in [
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cache-control", "no-store"),
        ("content-type", "text/html; charset=utf-8"),
    ] {
        assert_eq!(page.field(name), Some(value));
    }
    // Another load is another page, with a word of its own.
    let again = served.get(&served.page);
    assert_ne!(again.field("content-security-policy").unwrap(), policy);
    assert_ne!(again.body, page.body);
    assert_eq!(served.get(served.page.trim_end_matches('/')).status, 200, "an address without its last stroke");
}

#[test]
fn large_and_malformed_requests_are_refused_unread() {
    let served = Served::start(&[]);
    let answer = format!("{}answer?lane=a&sequence=1", served.page);
    let host = format!("Host: 127.0.0.1:{}", served.address.port());
    let large = vec![b' '; 100_000_000];
    let refused = served.post(&answer, &large);
    assert_eq!(refused.status, 413);
    assert!(served.kilobytes("VmHWM") < 100_000, "the body was kept: {} kB", served.kilobytes("VmHWM"));
    // The largest that is read has no meaning, but an answer.
    let blank = vec![b' '; 4 << 20];
    assert_eq!(served.post(&answer, &blank).status, 200);
    for (status, head) in [
        (413, format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: {}\r\n\r\n", (4 << 20) + 1)),
        (413, format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: {}\r\n\r\n", u64::MAX)),
        (411, format!("POST {answer} HTTP/1.1\r\n{host}\r\n\r\n")),
        (411, format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: -1\r\n\r\n")),
        (411, format!("POST {answer} HTTP/1.1\r\n{host}\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{{}}\r\n0\r\n\r\n")),
        (
            411,
            format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n{{}}"),
        ),
        (400, format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\nContent-Length: 3\r\n\r\n{{}} ")),
        (400, format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\n\r\n{{}}GET /")),
        (
            400,
            format!("POST {}answer?lane=&sequence=1 HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\n\r\n{{}}", served.page),
        ),
        (400, format!("POST {}answer?lane=a HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\n\r\n{{}}", served.page)),
        (
            400,
            format!(
                "POST {}answer?lane=a&sequence=-1 HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\n\r\n{{}}",
                served.page
            ),
        ),
        (431, format!("GET {} HTTP/1.1\r\n{host}\r\nX: {}\r\n\r\n", served.page, "x".repeat(1_000_000))),
        (431, format!("GET /{} HTTP/1.1\r\n{host}\r\n\r\n", "x".repeat(1_000_000))),
        (431, format!("GET {} HTTP/1.1\r\n{host}\r\n{}\r\n", served.page, "X: y\r\n".repeat(100))),
        (400, format!("GET {} HTTP/2.0\r\n{host}\r\n\r\n", served.page)),
        (400, format!("GET {} HTTP/1.1\r\n{host}\r\n X: folded\r\n\r\n", served.page)),
        (400, "\u{16}\u{3}\u{1}\u{2}\0\u{1}\0\u{1}\u{fc}\u{3}\u{3}".to_owned()),
    ] {
        let shown: String = head.chars().take(120).collect();
        assert_eq!(served.raw(head.as_bytes()).status, status, "{shown:?}");
    }
    let odd = format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\n\r\n");
    assert_eq!(served.raw(&[odd.as_bytes(), b"\xff\xfe"].concat()).status, 400);
    assert!(served.kilobytes("VmHWM") < 100_000);
    // Programs may wait to be told to go on.
    let mut waiting = served.connect();
    let head = format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n");
    waiting.write_all(head.as_bytes()).unwrap();
    let mut told = [0; 25];
    waiting.read_exact(&mut told).unwrap();
    assert_eq!(&told, b"HTTP/1.1 100 Continue\r\n\r\n");
    waiting.write_all(b"{}").unwrap();
    assert_eq!(Reply::read(&mut waiting).unwrap().status, 200);
}

/// Connections that say nothing, or speak slowly, keep no page from its answers, and are closed after a while.
#[test]
#[ignore = "slow"]
fn a_crowd_and_slow_clients_stop_nobody() {
    let served = Served::start(&["--hurried", "5"]);
    let quick = question("template", &json!({ "law": "harmonic" }));
    let answer = format!("{}answer?lane=a&sequence=1", served.page);
    let open_before = served.sockets();
    let mut crowd = VecDeque::new();
    for _ in 0..1000 {
        crowd.push_back(served.connect());
        if crowd.len() > 200 {
            // Closed by the server to make room: this process may have few files open.
            let mut said = String::new();
            let _ = crowd.pop_front().unwrap().read_to_string(&mut said);
            assert!(said.is_empty() || said.starts_with("HTTP/1.1 503 "), "{said}");
        }
    }
    assert_eq!(served.post(&answer, quick.as_bytes()).status, 200);
    // A thread that has given its place back may take a moment to end.
    common::until("there are few threads", || served.threads() < 150);
    // With no more than a line each.
    for mut silent in &crowd {
        let _ = silent.write_all(b"GET / HTTP/1.1\r\n");
    }
    assert_eq!(served.post(&answer, quick.as_bytes()).status, 200);
    drop(crowd);

    // A head, a body and a reader that take for ever.
    let begun = Instant::now();
    let slow = |text: String| {
        let mut slow = served.connect();
        std::thread::spawn(move || {
            for letter in text.bytes().chain(std::iter::repeat(b'x')) {
                if slow.write_all(&[letter]).is_err() {
                    break;
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        })
    };
    let host = format!("Host: 127.0.0.1:{}", served.address.port());
    let slow = [slow(format!("GET /x HTTP/1.1\r\n{host}\r\nX: ")), {
        let head = format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 1000000\r\n\r\n");
        let mut slow = served.connect();
        slow.write_all(head.as_bytes()).unwrap();
        std::thread::spawn(move || {
            while slow.write_all(b" ").is_ok() {
                std::thread::sleep(Duration::from_millis(20));
            }
        })
    }];
    let deaf = served.connect();
    let long = format!("POST {answer} HTTP/1.1\r\n{host}\r\nContent-Length: 0\r\n\r\n");
    (&deaf).write_all(long.as_bytes()).unwrap();
    assert_eq!(served.post(&answer, quick.as_bytes()).status, 200);
    slow.into_iter().for_each(|slow| slow.join().unwrap());
    assert!(begun.elapsed() > Duration::from_secs(1) && begun.elapsed() < Duration::from_secs(20), "{begun:?}");
    common::until("the connections are closed", || served.sockets() == open_before);
}
