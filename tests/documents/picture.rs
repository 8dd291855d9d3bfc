//! Whether a picture is what a command draws, as far as two machines draw the same.

use std::path::Path;

/// How far numbers of a drawing may be apart, in its units: rounding of their two decimals.
const ROUNDING: f64 = 0.021;
/// Of the pixels of a picture of chaos, those that may be of another colour.
const OTHER_PIXELS: f64 = 0.02;

/// Nothing, or where the pictures in two files differ.
pub fn same(drawn: &Path, kept: &Path) -> Result<(), String> {
    if !kept.is_file() {
        return Err("is not kept".into());
    }
    match drawn.extension().and_then(|end| end.to_str()) {
        Some("svg") => same_drawing(&text(drawn)?, &text(kept)?),
        Some("png") => same_pixels(&pixels(drawn)?, &pixels(kept)?),
        _ => Err("is no picture".into()),
    }
}

fn text(file: &Path) -> Result<String, String> {
    std::fs::read_to_string(file).map_err(|error| error.to_string())
}

/// Every element in order, the same but for rounding; a cloud of runs, which chaos makes another on another machine, has its
/// place and its style.
fn same_drawing(drawn: &str, kept: &str) -> Result<(), String> {
    let (one, other): (Vec<&str>, Vec<&str>) = (drawn.lines().collect(), kept.lines().collect());
    if one.len() != other.len() {
        return Err(format!("{} elements are drawn, {} kept", one.len(), other.len()));
    }
    for (number, (drawn, kept)) in one.into_iter().zip(other).enumerate() {
        let is_cloud = drawn.contains("scale(0.1)") && kept.contains("scale(0.1)");
        let bare = |line: &str| {
            line.split(" d=\"")
                .map(|part| part.split_once('"').map_or(part, |(_, rest)| rest).to_owned())
                .collect::<Vec<_>>()
        };
        let same = if is_cloud { bare(drawn)[1..] == bare(kept)[1..] } else { is_close(drawn, kept) };
        if !same {
            return Err(format!("line {}: {} is drawn, {} kept", number + 1, start(drawn), start(kept)));
        }
    }
    Ok(())
}

fn start(line: &str) -> String {
    line.chars().take(160).collect()
}

/// The same words between the same numbers, to rounding.
fn is_close(one: &str, other: &str) -> bool {
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    let words =
        |line: &str| line.split(is_number).filter(|word| !word.is_empty()).map(String::from).collect::<Vec<_>>();
    let numbers = |line: &str| {
        let pieces = line.split(|c: char| !is_number(c)).filter(|piece| piece.contains(|c: char| c.is_ascii_digit()));
        pieces.filter_map(|piece| piece.parse::<f64>().ok()).collect::<Vec<_>>()
    };
    let (these, those) = (numbers(one), numbers(other));
    let close = these.len() == those.len() && these.iter().zip(&those).all(|(a, b)| (a - b).abs() <= ROUNDING);
    close && words(one) == words(other)
}

type Pixels = ((u32, u32), Vec<u8>);

fn pixels(file: &Path) -> Result<Pixels, String> {
    let error = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let open = std::fs::File::open(file).map_err(|why| error(&why))?;
    let mut reader = png::Decoder::new(std::io::BufReader::new(open)).read_info().map_err(|why| error(&why))?;
    let mut buffer = vec![0; reader.output_buffer_size().ok_or_else(|| error(&"too large"))?];
    let info = reader.next_frame(&mut buffer).map_err(|why| error(&why))?;
    buffer.truncate(info.buffer_size());
    Ok(((info.width, info.height), buffer))
}

fn same_pixels((size, drawn): &Pixels, (other, kept): &Pixels) -> Result<(), String> {
    if size != other || drawn.len() != kept.len() {
        return Err(format!("{size:?} is drawn, {other:?} kept"));
    }
    let differ = drawn.iter().zip(kept).filter(|(one, other)| one.abs_diff(**other) > 8).count();
    let share = differ as f64 / drawn.len() as f64;
    if share <= OTHER_PIXELS { Ok(()) } else { Err(format!("{:.1} % of it is drawn otherwise", 100.0 * share)) }
}
