//! Head of a request, read within limits of size and time and parsed by httparse.

use std::io::{self, Read};

use super::reply::{self, Refused, Reply};

/// Largest head of a request, bytes. Browsers send less than a thousand.
const LARGEST_HEAD: usize = 16 * 1024;
/// Largest number of header fields of a request.
const MOST_FIELDS: usize = 64;

/// Head of a request.
#[derive(Debug)]
pub(super) struct Head {
    pub(super) method: String,
    /// Part of the target before the question mark.
    pub(super) path: String,
    /// Part of the target after the question mark.
    pub(super) query: String,
    /// Names and values of the header fields, in order.
    fields: Vec<(String, String)>,
    /// Bytes of the body that came together with the head.
    pub(super) begun: Vec<u8>,
}

impl Head {
    /// Reads a head, and no more of the body than arrives with it.
    pub(super) fn read(from: &mut impl Read) -> Result<Self, Refused> {
        let (mut read, mut part) = (Vec::new(), [0; 4096]);
        loop {
            match from.read(&mut part) {
                Ok(0) => return Err(None),
                Ok(count) => read.extend_from_slice(&part[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(late(&error)),
            }
            if let Some(head) = Self::parsed(&read)? {
                return Ok(head);
            }
            if read.len() > LARGEST_HEAD {
                return Err(Some(Reply::empty(reply::HEAD_TOO_LARGE)));
            }
        }
    }

    /// Parses a head; `None` while its end is missing.
    fn parsed(read: &[u8]) -> Result<Option<Self>, Refused> {
        let malformed = || Some(Reply::empty(reply::BAD_REQUEST));
        let mut fields = [httparse::EMPTY_HEADER; MOST_FIELDS];
        let mut request = httparse::Request::new(&mut fields);
        let length = match request.parse(read) {
            Ok(httparse::Status::Partial) => return Ok(None),
            Ok(httparse::Status::Complete(length)) => length,
            Err(httparse::Error::TooManyHeaders) => return Err(Some(Reply::empty(reply::HEAD_TOO_LARGE))),
            Err(_) => return Err(malformed()),
        };
        let target = request.path.unwrap_or_default();
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let field = |field: &httparse::Header<'_>| {
            let value = std::str::from_utf8(field.value).ok()?;
            Some((field.name.to_ascii_lowercase(), value.to_owned()))
        };
        Ok(Some(Self {
            method: request.method.unwrap_or_default().to_owned(),
            path: path.to_owned(),
            query: query.to_owned(),
            fields: request.headers.iter().map(field).collect::<Option<_>>().ok_or_else(malformed)?,
            begun: read[length..].to_vec(),
        }))
    }

    /// Value of a header field, by its name in lower case. A repeated field has no value: a proxy may have read the other one.
    pub(super) fn field(&self, name: &str) -> Result<Option<&str>, Refused> {
        let mut values = self.fields.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str());
        match (values.next(), values.next()) {
            (_, Some(_)) => Err(Some(Reply::empty(reply::BAD_REQUEST))),
            (value, None) => Ok(value),
        }
    }

    /// Value of a parameter of the query, as written.
    pub(super) fn parameter(&self, name: &str) -> Option<&str> {
        self.query
            .split('&')
            .filter_map(|pair| pair.split_once('='))
            .find(|(other, _)| *other == name)
            .map(|(_, value)| value)
    }
}

/// Response to a request that was too slow; `None` if its connection broke.
pub(super) fn late(error: &io::Error) -> Refused {
    let is_late = matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock);
    is_late.then(|| Reply::empty(reply::TIMEOUT))
}
