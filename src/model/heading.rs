//! Words and units in the lines above a table of lifts: the quantity of a column, and the unit of its numbers.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::table_units::{AngleUnit, LiftUnit, decimal_part};

/// Meaning of a word in a heading.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meaning {
    /// Quantity of a column that is left out.
    Other,
    Lift,
    /// Radius of the cam itself, which is not a lift.
    Radius,
    Angle,
    /// x of a point.
    Abscissa,
    /// y of a point.
    Ordinate,
    /// Word without a quantity or a unit.
    Filler,
    /// Unit of angles, by its index in the names of a model file.
    AngleUnit(usize),
    /// Unit of lengths, by its index in their table.
    LengthUnit(usize),
    /// Unit of time, which is only read after a slash.
    TimeUnit,
    /// Unit that no column may have.
    OtherUnit,
    /// Decimal part of a unit, by its number of places.
    Part(u32),
}

/// Words by their meaning, each once. A word after a hyphen may end a longer word, as in German.
const WORDS: [(Meaning, &str); 23] = [
    (
        Meaning::Other,
        "velocity vel v speed acceleration accel acc a jerk j force load curvature time t no nr num number row index idx n point points pt pts \
         station line rpm pressure stress torque power temp temperature rate slope gradient derivative error deviation tolerance noise std \
         sigma uncertainty krümmungsradius krümmung -geschwindigkeit -beschleunigung ruck zeit -kraft punkt zeile druckwinkel eingriffswinkel \
         leistung vitesse accélération effort temps velocità velocita accelerazione forza tempo velocidad aceleración #",
    ),
    (
        Meaning::Lift,
        "lift lifts -hub rise displacement displ height stroke -erhebung levée levee alzata sollevamento alzada levantamiento",
    ),
    (Meaning::Radius, "-radius radii radial polar r rayon raggio"),
    (
        Meaning::Angle,
        "angle angles theta θ ϑ phi φ ϕ alpha α rotation -winkel cam crank camshaft crankshaft kw nw ca cad angolo ángulo",
    ),
    (Meaning::Abscissa, "x"),
    (Meaning::Ordinate, "y"),
    (Meaning::Filler, "of an the at vs valve intake inlet exhaust einlass auslass einer eines von de di"),
    (Meaning::AngleUnit(0), "deg degs degree degrees ° grad degré degrés gradi grados"),
    (Meaning::AngleUnit(1), "rad rads radian radians"),
    (Meaning::AngleUnit(2), "turn turns rev revs revolution revolutions"),
    (Meaning::AngleUnit(3), "gon gons gradian gradians"),
    (Meaning::LengthUnit(0), "m metre metres meter meters"),
    (Meaning::LengthUnit(1), "cm centimetre centimetres centimeter centimeters"),
    (Meaning::LengthUnit(2), "mm millimetre millimetres millimeter millimeters"),
    (Meaning::LengthUnit(3), "um µm μm micron microns micrometre micrometres micrometer micrometers"),
    (Meaning::LengthUnit(4), "in inch inches zoll pouce pouces pollice pollici \""),
    (Meaning::LengthUnit(5), "ft foot feet"),
    (Meaning::LengthUnit(6), "thou thous mil mils"),
    (Meaning::TimeUnit, "s sec ms min"),
    (Meaning::OtherUnit, "km dm nm pm yd yard yards mrad arcmin arcsec °c °f %"),
    (Meaning::Part(1), "tenth tenths zehntel"),
    (Meaning::Part(2), "hundredth hundredths hundertstel"),
    (Meaning::Part(3), "thousandth thousandths tausendstel"),
];
/// Unit of dial gauges.
const MILLIMETRE: Meaning = Meaning::LengthUnit(2);
/// Meaning of each word.
static MEANINGS: LazyLock<HashMap<&str, Meaning>> = LazyLock::new(|| words().collect());
/// Endings of longer words.
static ENDINGS: LazyLock<Vec<(&str, Meaning)>> =
    LazyLock::new(|| words().filter_map(|(word, meaning)| Some((word.strip_prefix('-')?, meaning))).collect());

