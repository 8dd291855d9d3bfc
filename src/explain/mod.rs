//! From any name to its formula, its proof and its test: of a number, an equation's label, a claim, a tolerance, a column.
//!
//! `links.toml` says where each is evaluated, derived and tested, once; values are read out of the documents of what was found.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::cam::{Cam, Side};
use crate::corner::map::RouteName;
use crate::known::Known;
use crate::model::{Model, ModelError, Units, nearest};
use crate::paper::checks::{self, Check};
use crate::paper::{Claim, Context, LedgerError, ledger, proofs};
use crate::report::quantities::{Quantity, quantities};
use crate::study::certify::Certificate;
use crate::study::compare::{self, Values};
use crate::study::compared::Skipped;
use crate::study::verify::{External, Verification};
use crate::tolerance::{self, Tolerance};

const LINKS: &str = include_str!("links.toml");

/// What a name stands for; serializes to the document of `explain`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    schema: &'static str,
    /// The name.
    pub what: String,
    /// What it is.
    pub sentence: String,
    /// How it is evaluated.
    pub formula: Option<String>,
    /// The formula's label in the paper.
    pub label: Option<String>,
    /// What else the label is of, where a label was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// What goes in, with its value for the model.
    pub inputs: Vec<Input>,
    /// Its value for the model, as documents have it; none where nothing was run, or it is no number of one corner impact.
    pub value: Option<Value>,
    /// The same by each route that knows it.
    pub routes: BTreeMap<String, Value>,
    /// Those that have none, since they did not run: on purpose, or because they failed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skipped: Vec<Skipped>,
    /// How it is known.
    pub known: Known,
    /// Hypotheses of the proof of its value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hypotheses: Vec<String>,
    /// Of a statement of the paper: what its check found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<String>,
    /// What evaluates it.
    pub code: Option<Code>,
    /// What proves it.
    pub derivation: Option<Derivation>,
    /// What holds it.
    pub tests: Vec<Test>,
    /// Where the paper has it.
    pub paper: Option<String>,
}

impl Explanation {
    fn plain(what: &str, sentence: &str, known: Known) -> Self {
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

/// Something that goes into a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Input {
    /// A field of the model, or a name that can be explained.
    pub name: String,
    /// Its value.
    pub value: Option<Value>,
}

/// A function of this program.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Code {
    pub file: String,
    pub function: String,
}

/// A statement that a script proves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Derivation {
    pub script: String,
    pub statement: String,
}

/// A test.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Test {
    pub file: String,
    pub test: String,
}

