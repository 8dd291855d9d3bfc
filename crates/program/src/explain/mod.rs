//! Explanation of a name: a number, an equation's label, a claim, a tolerance or a column, with its formula, proof and test.
//!
//! The file `links.toml` states where each is evaluated, derived and tested; values are read from the documents of results.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::report::quantities::{ReportQuantity, quantities};
use corner_impact::cam::{Cam, Side};
use corner_impact::corner::map::RouteName;
use corner_impact::known::Evidence;
use corner_impact::model::{Model, ModelError, Units, nearest};
use corner_impact::paper::checks::{self, Check};
use corner_impact::paper::{Claim, Context, LedgerError, ledger, proofs};
use corner_impact::study::certify::Certificate;
use corner_impact::study::compare::{self, NamedValues};
use corner_impact::study::routes::Skipped;
use corner_impact::study::verify::{External, Verification};
use corner_impact::tolerance::{self, Tolerance};

const LINKS: &str = include_str!("links.toml");

/// Explanation of a name; serializes to the document of `explain`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    schema: &'static str,
    /// The name.
    pub what: String,
    /// Meaning of the name, in a sentence.
    pub sentence: String,
    /// Formula of its value.
    pub formula: Option<String>,
    /// Label of the formula in the paper.
    pub label: Option<String>,
    /// Other names with the same label, if a label was looked up.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// Inputs of the formula, with their values for the model.
    pub inputs: Vec<Input>,
    /// Value for the model, as in documents; `None` if nothing was run, or if it does not belong to a single corner impact.
    pub value: Option<Value>,
    /// Value by each route that computes it.
    pub routes: BTreeMap<String, Value>,
    /// Routes without a value, because they were left out or failed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skipped: Vec<Skipped>,
    /// Kind of knowledge: proved, computed or otherwise.
    pub known: Evidence,
    /// Hypotheses of the proof of the value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hypotheses: Vec<String>,
    /// Result of the check, for a statement of the paper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<String>,
    /// Function that evaluates it.
    pub code: Option<Code>,
    /// Derivation that proves it.
    pub derivation: Option<Derivation>,
    /// Tests that check it.
    pub tests: Vec<Test>,
    /// Place in the paper.
    pub paper: Option<String>,
}

impl Explanation {
    fn plain(what: &str, sentence: &str, known: Evidence) -> Self {
        Self {
            schema: "corner-impact/explain/1",
            what: what.into(),
            sentence: sentence.into(),
            formula: None,
            label: None,
            also: Vec::new(),
            inputs: Vec::new(),
            value: None,
            routes: BTreeMap::new(),
            skipped: Vec::new(),
            known,
            hypotheses: Vec::new(),
            evidence: None,
            code: None,
            derivation: None,
            tests: Vec::new(),
            paper: None,
        }
    }
}

/// Input of a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Input {
    /// Name of a field of the model, or a name that can be explained.
    pub name: String,
    /// Value of the input.
    pub value: Option<Value>,
}

/// Reference to a function of this program.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Code {
    pub file: String,
    pub function: String,
}

/// Reference to a statement that a script proves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Derivation {
    pub script: String,
    pub statement: String,
}

/// Reference to a test.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Test {
    pub file: String,
    pub test: String,
}