fn words() -> impl Iterator<Item = (&'static str, Meaning)> {
    WORDS.iter().flat_map(|(meaning, words)| words.split_whitespace().map(|word| (word, *meaning)))
}

/// Beginnings of words for a crank's angle, and for a cam's.
const CRANK: [&str; 5] = ["crank", "kurbel", "kw", "cad", "vilebrequin"];
const CAM: [&str; 3] = ["cam", "nocken", "nw"];
/// Largest number of decimal places of a part of a unit.
const MOST_PLACES: u32 = 6;

/// Word, number or sign of a heading.
#[derive(Clone, Debug, PartialEq)]
struct Token {
    /// Text in lower case; a multiplication sign is `*`, a power `^`, a prime `'`.
    text: String,
    /// Number of the brackets around it, from 1; 0 outside of brackets.
    bracket: usize,
    /// Whether it follows the token before without a gap.
    is_joined: bool,
}

impl Token {
    fn meaning(&self) -> Option<Meaning> {
        let ending = || ENDINGS.iter().find(|(word, _)| self.text.ends_with(word)).map(|(_, meaning)| *meaning);
        MEANINGS.get(&*self.text).copied().or_else(ending)
    }

    fn is_unit(&self) -> bool {
        use Meaning::{AngleUnit, LengthUnit, OtherUnit};
        matches!(self.meaning(), Some(AngleUnit(_) | LengthUnit(_) | OtherUnit))
    }

    fn is_word(&self) -> bool {
        self.text.contains(char::is_alphabetic) || self.text == "#"
    }

