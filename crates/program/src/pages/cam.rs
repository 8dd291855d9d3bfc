//! Page of `cam`: segments and corners.

use crate::pages::source;
use crate::show::Paged;
use crate::show::block::{Block, Column, Span, Table, Words, words};
use crate::show::digits::{Digits, with_error};
use crate::show::words;
use corner_impact::cam::Corner;
use corner_impact::measured::Measured;
use corner_impact::model::FollowerContact;
use corner_impact::study::cam::{CamGeometry, CamSheet, Largest};

/// Largest number of items that a terminal prints line by line.
const LONGEST: usize = 40;

impl Paged for CamSheet {
    fn blocks(&self) -> Vec<Block> {
        let title = Block::Title(words!["Cam of ", &self.model]);
        let mut blocks = vec![title];
        blocks.extend(source(&self.source));
        blocks.extend([Block::Gap, Block::paragraph(lift(self)), follower(self.geometry.as_ref(), self.lever_ratio)]);
        blocks.extend(largest(self));
        blocks.extend(self.measured.iter().flat_map(measured));
        blocks.extend(parts(self));
        blocks
    }
}

/// End of the follower that has this lift, and the requirements of the contour on it.
pub(crate) fn follower(geometry: Option<&CamGeometry>, lever_ratio: f64) -> Block {
    let lever = match lever_ratio {
        1.0 => Words::default(),
        ratio => words![
            "; a lever of ratio ",
            (ratio, Digits::Short),
            " moves the follower: lifts and forces are those at the follower, and the cam presses ",
            (ratio, Digits::Short),
            " times as hard on its end of the lever"
        ],
    };
    let Some(of) = geometry else {
        let own = "follower: the lift is that of the follower, whatever its end on the cam";
        return Block::paragraph(words![own, lever]);
    };
    let length = |length: f64| words![(length, Digits::Significant(6)), " ", Span::Unit("m")];
    let at = |angle: f64| words![" at ", (angle.to_degrees(), Digits::Fixed(3)), " deg"];
    let end = match of.contact {
        FollowerContact::Point => "a point on a line through the cam's axis".into(),
        FollowerContact::Flat => "a flat face square to its motion".into(),
        FollowerContact::Roller { roller_radius, offset } => {
            let line = match offset {
                0.0 => "through".into(),
                offset => words![length(offset), " beside"],
            };
            words![
                "a roller of radius ",
                length(roller_radius),
                ", whose centre moves on a line ",
                line,
                " the cam's axis; the lift is the distance of its centre"
            ]
        }
    };
    let pressed = match of.face_width_m {
        Some(width) => words!["; the cam touches ", length(width), " of the face"],
        None => {
            let angle = (of.pressure_angle_rad.to_degrees(), Digits::Fixed(1));
            let most = CamGeometry::LARGE_PRESSURE_ANGLE.to_degrees();
            let large = if of.is_steep { format!(", large for a guide (above {most:.0} deg)") } else { String::new() };
            words!["; largest pressure angle ", angle, " deg", at(of.pressure_angle_at_rad), large]
        }
    };
    let sharpest = words!["; least radius of curvature of the cam ", length(of.least_radius_m)];
    let hollow = match (of.hollow_radius_m, of.is_touchable) {
        (_, false) => "; it has a hollow that this follower cannot touch".into(),
        (Some(radius), true) => words![", of its hollows ", length(radius)],
        (None, true) => Words::default(),
    };
    Block::paragraph(words!["follower: ", end, pressed, sharpest, hollow, lever])
}

/// Largest velocity, acceleration and jerk, one line each.
fn largest(sheet: &CamSheet) -> Vec<Block> {
    const NAMES: [(&str, &str); 3] = [("velocity", "m/rad"), ("acceleration", "m/rad^2"), ("jerk", "m/rad^3")];
    let line = |(largest, (name, unit)): (&Largest, (&'static str, &'static str))| {
        let (value, at) =
            ((largest.value_m, Digits::Significant(6)), (largest.cam_angle_rad.to_degrees(), Digits::Fixed(3)));
        (name.into(), words![value, " ", Span::Unit(unit), " at ", at, " deg"])
    };
    let entries = sheet.largest.iter().zip(NAMES).map(line).collect();
    vec![Block::Gap, Block::paragraph("Largest between corners:"), Block::Entries(14, entries)]
}