/// Why there is no explanation.
#[derive(Debug, thiserror::Error)]
pub enum ExplainError {
    /// Nothing has the name.
    #[error("nothing is called \"{what}\" here{} (`explain --list` has every name)", hint(.meant))]
    Unknown {
        /// What was asked for.
        what: String,
        /// The nearest name.
        meant: Option<String>,
    },
    /// The table does not read.
    #[error("links.toml: {0}")]
    Unreadable(#[from] toml::de::Error),
    /// The ledger does not.
    #[error(transparent)]
    Ledger(#[from] LedgerError),
    /// The cam cannot be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// What was found cannot be written as a document.
    #[error("document: {0}")]
    Document(#[from] serde_json::Error),
}

fn hint(meant: &Option<String>) -> String {
    meant.as_ref().map_or_else(String::new, |meant| format!("; did you mean {meant}?"))
}

/// A row of the table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Link {
    name: String,
    /// Whether there is one of either side.
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
    known: Known,
    code: String,
    derivation: Option<String>,
    tests: Vec<String>,
    paper: Option<String>,
}

#[derive(Deserialize)]
struct Table {
    link: Vec<Link>,
}

/// The table, and what names can stand for besides.
pub struct Links {
    table: Vec<Link>,
    claims: Vec<Claim>,
    /// What is proved, by labels of printed equations and by itself: the script, and the statement.
    proofs: BTreeMap<String, [String; 2]>,
}

/// What a name stands for.
enum Target<'a> {
    Link(&'a Link, Option<Side>),
    Tolerance(&'static Tolerance),
    Claim(&'a Claim),
    Field(Quantity),
}

/// What was found of a model, for values.
pub struct Findings<'a> {
    model: &'a Model,
    found: Option<&'a Verification>,
    cam: Cam,
    document: Value,
    /// By the names that `compare` has.
    values: Values,
}

impl<'a> Findings<'a> {
    /// Of a model alone, or of its verified corner impact.
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

    /// Every name with what it stands for in a sentence, of a kind after the other.
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

    /// What a name stands for: a number by its name, with its side or its entry's indices or without; a label; a tolerance; a
    /// claim by its id, or by what stands behind its kind; a field of the model; a name of `compare` by how it begins.
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
        // The equation that a label is of, or else a step on its way.
        let by_label = || {
            let place = |link: &Link| link.labels.iter().position(|label| label == what);
            let links = self.table.iter().filter_map(|link| Some((place(link)?, link)));
            links.min_by_key(|(place, _)| *place).map(|(_, link)| Target::Link(link, link.sides.then_some(Side::Minus)))
        };
        let tolerance =
            || tolerance::TABLE.iter().find(|row| row.name.eq_ignore_ascii_case(what)).map(Target::Tolerance);
        let is_claim = |claim: &&Claim| claim.id == what || claim.id.split_once(": ").is_some_and(|(_, id)| id == what);
        let claim = || self.claims.iter().find(is_claim).map(Target::Claim);
        // By its short name, too, as `--set` takes it.
        let path = model.path_of(what, &[]).unwrap_or(what);
        let field = || quantities(model).into_iter().find(|it| it.field == path).map(Target::Field);
        let found = link.or_else(by_label).or_else(tolerance).or_else(claim).or_else(field);
        // An entry of a matrix or a pair: what it is an entry of.
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
        // As a page has it: with a blank or a hyphen between the words of a name.
        let plain = |name: &str| name.to_lowercase().replace([' ', '-'], "_");
        let as_spoken = || {
            // Also without the side that a name of the table has there.
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

    /// With which routes a corner impact must be verified for a name's value, if at all: the evidence for a statement needs none outside.
    pub fn needs(&self, what: &str, model: &Model) -> Result<Option<External>, ExplainError> {
        Ok(match self.find(what, model)? {
            Target::Link(link, _) => link.value.as_ref().filter(|path| path.starts_with('/')).map(|_| External::Run),
            Target::Claim(_) => Some(External::LeftOut),
            Target::Tolerance(_) | Target::Field(_) => None,
        })
    }

    /// What a name stands for, with the values of a model.
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
                ..plain(&format!("A tolerance: {}.", row.reason), Known::Read)
            },
            Target::Claim(claim) => Explanation {
                evidence: evidence(claim, findings)?,
                ..self.of_claim(claim, plain(&claim.statement, Known::Read))
            },
            Target::Field(it) => {
                let unit = if it.unit.is_empty() { String::new() } else { format!(", in {}", it.unit) };
                Explanation {
                    value: Some(it.value.into()),
                    code: Some(Code { file: "src/report/quantities.rs".into(), function: "quantities".into() }),
                    ..plain(&format!("A number of the model: {}{unit}.", it.meaning), Known::Read)
                }
            }
        })
    }

    /// What decides each statement of the paper, by its id.
    pub fn of_claims(&self) -> BTreeMap<&str, Explanation> {
        let of = |claim: &Claim| self.of_claim(claim, Explanation::plain(&claim.id, &claim.statement, Known::Read));
        self.claims.iter().map(|claim| (claim.id.as_str(), of(claim))).collect()
    }