/// Reason why there is no explanation.
#[derive(Debug, thiserror::Error)]
pub enum ExplainError {
    /// Unknown name.
    #[error("unknown name \"{what}\"{} (`explain --list` lists every name)", hint(.meant))]
    Unknown {
        /// The name that was looked up.
        what: String,
        /// Nearest known name.
        meant: Option<String>,
    },
    /// The table `links.toml` is not valid.
    #[error("links.toml: {0}")]
    Unreadable(#[from] toml::de::Error),
    /// The ledger is not valid.
    #[error(transparent)]
    Ledger(#[from] LedgerError),
    /// The cam cannot be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The results cannot be written as a document.
    #[error("document: {0}")]
    Document(#[from] serde_json::Error),
}

fn hint(meant: &Option<String>) -> String {
    meant.as_ref().map_or_else(String::new, |meant| format!("; did you mean {meant}?"))
}

/// A row of the table `links.toml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Link {
    name: String,
    /// Whether there is one number for each side of the corner.
    #[serde(default)]
    sides: bool,
    #[serde(default)]
    also: Vec<String>,
    #[serde(default)]
    starts: Vec<String>,
    sentence: String,
    formula: Option<String>,
    #[serde(default)]
    labels: Vec<String>,
    #[serde(default)]
    inputs: Vec<String>,
    value: Option<String>,
    routes: Option<String>,
    orbits: Option<String>,
    known: Evidence,
    code: String,
    derivation: Option<String>,
    tests: Vec<String>,
    paper: Option<String>,
}

#[derive(Deserialize)]
struct Table {
    link: Vec<Link>,
}

/// The table of links, with the claims and proofs.
pub struct Links {
    table: Vec<Link>,
    claims: Vec<Claim>,
    /// Proofs by the labels of printed equations and by statement: the script, and the statement.
    proofs: BTreeMap<String, [String; 2]>,
}

/// Object that a name refers to.
enum Target<'a> {
    Link(&'a Link, Option<Side>),
    Tolerance(&'static Tolerance),
    Claim(&'a Claim),
    Field(ReportQuantity),
}

/// Results for a model, from which values are read.
pub struct Findings<'a> {
    model: &'a Model,
    found: Option<&'a Verification>,
    cam: Cam,
    document: Value,
    /// Values by the names of `compare`.
    values: NamedValues,
}

impl<'a> Findings<'a> {
    /// Results of a model alone, or with its verified corner impact.
    pub fn new(model: &'a Model, found: Option<&'a Verification>) -> Result<Self, ExplainError> {
        let cam = Cam::new(model)?;
        let values = compare::values(model, &cam, found);
        let document = found.map(serde_json::to_value).transpose()?.unwrap_or_default();
        Ok(Self { model, found, cam, document, values })
    }
}

impl Links {
    /// Reads the table and the ledger.
    pub fn read() -> Result<Self, ExplainError> {
        let table: Table = toml::from_str(LINKS)?;
        Ok(Self { table: table.link, claims: ledger::claims()?, proofs: proofs()? })
    }

    /// All names, each with a sentence on its meaning, grouped by kind.
    pub fn names(&self) -> Vec<(String, String)> {
        let sided = |link: &Link| match link.sides {
            true => [Side::Minus, Side::Plus].map(|side| format!("{}_{side}", link.name)).into(),
            false => vec![link.name.clone()],
        };
        let links = self.table.iter().flat_map(|link| {
            let all = sided(link).into_iter().chain(link.labels.iter().chain(&link.also).cloned());
            all.map(|name| (name, link.sentence.replace(['{', '}'], ""))).collect::<Vec<_>>()
        });
        let tolerances = tolerance::TABLE.iter().map(|row| (row.name.to_owned(), row.reason.to_owned()));
        let claims = self.claims.iter().map(|claim| (claim.id.clone(), claim.statement.clone()));
        links.chain(tolerances).chain(claims).collect()
    }

    /// Finds the object of a name. The name may be:
    ///
    /// - a number, with or without its side or its entry's indices,
    /// - a label, a tolerance, or a field of the model,
    /// - a claim's id, with or without its kind,
    /// - a name of `compare`, recognized by its beginning.
    fn find(&self, what: &str, model: &Model) -> Result<Target<'_>, ExplainError> {
        let side = [("_minus", Side::Minus), ("_plus", Side::Plus), ("-", Side::Minus), ("+", Side::Plus)]
            .into_iter()
            .find_map(|(end, side)| Some((what.strip_suffix(end)?, side)));
        let link = self.table.iter().find_map(|link| {
            let named = |name: &str| link.name == name || link.also.iter().any(|also| also == name);
            match side {
                Some((name, side)) if link.sides && named(name) => Some(Target::Link(link, Some(side))),
                _ if named(what) => Some(Target::Link(link, link.sides.then_some(Side::Minus))),
                _ => None,
            }
        });
        // The equation with this label, or else an intermediate step.
        let by_label = || {
            let place = |link: &Link| link.labels.iter().position(|label| label == what);
            let links = self.table.iter().filter_map(|link| Some((place(link)?, link)));
            links.min_by_key(|(place, _)| *place).map(|(_, link)| Target::Link(link, link.sides.then_some(Side::Minus)))
        };
        let tolerance =
            || tolerance::TABLE.iter().find(|row| row.name.eq_ignore_ascii_case(what)).map(Target::Tolerance);
        let is_claim = |claim: &&Claim| claim.id == what || claim.id.split_once(": ").is_some_and(|(_, id)| id == what);
        let claim = || self.claims.iter().find(is_claim).map(Target::Claim);
        // The short name of a field is allowed too, as for `--set`.
        let path = model.path_of(what, &[]).unwrap_or(what);
        let field = || quantities(model).into_iter().find(|it| it.field == path).map(Target::Field);
        let found = link.or_else(by_label).or_else(tolerance).or_else(claim).or_else(field);
        // For an entry of a matrix or a part of a pair, use the whole.
        let part = what.strip_suffix("_re").or_else(|| what.strip_suffix("_im")).unwrap_or(what);
        let whole = part.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
        let is_part = whole.len() < what.len() && !whole.is_empty();
        let entry = || is_part.then(|| self.find(whole, model).ok()).flatten();
        let condition = || self.find(what.strip_suffix(" holds")?, model).ok();
        let by_start = || {
            let length =
                |link: &Link| link.starts.iter().filter(|start| what.starts_with(*start)).map(String::len).max();
            let links = self.table.iter().filter_map(|link| Some((length(link)?, link)));
            links.max_by_key(|(length, _)| *length).map(|(_, link)| Target::Link(link, None))
        };
        // Also accept names as on a page: with spaces or hyphens between the words.
        let plain = |name: &str| name.to_lowercase().replace([' ', '-'], "_");
        let as_spoken = || {
            // Also without the side, if the name in the table has one.
            let names = self.names().into_iter().map(|(name, _)| name);
            let mut all = names.chain(self.table.iter().map(|link| link.name.clone()));
            let name = all.find(|name| name != what && plain(name) == plain(what))?;
            self.find(&name, model).ok()
        };
        found.or_else(by_start).or_else(entry).or_else(condition).or_else(as_spoken).ok_or_else(|| {
            let names = self.names();
            let meant = nearest(what, names.iter().map(|(name, _)| name.as_str())).map(str::to_owned);
            ExplainError::Unknown { what: what.into(), meant }
        })
    }

    /// Routes with which a corner impact must be verified for a name's value, if any. The evidence for a statement needs no external
    /// program.
    pub fn needs(&self, what: &str, model: &Model) -> Result<Option<External>, ExplainError> {
        Ok(match self.find(what, model)? {
            Target::Link(link, _) => link.value.as_ref().filter(|path| path.starts_with('/')).map(|_| External::Run),
            Target::Claim(_) => Some(External::LeftOut),
            Target::Tolerance(_) | Target::Field(_) => None,
        })
    }

    /// Explains a name, with the values of a model.
    pub fn explain(&self, what: &str, findings: &Findings<'_>) -> Result<Explanation, ExplainError> {
        let plain = |sentence: &str, known| Explanation::plain(what, sentence, known);
        Ok(match self.find(what, findings.model)? {
            Target::Link(link, side) => {
                let sentence = in_units(&link.sentence, &findings.model.units);
                self.of_link(link, side, findings, plain(&sentence, link.known))
            }
            Target::Tolerance(row) => Explanation {
                value: Some(row.value.into()),
                code: Some(Code { file: "src/tolerance.rs".into(), function: row.name.into() }),
                tests: tests(&["tests/it/tolerance.rs: every_row_has_its_reason".into()]),
                ..plain(&format!("Tolerance: {}.", row.reason), Evidence::Read)
            },
            Target::Claim(claim) => Explanation {
                evidence: evidence(claim, findings)?,
                ..self.of_claim(claim, plain(&claim.statement, Evidence::Read))
            },
            Target::Field(it) => {
                let unit = if it.unit.is_empty() { String::new() } else { format!(", in {}", it.unit) };
                Explanation {
                    value: Some(it.value.into()),
                    code: Some(Code {
                        file: "crates/program/src/report/quantities.rs".into(),
                        function: "quantities".into(),
                    }),
                    ..plain(&format!("Number of the model: {}{unit}.", it.meaning), Evidence::Read)
                }
            }
        })
    }

    /// Evidence for each statement of the paper, by its id.
    pub fn of_claims(&self) -> BTreeMap<&str, Explanation> {
        let of = |claim: &Claim| self.of_claim(claim, Explanation::plain(&claim.id, &claim.statement, Evidence::Read));
        self.claims.iter().map(|claim| (claim.id.as_str(), of(claim))).collect()
    }

    fn of_link(&self, link: &Link, side: Option<Side>, findings: &Findings<'_>, plain: Explanation) -> Explanation {
        let sided = |text: &str| side.map_or_else(|| text.to_owned(), |side| text.replace("{side}", &side.to_string()));
        let at = |path: &str| match path.starts_with('/') {
            true => findings.document.pointer(&sided(path)).filter(|value| !value.is_null()),
            false => findings.values.get(path),
        };
        // In `compare`, this name is one of the several numbers of the link.
        let own = findings.values.get(&plain.what).filter(|_| sided(&format!("{}_{{side}}", link.name)) != plain.what);
        let others = self.table.iter().filter(|other| other.name != link.name && other.labels.contains(&plain.what));
        // A label that has two sides is explained for the side before the corner.
        let is_label = link.labels.contains(&plain.what);
        let plus = (is_label && link.sides).then(|| format!("{}_{}", link.name, Side::Plus));
        let about = format!("equation: {}, ", plain.what);
        let statements = self.claims.iter().filter(|claim| claim.id.starts_with(&about)).map(|claim| claim.id.clone());
        let of_input = |name: &str| {
            let (base, side) = match name.rsplit_once('_') {
                Some((base, side @ ("minus" | "plus"))) => (base, side),
                _ => (name, ""),
            };
            let path = self.table.iter().find(|link| link.name == base).and_then(|link| link.value.as_ref());
            let found = path.and_then(|path| findings.document.pointer(&path.replace("{side}", side)).cloned());
            found.or_else(|| {
                quantities(findings.model).into_iter().find(|it| it.name() == name).map(|it| it.value.into())
            })
        };
        let names = link.inputs.iter().map(|name| sided(name));
        let inputs = names.map(|name| Input { value: of_input(&name), name }).collect();
        let each = |of: &str, path: Option<&String>| -> BTreeMap<String, Value> {
            let all = findings.document.pointer(of).and_then(Value::as_object).into_iter().flatten();
            let one = |(route, found): (&String, &Value)| Some((route.clone(), found.pointer(&sided(path?))?.clone()));
            all.filter_map(one).collect()
        };
        let mut routes = each("/routes", link.routes.as_ref());
        routes.extend(each("/orbits", link.orbits.as_ref()));
        let is_proved = routes.contains_key("certificate");
        let certificate = findings.found.and_then(|found| found.certificate.as_ref()).filter(|_| is_proved);
        let ways = [
            RouteName::Certificate,
            RouteName::ClosedForm,
            RouteName::FiniteDifference,
            RouteName::LeastSquares,
            RouteName::Scipy,
            RouteName::Symbolic,
            RouteName::Variational,
        ];
        let is_way = |skipped: &&Skipped| ways.iter().any(|way| way.to_string() == skipped.route);
        let known = findings.found.filter(|_| !routes.is_empty());
        let skipped = known.into_iter().flat_map(|found| &found.skipped).filter(is_way);
        let skipped = skipped.filter(|skipped| !routes.contains_key(&skipped.route)).cloned().collect();
        Explanation {
            formula: link.formula.clone(),
            label: link.labels.first().cloned(),
            also: others.map(|other| other.name.clone()).chain(plus).chain(statements).collect(),
            inputs,
            value: own.or_else(|| at(link.value.as_deref()?)).cloned().or_else(|| of_input(&link.name)),
            known: if is_proved { Evidence::Proved } else { link.known },
            hypotheses: certificate.map(Certificate::hypotheses).unwrap_or_default(),
            routes,
            skipped,
            code: code(&link.code),
            derivation: link.derivation.as_deref().and_then(derivation),
            tests: tests(&link.tests),
            paper: self.place(link),
            ..plain
        }
    }

    /// Place in the paper, and the error there, if any.
    fn place(&self, link: &Link) -> Option<String> {
        let label = link.labels.first().map(|label| format!("equation: {label}"));
        let wrong = self.claims.iter().find(|claim| label.as_ref().is_some_and(|label| claim.id.starts_with(label)));
        let slip = wrong.and_then(|claim| {
            let right = claim.correct.as_ref()?;
            Some(format!("; {} in print; correct: {right}", claim.verdict))
        });
        link.paper.as_ref().map(|place| format!("{place}{}", slip.unwrap_or_default()))
    }

    /// Explains a statement of the paper by its evidence.
    fn of_claim(&self, claim: &Claim, plain: Explanation) -> Explanation {
        let holds = "tests/it/ledger.rs: every_check_comes_to_the_ledgers_verdict";
        let link = |named: &dyn Fn(&Link) -> bool| self.table.iter().find(|link| named(link));
        let proved = |of: &str| {
            let [script, statement] = self.proofs.get(of)?.clone();
            Some(Derivation { script, statement })
        };
        let (known, code_at, proof) = match checks::find(&claim.id) {
            Some(Check::Equation(label)) => {
                let link = link(&|link| link.labels.iter().any(|of| of == label));
                (Evidence::Proved, link.map_or("src/paper/checks.rs: equation", |link| &link.code), proved(label))
            }
            Some(Check::Proofs(_, all, _)) => {
                (Evidence::Proved, "src/paper/checks.rs: run", all.first().and_then(|one| proved(one)))
            }
            Some(Check::Number(quantity)) => {
                let base = quantity.trim_end_matches("_minus").trim_end_matches("_plus");
                let link = link(&|link| link.name == base || link.name == quantity);
                let proof = link.and_then(|link| derivation(link.derivation.as_deref()?));
                (Evidence::Computed, link.map_or("src/published.rs: compare_published", |link| &link.code), proof)
            }
            Some(Check::Any(known, _) | Check::Paper(known, _)) => {
                (known, claim.check.as_deref().unwrap_or_default(), None)
            }
            Some(Check::Read(..)) | None => (Evidence::Read, "", None),
        };
        let right = claim.correct.as_ref().map_or_else(String::new, |right| format!(" Correct: {right}"));
        Explanation {
            sentence: format!("The paper states for its own model: {}{right}", claim.statement),
            value: Some(claim.verdict.to_string().into()),
            known,
            code: code(code_at),
            derivation: proof,
            tests: tests(&[holds.into()]),
            paper: Some(claim.place.clone()),
            ..plain
        }
    }
}

/// Result of a statement's check on the model, if its corner impact is known.
fn evidence(claim: &Claim, findings: &Findings<'_>) -> Result<Option<String>, ExplainError> {
    let Some((found, check)) = findings.found.zip(checks::find(&claim.id)) else { return Ok(None) };
    let context = Context::new(findings.model, &findings.cam, found)?;
    Ok(Some(check.run(&context).evidence))
}

/// Converts each unit in a sentence, written in braces in metres, to the model's.
fn in_units(sentence: &str, units: &Units) -> String {
    let told = |(place, text): (usize, &str)| if place % 2 == 1 { units.spelled(text) } else { text.to_owned() };
    sentence.split(['{', '}']).enumerate().map(told).collect()
}

/// Parses `FILE: FUNCTION`.
fn code(place: &str) -> Option<Code> {
    place.split_once(": ").map(|(file, function)| Code { file: file.into(), function: function.into() })
}

/// Parses `SCRIPT: STATEMENT`.
fn derivation(place: &str) -> Option<Derivation> {
    let of = |(script, statement): (&str, &str)| Derivation { script: script.into(), statement: statement.into() };
    place.split_once(": ").map(of)
}

/// Parses each `FILE: TEST`.
fn tests(places: &[String]) -> Vec<Test> {
    let of = |place: &String| place.split_once(": ").map(|(file, test)| Test { file: file.into(), test: test.into() });
    places.iter().filter_map(of).collect()
}