    fn number(&self) -> Option<f64> {
        self.text.replace(',', ".").parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// Whether it is a single Latin letter, which is a word only as a name.
    fn is_letter(&self) -> bool {
        self.text.len() == 1 && self.is_word()
    }
}

/// Length in bytes of the number, word or sign at the beginning of a text.
fn first_length(text: &str) -> usize {
    let digits = |text: &str| text.len() - text.trim_start_matches(|next: char| next.is_ascii_digit()).len();
    let letter = text.chars().next().map_or(0, char::len_utf8);
    let after = &text[letter..];
    if text.starts_with(|first: char| first.is_ascii_digit() || first == '.' && digits(after) > 0) {
        let whole = digits(text);
        let decimals = text[whole..].strip_prefix(['.', ',']).map_or(0, digits);
        let end = whole + if decimals > 0 { 1 + decimals } else { 0 };
        let exponent = text[end..].strip_prefix("e-").map_or(0, digits);
        return end + if exponent > 0 { 2 + exponent } else { 0 };
    }
    // Degrees of temperature, which are not an angle.
    if text.starts_with('°')
        && after.to_lowercase().starts_with(['c', 'f'])
        && !after[1..].starts_with(char::is_alphabetic)
    {
        return letter + 1;
    }
    if !text.starts_with(char::is_alphabetic) {
        return letter;
    }
    let end = text.find(|next: char| !next.is_alphanumeric()).unwrap_or(text.len());
    // "LiftMm" is two words, "kW" is one.
    let mut letters = text[..end].char_indices().skip(2).zip(text.chars().skip(1));
    let next = letters.find(|((_, next), before)| next.is_uppercase() && before.is_lowercase());
    next.map_or(end, |((at, _), _)| at)
}

/// Splits a text into tokens.
fn tokens(text: &str) -> Vec<Token> {
    /// Signs, each with the forms in which it is typed.
    const SIGNS: [(&str, &str); 8] =
        [("/", "/"), ("#", "#"), ("%", "%"), ("°", "°"), ("±", "±"), ("*", "*×·⋅"), ("'", "'’′´"), ("\"", "\"″”“")];
    let mut text = text.replace("\"\"", "\"").replace('º', "°");
    for (power, raised) in (1..).zip(['¹', '²', '³', '⁴', '⁵', '⁶']) {
        for written in [format!("10⁻{raised}"), format!("10^-{power}")] {
            text = text.replace(&written, &format!("1e-{power}"));
        }
    }
    let (mut tokens, mut bracket, mut brackets, mut is_joined) = (Vec::<Token>::new(), 0, 0, false);
    let mut rest = &*text;
    while let Some(letter) = rest.chars().next() {
        let (word, behind) = rest.split_at(first_length(rest));
        rest = behind;
        let token = |text: &str, is_joined| Token { text: text.to_lowercase(), bracket, is_joined };
        if "([{".contains(letter) {
            brackets += 1;
            (bracket, is_joined) = (brackets, false);
        } else if ")]}".contains(letter) {
            // Brackets around nothing, or around a dash, mean that there is no unit.
            if tokens.last().is_none_or(|last| last.bracket != bracket) {
                tokens.push(token("-", false));
            }
            (bracket, is_joined) = (0, true);
        } else if let Some((sign, _)) = SIGNS.iter().find(|(_, forms)| forms.contains(word)) {
            tokens.push(token(sign, is_joined));
            is_joined = true;
        } else if "^²³".contains(letter) {
            tokens.push(token("^", true));
        } else if letter.is_alphanumeric() || word.len() > letter.len_utf8() {
            let stem = word.trim_end_matches(char::is_numeric);
            let is_unit = token(stem, false).is_unit() || token(stem, false).meaning() == Some(Meaning::TimeUnit);
            if stem.eq_ignore_ascii_case("x") && token(&word[1..], true).number().is_some_and(|times| times >= 10.0) {
                // "Lift x1000"
                tokens.extend([token("*", is_joined), token(&word[1..], true)]);
            } else if stem.len() < word.len() && is_unit {
                // "mm2"
                tokens.extend([token(stem, is_joined), token("^", true)]);
            } else {
                tokens.push(token(word, is_joined));
            }
            is_joined = true;
        } else {
            is_joined = false;
        }
    }
    // A pair of quotation marks is not a sign of inches.
    let is_mark = |token: &Token| token.text == "\"" && token.bracket == 0;
    if tokens.iter().filter(|token| is_mark(token)).count() > 1 {
        tokens.retain(|token| !is_mark(token));
    }
    // If all tokens are in brackets, the brackets are ignored.
    if tokens.iter().all(|token| token.bracket > 0) {
        tokens.iter_mut().for_each(|token| token.bracket = 0);
    }
    tokens
}

/// Reads a decimal part of a unit of length, such as `0.01 mm`.
pub(super) fn part_of_unit(text: &str) -> Option<LiftUnit> {
    let tokens = tokens(text);
    match units(&tokens)[..] {
        [FoundUnit { meaning: Meaning::LengthUnit(index), parts: Parts::Decimal(places), .. }]
            if places > 0 && tokens.len() == 2 =>
        {
            Some(LiftUnit::part(index, places))
        }
        _ => None,
    }
}

/// Multiple of a unit, given by a number beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Parts {
    /// Decimal part of the unit, by its number of places; 0 is the unit itself.
    Decimal(u32),
    /// Factor of the numbers relative to the unit, or a part that is not decimal.
    Times(f64),
}

/// Unit found in a text.
#[derive(Clone, Debug, PartialEq)]
struct FoundUnit {
    /// Range of its tokens.
    at: std::ops::Range<usize>,
    meaning: Meaning,
    parts: Parts,
    /// Whether it is a quantity per angle or time.
    is_rate: bool,
}

/// Finds the units in a text.
fn units(tokens: &[Token]) -> Vec<FoundUnit> {
    let mut found: Vec<FoundUnit> = Vec::new();
    let mut index = 0;
    while let Some(token) = tokens.get(index) {
        let from = found.last().map_or(0, |last| last.at.end);
        let is_free = index >= from && token.is_unit() && !is_name(tokens, index);
        if let Some(unit) = token.meaning().filter(|_| is_free) {
            found.push(unit_at(tokens, index, unit, from));
        }
        index += 1;
    }
    found
}