pub(crate) fn parts(sheet: &CamSheet) -> Vec<Block> {
    [segments(sheet), corners(sheet)].concat()
}

const NINE: Digits = Digits::Significant(9);

/// The lift law, and the range of its lift.
pub(crate) fn lift(sheet: &CamSheet) -> Words {
    let [low, high] = sheet.lift_m;
    words![format!("law \"{}\", lift from ", sheet.law), (low, NINE), " to ", (high, NINE), " ", Span::Unit("m")]
}

/// Interpretation of the table, uncertainty of the cam, and features of a smoothing spline.
pub(crate) fn measured(measured: &Measured) -> Vec<Block> {
    let told =
        |length: f64| words![(measured.reading.in_model.told(length), Digits::Aligned(2)), " ", &measured.reading.unit];
    let mut blocks: Vec<Block> = words::reading(&measured.reading).into_iter().map(Block::paragraph).collect();
    if let Some(why) = &measured.noise_unknown {
        blocks.push(Block::paragraph(words::noise_unknown(why)));
        return blocks;
    }
    let accuracy = match measured.step_m {
        Some(_) => words::accuracy(measured),
        None => format!("{} with all digits of a double", measured.reading.holds.values()),
    };
    let (digits, error) = with_error(measured.curvature_error);
    blocks.push(Block::paragraph(words![
        format!("accuracy: {accuracy}; the rows scatter about a smooth motion by "),
        told(measured.noise_m),
        "; the second derivative, ",
        (measured.largest_curvature, digits),
        " ",
        Span::Unit("m"),
        "/rad^2 at most, is known to ",
        (error, digits),
        " or better"
    ]));
    if measured.is_smoothed {
        let list = |words: Vec<Words>| Words::joined(words, ", ");
        let features = |name: &str, is_found: bool, places: Vec<Words>| {
            let known = if is_found { "found" } else { "given" };
            if places.is_empty() {
                return words![format!("; no {name} {known}")];
            }
            words![format!("; {name} {known}: "), list(places), " deg"]
        };
        let degrees = |angle: f64| words![(angle, Digits::UpTo(3))];
        let corners = measured.corners_deg.iter().map(|corner| degrees(*corner)).collect();
        let dwells =
            measured.dwells_deg.iter().map(|[from, to]| words![degrees(*from), " to ", degrees(to % 360.0)]).collect();
        blocks.push(Block::paragraph(words![
            "smoothing: at most ",
            told(measured.largest_distance_m),
            " from a row",
            features("corners of order 2", measured.corners_are_found, corners),
            features("dwells", measured.dwells_are_found, dwells)
        ]));
        blocks.extend(measured.doubtful_corners.iter().map(|doubtful| {
            let at = doubtful.at_deg.iter().map(|corner| degrees(*corner)).collect();
            Block::paragraph(words![
                "doubtful corners: ",
                list(at),
                " (deg): a jump of the acceleration fits the rows better than a steep rise, but not by enough to be certain. The cam is \
                 drawn without it. In [cam], ",
                &doubtful.ruled_out_by,
                " rules it out, and ",
                &doubtful.ruled_in_by,
                " makes it a corner"
            ])
        }));
    }
    blocks
}

