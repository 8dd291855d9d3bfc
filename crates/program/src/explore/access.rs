//! Access control: only requests of the page itself, from the browser that received the address.

use std::sync::{Mutex, MutexGuard, PoisonError};

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use subtle::ConstantTimeEq;

use super::reply::{self, Refused, Reply};
use super::request::Head;

/// Returns a random word that cannot be guessed: 192 bits, in letters that are valid in an address.
pub(super) fn secret() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 24];
    getrandom::fill(&mut bytes)?;
    Ok(BASE64_URL_SAFE_NO_PAD.encode(bytes))
}

/// Purpose of an accepted request.
#[derive(Debug)]
pub(super) enum Purpose {
    /// First visit: the opened browser asks for the address of the page.
    Ticket,
    Page,
    /// Long poll of an open page.
    Alive,
    /// Question; lanes of two pages are different lanes.
    Answer {
        page: String,
    },
}

/// Addresses to which the server responds, and the secrets in them.
pub(super) struct Access {
    /// Values of `Host` for this server.
    hosts: Vec<String>,
    token: String,
    /// Secret of the first visit, which is valid once. Other users of the machine can read the command line of a browser, so it must not
    /// contain the token.
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

    /// Path of the first visit; invalid after the visit.
    pub(super) fn first_visit(&self) -> String {
        format!("/{}", self.ticket().as_deref().unwrap_or_default())
    }

    fn ticket(&self) -> MutexGuard<'_, Option<String>> {
        self.ticket.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Determines the purpose of a request. Without the token, every request gets the same response.
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
            // If two come at once, only one is the first.
            self.ticket().take().ok_or_else(nothing)?;
        }
        Ok(purpose)
    }

    /// Rejects requests by another page. `Host` is another name if the name of another page leads here (DNS rebinding). `Origin` and
    /// `Sec-Fetch-Site` are written by the browser, and no script can change them. Another page may link to this one as a whole page,
    /// because it cannot see its contents.
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
            // Without a referrer, browsers may also omit the page's own origin.
            Some("null") if is_own_site => Ok(()),
            Some(_) => Err(foreign()),
        }
    }
}

/// Whether two secrets are equal, in a time independent of the position of a difference.
fn same(one: &str, other: &str) -> bool {
    one.as_bytes().ct_eq(other.as_bytes()).into()
}