/// Whether the word of a unit is a name or a preposition at this place.
fn is_name(tokens: &[Token], index: usize) -> bool {
    let token = &tokens[index];
    let is_sign = |token: &Token| token.text == "/" || token.text == "^";
    let is_of_unit = |token: &Token| {
        token.is_unit() || token.number().is_some() || matches!(token.meaning(), Some(Meaning::Part(_)))
    };
    match (&*token.text, tokens.get(index + 1)) {
        // "Lift in mm", but "in/deg", "in^2" and "Lift in (intake)"
        ("in", Some(next)) if token.bracket == 0 => !is_sign(next) && (next.bracket == 0 || is_of_unit(next)),
        // "M (mm)"
        (_, Some(_)) => token.bracket == 0 && index == 0 && token.is_letter(),
        _ => false,
    }
}

/// Reads the unit whose word is at `index`, with the numbers beside it; tokens before `from` belong to another unit.
fn unit_at(tokens: &[Token], index: usize, meaning: Meaning, from: usize) -> FoundUnit {
    let beside = |token: &&Token| token.bracket == tokens[index].bracket;
    let text = |index: usize| tokens.get(index).filter(beside).map(|token| &*token.text);
    let number = |index: usize| tokens.get(index).filter(beside).and_then(Token::number);
    let means = |index: usize| tokens.get(index).filter(beside).and_then(Token::meaning);
    let (mut start, mut end, mut meaning) = (index, index + 1, meaning);
    let (mut parts, mut is_rate) = (1.0, false);
    // Before the unit: "1/100", "0.01", "hundredths of"
    let fillers = tokens[from..index].iter().rev().take_while(|token| token.meaning() == Some(Meaning::Filler)).count();
    let back = |steps: usize| index.checked_sub(steps).filter(|place| *place >= from);
    if let Some(Meaning::Part(places)) = back(fillers + 1).and_then(means) {
        (start, parts) = (index - fillers - 1, decimal_part(places));
    } else if let Some(value) = back(1).and_then(number) {
        let above = back(2).and_then(text).filter(|text| *text == "/").and_then(|_| back(3)).and_then(number);
        match above {
            Some(above) => (start, parts) = (index - 3, above / value),
            // The 2 of "Cam 2 deg" belongs to the name.
            None if tokens[index].bracket > 0 || value != 0.0 && !(1.0..10.0).contains(&value) => {
                (start, parts) = (index - 1, value)
            }
            None => {}
        }
    }
    // After the unit: "/100", "/deg", "^2"
    let per = |below: Meaning| match (meaning, below) {
        (Meaning::LengthUnit(_), Meaning::AngleUnit(_)) | (_, Meaning::TimeUnit) => Some(true),
        (Meaning::AngleUnit(_), Meaning::AngleUnit(_)) => None,
        _ => Some(false),
    };
    match (text(end), number(end + 1), means(end + 1)) {
        (Some("/"), Some(value), _) => (end, parts) = (end + 2, parts / value),
        (Some("/" | "per" | "pro"), _, Some(below)) => match per(below) {
            Some(true) => (end, is_rate) = (end + 2, true),
            Some(false) => (end, meaning) = (end + 2, Meaning::OtherUnit),
            None => {}
        },
        (Some("^"), ..) => meaning = Meaning::OtherUnit,
        // "[mm·10⁻²]"
        (Some("*"), Some(value), _) if value < 1.0 => (end, parts) = (end + 2, parts * value),
        _ if number(end).is_some_and(|value| value < 1.0) => parts = f64::NAN,
        _ if tokens[index].bracket > 0 && means(end).and_then(per) == Some(true) => is_rate = true,
        _ => {}
    }
    while matches!(text(end), Some("^")) {
        end += if number(end + 1).is_some() { 2 } else { 1 };
    }
    // In `s"` the sign may be a unit or a second derivative.
    let is_behind_word = index.checked_sub(1).is_some_and(|before| tokens[before].is_word());
    if tokens[index].text == "\"" && tokens[index].is_joined && is_behind_word {
        meaning = Meaning::OtherUnit;
    }
    let decimal = (0..=MOST_PLACES).find(|places| decimal_part(*places) == parts);
    let parts = decimal.map_or(Parts::Times(parts), Parts::Decimal);
    FoundUnit { at: start..end, meaning, parts, is_rate }
}