fn segments(sheet: &CamSheet) -> Vec<Block> {
    let title = format!("Segments ({})", sheet.segments.len());
    let columns = [
        Column::right("from deg", 12),
        Column::right("to deg", 12),
        Column::left("motion", 2, 12),
        Column::right(words!["lowest ", Span::Unit("m")], 16),
        Column::right(words!["highest ", Span::Unit("m")], 16),
    ];
    let mut table = Table::new("Segments of the cam", columns);
    let mut spans = [f64::INFINITY, 0.0_f64];
    for (segment, motion) in sheet.segments.iter().zip(&sheet.motions) {
        let [start, end] = [segment.start, segment.end].map(f64::to_degrees);
        spans = [spans[0].min(end - start), spans[1].max(end - start)];
        let [low, high] = segment.extremes().map(|lift| words![(lift, NINE)]);
        let [from, to] = [start, end].map(|angle| words![(angle, Digits::Fixed(6))]);
        table.row([from, to, (*motion).into(), low, high]);
    }
    if table.rows.len() <= LONGEST {
        return vec![Block::Heading(title.into()), Block::Table(table)];
    }
    let [least, most] = spans.map(|span| (span, Digits::Significant(6)));
    let spans = if spans[0] == spans[1] {
        words!["each ", least, " deg long; --json lists them"]
    } else {
        words!["each from ", least, " to ", most, " deg long; --json lists them"]
    };
    if sheet.is_smoothed() {
        return vec![Block::Heading(title.into()), Block::paragraph(spans)];
    }
    vec![
        Block::Brief(vec![Block::Heading(title.as_str().into()), Block::paragraph(spans)]),
        Block::Details(title.into(), vec![Block::Table(table)]),
    ]
}

fn corners(sheet: &CamSheet) -> Vec<Block> {
    let title = format!("Corners ({})", sheet.own_corners.len());
    let mut blocks = vec![Block::Heading(title.as_str().into())];
    if sheet.own_corners.is_empty() {
        let order = sheet.highest_order;
        let none = format!("No jump was found in the derivatives of the lift up to order {order}.");
        blocks.push(Block::paragraph(none));
        return blocks;
    }
    blocks.push(Block::paragraph(words![
        "order: order of the lowest derivative of the lift that jumps (1 velocity, 2 acceleration, 3 jerk); jump: its value \
         after the corner minus its value before, in ",
        Span::Unit("m/rad^order"),
        "; slopes in ",
        Span::Unit("m/rad"),
        "."
    ]));
    blocks.push(Block::Gap);
    let of_order = |order: usize| sheet.own_corners.iter().filter(move |corner| corner.jump_order == order);
    let long: Vec<usize> = (1..=sheet.highest_order).filter(|order| of_order(*order).count() > LONGEST).collect();
    if long.is_empty() {
        blocks.push(table(&sheet.own_corners.iter().collect::<Vec<_>>()));
        return blocks;
    }
    let mut brief = Vec::new();
    let few: Vec<_> = sheet.own_corners.iter().filter(|corner| !long.contains(&corner.jump_order)).collect();
    if !few.is_empty() {
        brief.push(table(&few));
    }
    for order in long {
        let Some(largest) = of_order(order).max_by(|a, b| a.jump.abs().total_cmp(&b.jump.abs())) else { continue };
        let (jump, at) = ((largest.jump, Digits::Short), (largest.angle.to_degrees(), Digits::Fixed(6)));
        let count = of_order(order).count();
        brief.push(Block::paragraph(words![
            count,
            format!(" of order {order}, with the largest jump "),
            jump,
            " at ",
            at,
            " deg"
        ]));
    }
    let all = table(&sheet.own_corners.iter().collect::<Vec<_>>());
    blocks.extend([Block::Brief(brief), Block::Details(title.into(), vec![all])]);
    blocks
}

fn table(corners: &[&Corner]) -> Block {
    let columns = [
        Column::right("angle deg", 12),
        Column::right("order", 7),
        Column::right("jump", 16),
        Column::right(words!["lift ", Span::Unit("m")], 16),
        Column::right("slope before", 16),
        Column::right("slope after", 16),
    ];
    let mut table = Table::new("Corners of the cam", columns);
    for corner in corners {
        let angle = words![(corner.angle.to_degrees(), Digits::Fixed(6))];
        let [jump, lift, before, after] = [corner.jump, corner.plus.value, corner.minus.slope, corner.plus.slope]
            .map(|number| words![(number, Digits::Short)]);
        table.row([angle, corner.jump_order.into(), jump, lift, before, after]);
    }
    Block::Table(table)
}