    fn of_link(&self, link: &Link, side: Option<Side>, findings: &Findings<'_>, plain: Explanation) -> Explanation {
        let sided = |text: &str| side.map_or_else(|| text.to_owned(), |side| text.replace("{side}", &side.to_string()));
        let at = |path: &str| match path.starts_with('/') {
            true => findings.document.pointer(&sided(path)).filter(|value| !value.is_null()),
            false => findings.values.get(path),
        };
        // What `compare` calls by this name is one number of those that the link is about.
        let own = findings.values.get(&plain.what).filter(|_| sided(&format!("{}_{{side}}", link.name)) != plain.what);
        let others = self.table.iter().filter(|other| other.name != link.name && other.labels.contains(&plain.what));
        // A label of what has two sides is told for the one before the corner.
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
            known: if is_proved { Known::Proved } else { link.known },
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

    /// Where the paper has it, and what is not right there.
    fn place(&self, link: &Link) -> Option<String> {
        let label = link.labels.first().map(|label| format!("equation: {label}"));
        let wrong = self.claims.iter().find(|claim| label.as_ref().is_some_and(|label| claim.id.starts_with(label)));
        let slip = wrong.and_then(|claim| {
            let right = claim.correct.as_ref()?;
            Some(format!("; {} in print, right is: {right}", claim.verdict))
        });
        link.paper.as_ref().map(|place| format!("{place}{}", slip.unwrap_or_default()))
    }

    /// A statement of the paper: what decides it.
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
                (Known::Proved, link.map_or("src/paper/checks.rs: equation", |link| &link.code), proved(label))
            }
            Some(Check::Proofs(_, all, _)) => {
                (Known::Proved, "src/paper/checks.rs: run", all.first().and_then(|one| proved(one)))
            }
            Some(Check::Number(quantity)) => {
                let base = quantity.trim_end_matches("_minus").trim_end_matches("_plus");
                let link = link(&|link| link.name == base || link.name == quantity);
                let proof = link.and_then(|link| derivation(link.derivation.as_deref()?));
                (Known::Computed, link.map_or("src/published.rs: compare_published", |link| &link.code), proof)
            }
            Some(Check::Any(known, _) | Check::Paper(known, _)) => {
                (known, claim.check.as_deref().unwrap_or_default(), None)
            }
            Some(Check::Read(..)) | None => (Known::Read, "", None),
        };
        let right = claim.correct.as_ref().map_or_else(String::new, |right| format!(" Right instead: {right}"));
        Explanation {
            sentence: format!("The paper states, of its own model: {}{right}", claim.statement),
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

/// What the check of a statement finds in the model, where its corner impact is known.
fn evidence(claim: &Claim, findings: &Findings<'_>) -> Result<Option<String>, ExplainError> {
    let Some((found, check)) = findings.found.zip(checks::find(&claim.id)) else { return Ok(None) };
    let context = Context::new(findings.model, &findings.cam, found)?;
    Ok(Some(check.run(&context).evidence))
}

/// A sentence with each unit, which stands in braces in metres, as a model has it.
fn in_units(sentence: &str, units: &Units) -> String {
    let told = |(place, text): (usize, &str)| if place % 2 == 1 { units.spelled(text) } else { text.to_owned() };
    sentence.split(['{', '}']).enumerate().map(told).collect()
}

/// `FILE: FUNCTION`.
fn code(place: &str) -> Option<Code> {
    place.split_once(": ").map(|(file, function)| Code { file: file.into(), function: function.into() })
}

/// `SCRIPT: STATEMENT`.
fn derivation(place: &str) -> Option<Derivation> {
    let of = |(script, statement): (&str, &str)| Derivation { script: script.into(), statement: statement.into() };
    place.split_once(": ").map(of)
}

/// `FILE: TEST`, each.
fn tests(places: &[String]) -> Vec<Test> {
    let of = |place: &String| place.split_once(": ").map(|(file, test)| Test { file: file.into(), test: test.into() });
    places.iter().filter_map(of).collect()
}