/// Quantity in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Angle,
    Lift,
    /// Radius of the cam itself.
    Radius,
    /// x of a point.
    Abscissa,
    /// y of a point.
    Ordinate,
    /// Other quantity, which is left out.
    Other,
    Unknown,
}

/// Unit that a cell names, if any; the error lists the possible units if the unit is not understood.
pub(super) type Named<T> = Result<Option<T>, Vec<String>>;

/// Interpreted cell of a header.
#[derive(Clone, Debug)]
pub(super) struct Heading {
    pub(super) kind: Kind,
    /// Unit of its angles, by its index in the names of a model file.
    pub(super) angle: Named<usize>,
    /// Unit of its lifts.
    pub(super) lift: Named<LiftUnit>,
    /// Whether it has a unit and no word.
    pub(super) is_unit: bool,
    /// Whether it names an angle of the crank, and whether of the cam.
    pub(super) is_of: [bool; 2],
}

impl Heading {
    pub(super) fn of(cell: &str) -> Self {
        let tokens = tokens(cell);
        let units = units(&tokens);
        let is_of_unit = |index: usize| units.iter().any(|unit| unit.at.contains(&index));
        let names: Vec<&Token> = (0..tokens.len())
            .filter(|index| tokens[*index].bracket == 0 && !is_of_unit(*index))
            .map(|index| &tokens[index])
            .filter(|token| token.is_word())
            .collect();
        // Short words for a quantity are names only in the first place: "no 1", but not "lift no 1".
        let has = |meaning: Meaning| {
            let is_short = |name: &Token| name.text.chars().count() < 3 && name.text != "#";
            let counts = |place: usize, name: &Token| {
                matches!(meaning, Meaning::Lift | Meaning::Angle) || place == 0 || !is_short(name)
            };
            names.iter().enumerate().any(|(place, name)| name.meaning() == Some(meaning) && counts(place, name))
        };
        let begins = |words: &[&str]| tokens.iter().any(|token| words.iter().any(|word| token.text.starts_with(word)));
        let is_of = [begins(&CRANK), begins(&CAM)];
        let lengths = units.iter().filter(|unit| matches!(unit.meaning, Meaning::LengthUnit(_))).count();
        let angles = units.iter().filter(|unit| matches!(unit.meaning, Meaning::AngleUnit(_))).count();
        let is_rate = units.iter().any(|unit| unit.is_rate) || is_derivative(&tokens);
        let kind = if is_rate || names.is_empty() && units.is_empty() || has(Meaning::Other) {
            Kind::Other
        } else if has(Meaning::Lift) {
            Kind::Lift
        } else if has(Meaning::Radius) {
            Kind::Radius
        } else if has(Meaning::Angle) || angles > 0 && lengths == 0 {
            Kind::Angle
        } else if has(Meaning::Abscissa) {
            Kind::Abscissa
        } else if has(Meaning::Ordinate) {
            Kind::Ordinate
        } else {
            Kind::Unknown
        };
        let angle = |meaning: Meaning, places: u32| match meaning {
            Meaning::AngleUnit(index) if places == 0 => Some(index),
            _ => None,
        };
        let lift = |meaning: Meaning, places: u32| match meaning {
            Meaning::LengthUnit(index) => Some(LiftUnit::part(index, places)),
            _ => None,
        };
        let is_unread = is_unread(&tokens);
        let small = || units.iter().find_map(|unit| turn_of(&tokens, unit)).map(|turn| vec![turn]);
        let names_angle = |unit: &usize| AngleUnit::NAMES[*unit].to_owned();
        Self {
            kind,
            angle: named(&tokens, &units, is_unread, angle, names_angle).map_err(|meant| small().unwrap_or(meant)),
            lift: named(&tokens, &units, is_unread, lift, |unit| unit.name()),
            is_unit: !units.is_empty() && (0..tokens.len()).all(is_of_unit),
            is_of,
        }
    }

