//! Requests that may come in: those of the page itself, from the browser that was given the address.

use std::sync::{Mutex, MutexGuard, PoisonError};

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use subtle::ConstantTimeEq;

use super::reply::{self, Refused, Reply};
use super::request::Head;

/// Returns a random word that nobody guesses: 192 bits, in letters that an address may have.
pub(super) fn secret() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 24];
    getrandom::fill(&mut bytes)?;
    Ok(BASE64_URL_SAFE_NO_PAD.encode(bytes))
}

/// Purpose of a request that may come in.
#[derive(Debug)]
pub(super) enum Purpose {
    /// The browser that the program opened asks where the page is.
    Ticket,
    Page,
    /// The long poll of a page that is open.
    Alive,
    /// A question. Lanes of two pages are different lanes.
    Answer {
        page: String,
    },
}

/// Addresses that the server answers to, and the secrets in them.
pub(super) struct Access {
    /// Values of `Host` for this server.
    hosts: Vec<String>,
    token: String,
    /// Secret of the first visit, which opens the access once. The command line of a browser can be read by other users of the machine, and
    /// the token should not be there.
    ticket: Mutex<Option<String>>,
}

impl Access {
    pub(super) fn new(port: u16) -> Result<Self, getrandom::Error> {
        let names = ["127.0.0.1", "localhost"];
        let mut hosts: Vec<String> = names.iter().map(|name| format!("{name}:{port}")).collect();
        if port == 80 {
            // Browsers leave out the port of plain HTTP.
            hosts.extend(names.map(str::to_owned));
        }
        Ok(Self { hosts, token: secret()?, ticket: Mutex::new(Some(secret()?)) })
    }

    /// Path of the page.
    pub(super) fn page(&self) -> String {
        format!("/{}/", self.token)
    }

    /// Path of the first visit; that of nothing once the visit has been made.
    pub(super) fn first_visit(&self) -> String {
        format!("/{}", self.ticket().as_deref().unwrap_or_default())
    }

    fn ticket(&self) -> MutexGuard<'_, Option<String>> {
        self.ticket.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Decides what a request is for. Without the token, every request is answered alike.
    pub(super) fn judge(&self, head: &Head) -> Result<Purpose, Refused> {
        let nothing = || Some(Reply::empty(reply::NOT_FOUND));
        let path = head.path.strip_prefix('/').ok_or_else(nothing)?;
        let (secret, rest) = path.split_once('/').unwrap_or((path, ""));
        let has_ticket = rest.is_empty() && self.ticket().as_ref().is_some_and(|ticket| same(secret, ticket));
        if !has_ticket && !same(secret, &self.token) {
            return Err(nothing());
        }
        let purpose = match rest.split('/').collect::<Vec<_>>().as_slice() {
            _ if has_ticket => Purpose::Ticket,
            [""] => Purpose::Page,
            ["alive"] | [_, "alive"] => Purpose::Alive,
            ["answer"] => Purpose::Answer { page: String::new() },
            [page, "answer"] => Purpose::Answer { page: (*page).to_owned() },
            _ => return Err(nothing()),
        };
        let opens_page = matches!(purpose, Purpose::Ticket | Purpose::Page);
        self.is_own(head, opens_page)?;
        let method = if matches!(purpose, Purpose::Answer { .. }) { "POST" } else { "GET" };
        if head.method != method {
            return Err(Some(Reply::empty(reply::METHOD_NOT_ALLOWED).with("Allow", method)));
        }
        if has_ticket {
            // Of two that come at once, one is the first.
            self.ticket().take().ok_or_else(nothing)?;
        }
        Ok(purpose)
    }

    /// Refuses requests that another page makes. `Host` is a name that somebody else's page has where that name leads here (DNS rebinding).
    /// `Origin` and `Sec-Fetch-Site` are written by the browser, and no script can change them. Another page may lead to this one by a link,
    /// as a whole page of its own, because it sees nothing of it.
    fn is_own(&self, head: &Head, opens_page: bool) -> Result<(), Refused> {
        let foreign = || Some(Reply::sentence(reply::FORBIDDEN, "This server answers its own page, and no other."));
        let host = head.field("host")?.unwrap_or_default().to_ascii_lowercase();
        if !self.hosts.contains(&host) {
            return Err(foreign());
        }
        let site = head.field("sec-fetch-site")?;
        let is_own_site = site == Some("same-origin");
        let is_followed = opens_page && head.field("sec-fetch-dest")? == Some("document");
        if !(site.is_none_or(|site| site == "none") || is_own_site || is_followed) {
            return Err(foreign());
        }
        match head.field("origin")? {
            None => Ok(()),
            Some(origin) if origin.strip_prefix("http://") == Some(&host) => Ok(()),
            // Where no referrer is sent, browsers may leave out the page's own origin as well.
            Some("null") if is_own_site => Ok(()),
            Some(_) => Err(foreign()),
        }
    }
}

/// Whether two secrets are the same, in a time that says nothing about where they differ.
fn same(one: &str, other: &str) -> bool {
    one.as_bytes().ct_eq(other.as_bytes()).into()
}