    /// Whether it is understood without other cells.
    pub(super) fn is_known(&self) -> bool {
        self.kind != Kind::Unknown || matches!(self.lift, Ok(Some(_)))
    }
}

/// Fields of the model for angles in a unit without a name in it, or in a decimal part of a unit: "[0.1 deg]", "[mrad]".
fn turn_of(tokens: &[Token], unit: &FoundUnit) -> Option<String> {
    /// Small units, each with a unit of the model and the number `turn_deg` that makes a turn of 360 degrees.
    const SMALL: [(&str, usize, f64); 3] =
        [("mrad", 1, 360_000.0), ("arcmin", 0, 21_600.0), ("arcsec", 0, 1_296_000.0)];
    let small = SMALL.iter().find(|(word, ..)| tokens[unit.at.clone()].iter().any(|token| token.text == *word));
    let (index, turn) = match (small, unit.meaning, unit.parts) {
        (Some((_, index, turn)), _, Parts::Decimal(0)) => (*index, *turn),
        (None, Meaning::AngleUnit(index), Parts::Decimal(places)) if places > 0 => {
            (index, (360.0 / decimal_part(places)).round())
        }
        _ => return None,
    };
    Some(format!("angle_unit = \"{}\" and turn_deg = {turn}", AngleUnit::NAMES[index]))
}

/// Finds the only unit of a kind in a cell.
fn named<T: PartialEq>(
    tokens: &[Token],
    units: &[FoundUnit],
    is_unread: bool,
    of: impl Fn(Meaning, u32) -> Option<T>,
    name: impl Fn(&T) -> String,
) -> Named<T> {
    let times = multiple(tokens, units);
    let mut found: Vec<T> = Vec::new();
    for unit in units.iter().filter(|unit| !unit.is_rate) {
        match (unit.parts, times) {
            (Parts::Decimal(places), None) => found.extend(of(unit.meaning, places)),
            (Parts::Decimal(_), Some(times)) | (Parts::Times(times), _) => {
                return Err(places_of(times).and_then(|places| of(unit.meaning, places)).iter().map(&name).collect());
            }
        }
    }
    found.dedup();
    match found.len() {
        0 if times.is_some() => {
            // Part of an unnamed unit: a millimetre, as on dial gauges.
            let meant = times.and_then(places_of).and_then(|places| of(MILLIMETRE, places));
            Err(meant.iter().map(name).collect())
        }
        0 if is_unread || !units.is_empty() => Err(Vec::new()),
        // A percentage, for example of a length.
        1 if tokens.iter().any(|token| token.text == "%") => Err(Vec::new()),
        0 | 1 => Ok(found.pop()),
        _ => Err(found.iter().map(name).collect()),
    }
}

/// Factor between the numbers and their unit, written apart from the unit: "Lift x1000 (in)", "Lift/100 [mm]", "hundredths [mm]".
fn multiple(tokens: &[Token], units: &[FoundUnit]) -> Option<f64> {
    let factor = |index: usize| {
        let before = index.checked_sub(1).map_or("", |before| &tokens[before].text);
        let is_used = units.iter().any(|unit| unit.at.contains(&index));
        match (before, tokens[index].number(), tokens[index].meaning()) {
            // A factor in brackets belongs to the unit.
            ("*", Some(number), _) if !is_used || tokens[index].bracket == 0 => Some(number),
            ("x", Some(number), _) if number >= 10.0 => Some(number),
            ("/", Some(number), _) if !is_used && places_of(number).is_some() => Some(number),
            (_, Some(number), _) if !is_used && places_of(1.0 / number).is_some() => Some(1.0 / number),
            (_, _, Some(Meaning::Part(places))) if !is_used => Some(1.0 / decimal_part(places)),
            _ => None,
        }
    };
    (0..tokens.len()).find_map(factor)
}

/// Number of decimal places of the unit whose numbers are this factor larger: 2 for 100.
fn places_of(times: f64) -> Option<u32> {
    (1..=MOST_PLACES).find(|places| 1.0 / times == decimal_part(*places))
}

/// Whether text in brackets, or after a slash or a last "in", is not a word of a heading. If there is no unit, it is an unknown one.
fn is_unread(tokens: &[Token]) -> bool {
    (0..tokens.len()).any(|index| {
        let token = &tokens[index];
        let follows = |sign: &str| index > 0 && tokens[index - 1].text == sign;
        let is_word = {
            use Meaning::{Angle, Filler, Lift, Other, Radius};
            matches!(token.meaning(), Some(Angle | Filler | Lift | Other | Radius))
        };
        (token.bracket > 0 || follows("/") || index + 1 == tokens.len() && follows("in")) && !is_word
    })
}

/// Whether a name denotes a derivative: `s'`, `ds/dθ`.
fn is_derivative(tokens: &[Token]) -> bool {
    let is_prime = |pair: &[Token]| pair[1].text == "'" && pair[1].is_joined && pair[0].number().is_none();
    let is_quotient = |three: &[Token]| {
        let below = three[2].text.strip_prefix('d').map(|of| of.trim_end_matches(|letter: char| letter.is_numeric()));
        let of = below.map(|of| Token { text: of.to_owned(), ..three[2].clone() });
        three[0].text.starts_with('d')
            && three[1].text == "/"
            && of.is_some_and(|of| of.text == "t" || of.meaning() == Some(Meaning::Angle))
    };
    tokens.windows(2).any(is_prime) || tokens.windows(3).any(is_quotient)
}

/// Whether a word of a title or a comment is about the accuracy of lifts.
fn is_of_accuracy(token: &Token) -> bool {
    const WORDS: [&str; 10] =
        ["accura", "dial", "error", "gauge", "gage", "graduat", "precis", "resol", "round", "toleran"];
    token.text == "±" || WORDS.iter().any(|word| token.text.starts_with(word))
}

/// Unit in a title or a comment.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ProseUnit {
    /// Unit of angles, by its index.
    Angle(usize),
    /// Unit of lifts.
    Length(LiftUnit),
}

/// Units in a title or a comment, with the words that name them.
pub(super) fn prose_units(text: &str) -> Vec<(String, ProseUnit)> {
    /// Units that are also words with other meanings, or quotation marks.
    const WORDS_TOO: [&str; 10] =
        ["in", "m", "turn", "turns", "rev", "revs", "revolution", "revolutions", "foot", "feet"];
    let tokens = tokens(text);
    let units = units(&tokens);
    let is_of_lift = tokens.iter().any(|token| token.meaning() == Some(Meaning::Lift));
    let seen = |unit: &FoundUnit| {
        let index = unit.at.clone().find(|index| tokens[*index].is_unit())?;
        let word = &tokens[index];
        let is_counted = index > 0 && tokens[index - 1].number().is_some();
        if word.bracket == 0 && (word.text == "\"" || WORDS_TOO.contains(&&*word.text) && !is_counted) || unit.is_rate {
            return None;
        }
        // A number beside the unit is either the decimal part of the lifts' unit, or a length, such as the accuracy of a gauge.
        let is_in = |start: usize| start > 0 && tokens[start - 1].text == "in";
        let is_accuracy = tokens.iter().any(is_of_accuracy) && !is_in(unit.at.start);
        let places = match unit.parts {
            _ if is_accuracy => 0,
            Parts::Decimal(0) if is_of_lift => multiple(&tokens, &units).and_then(places_of).unwrap_or(0),
            Parts::Decimal(places) if is_of_lift => places,
            _ => 0,
        };
        let unit = match unit.meaning {
            Meaning::AngleUnit(index) => ProseUnit::Angle(index),
            Meaning::LengthUnit(index) => ProseUnit::Length(LiftUnit::part(index, places)),
            _ => return None,
        };
        Some((word.text.clone(), unit))
    };
    units.iter().filter_map(seen).collect()
}
