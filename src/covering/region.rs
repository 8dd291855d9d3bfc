//! Trapping regions: sets of impacts that are followed by impacts in the set, for ever.
//!
//! The plane of impacts is divided into cells. Starting from the cells of some impacts, the image of each cell is enclosed, and each cell
//! that the image may touch is added, until no new one appears. Then every motion that starts in the cells stays in them: it flies and
//! hits, and never rests on the cam. The first cells are squares of one size. A cell is halved if its image is larger than such a square,
//! or if its flights do not all end with one transversal impact. It is halved across the side that makes the image long. So cells are small
//! where the map stretches much, and the region is at most one square larger than necessary everywhere.
//!
//! Flights that may graze the cam are followed to each place where they may touch it. An impact there leaves with any velocity from 0 to
//! the bound that the slope of the gap gives. At a velocity of 0 the cam must release the follower; otherwise the region is not closed. So
//! each cell has a least time to the next impact, and impacts cannot accumulate, as they do before a rest.

use std::collections::HashMap;

use rayon::prelude::*;
use serde::Serialize;

use super::frame::{angular_velocities, stretched};
use super::map::{Impact, ImpactMap, UnprovedFlight};
use crate::elementary;
use crate::interval::mean_value_form::MeanValueForm;
use crate::interval::{Interval, Number};
use crate::orbit::search::velocity_scale;
use crate::progress::Watch;
use crate::simulate::Machine;

/// Rectangle of impacts, in squares of the plane: across is the cam angle, up is the velocity relative to the cam.
type Place = [Interval; 2];

/// Square of the plane, halved a number of times across and up. `at` counts cells of this size from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Cell {
    at: [u64; 2],
    halved: [u8; 2],
}

impl Cell {
    fn side(&self, side: usize) -> Interval {
        let size = 0.5_f64.powi(self.halved[side].into());
        Interval::new(self.at[side] as f64 * size, (self.at[side] + 1) as f64 * size)
    }

    fn meets(&self, place: &Place) -> bool {
        [0, 1].into_iter().all(|side| self.side(side).common(place[side]).is_some())
    }

    fn halves(mut self, side: usize) -> [Self; 2] {
        self.halved[side] += 1;
        self.at[side] *= 2;
        let mut other = self;
        other.at[side] += 1;
        [self, other]
    }
}

/// Result of examining a cell.
enum Look {
    /// Rectangles that contain the impacts after those of the cell.
    Whole(Vec<Place>),
    /// Side across which the cell is halved; its halves are to be examined.
    Halved(usize),
}

/// Region that the impact map of a machine carries into itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Region {
    /// Squares per degree.
    pub squares_per_degree: u32,
    /// Height of a square, m/s.
    pub square_m_s: f64,
    /// Number of cells.
    pub cells: usize,
    /// Number of enclosed images.
    pub looks: usize,
    /// Covered part of the rectangle of all angles and all velocities up to the highest.
    pub part: f64,
    /// Lowest and highest velocity in it, m/s.
    pub velocities_m_s: [f64; 2],
    /// Lowest and highest angle in it, from 0 to 360 degrees.
    pub angles_deg: [f64; 2],
    /// Cells: their ranges of the cam angle, degrees, and of the velocity, m/s.
    #[serde(skip)]
    pub places: Vec<[[f64; 2]; 2]>,
}

impl Region {
    /// Whether an impact is in the region, given by the cam angle, degrees in a turn, and the velocity relative to the cam, m/s.
    pub fn holds(&self, impact: [f64; 2]) -> bool {
        self.places.iter().any(|place| place.iter().zip(impact).all(|([low, high], at)| *low <= at && at <= *high))
    }
}

/// Proved lower bound, above 1, on the factor by which some deviations of every motion in a region grow at each impact. `None` without a
/// proof.
///
/// Coordinates are theta, the angle of an impact, and v, the follower's velocity before it. Each derivative in the region, at a corner on
/// either side, maps a cone `|dv - s dtheta| <= L |dtheta|` into itself, and |dtheta| grows in it. So no periodic orbit in the region is
/// stable (all neighbours of an orbit on a corner are on one side). The largest Lyapunov exponent of each motion is at least the logarithm
/// of the bound, per impact.
pub fn parted(machine: &Machine, rpm: f64, region: &Region) -> Option<f64> {
    /// Tried values of L: |s| times these powers of two.
    const SLOPES: std::ops::RangeInclusive<i32> = -12..=0;
    if !(machine.restitution() > 0.0) {
        return None;
    }
    let (map, omega) = (ImpactMap::new(machine), angular_velocities([rpm; 2]));
    let degree = Interval::TURN / 360.0;
    let of_cell = |[angle, velocity]: &[[f64; 2]; 2]| {
        let place = [Interval::new(angle[0], angle[1]) * degree, Interval::new(velocity[0], velocity[1])];
        let segments = machine.cam().segments();
        let on = segments.iter().enumerate().filter_map(|(index, segment)| {
            // The last segment extends to the end of the turn, which is not a double.
            let end = if index + 1 == segments.len() { Interval::TURN.high() } else { segment.end };
            let angles = place[0].common(Interval::new(segment.start, end))?;
            Some(map.derivative_before(segment, [angles, place[1]], omega))
        });
        on.collect::<Result<Vec<_>, _>>().ok().filter(|sides| !sides.is_empty())
    };
    let derivatives: Vec<Vec<[[Interval; 2]; 2]>> = region.places.par_iter().map(of_cell).collect::<Option<_>>()?;
    // If impacts have large losses, the derivative sends all directions to nearly one.
    let [[_, b], [_, d]] = *derivatives.get(derivatives.len() / 2)?.first()?;
    let s = d.middle() / b.middle();
    let least = |slope: f64| {
        let grown = derivatives.iter().flatten().map(|[[a, b], [c, d]]| {
            // In coordinates x = dtheta and y = dv - s dtheta.
            let (x, across) = (*a + *b * s, *d - *b * s);
            stretched([[x, *b], [*c - *a * s + across * s, across]], slope)
        });
        grown.reduce(|one, two| Some(one?.min(two?)))?
    };
    SLOPES.filter_map(|power| least(s.abs() * 2.0_f64.powi(power))).reduce(f64::max)
}

/// Region that is not closed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OpenRegion {
    /// Squares per degree.
    pub squares_per_degree: u32,
    /// Number of cells so far.
    pub cells: usize,
    /// Impact whose cell could not be continued: degrees of the cam, and m/s.
    pub at: [f64; 2],
    /// Reason why the flight from there is not proved; `None` if there were too many cells, or no impacts to begin with.
    pub flight: Option<UnprovedFlight>,
}

/// Plane of impacts of a machine, in squares.
struct Plane<'a> {
    map: ImpactMap<'a>,
    omega: Interval,
    per_degree: u32,
    height: f64,
}

/// Largest number of halvings of a cell whose image is large.
const HALVINGS: u8 = 24;
/// Largest number of halvings of a cell whose flights do not all end with one transversal impact. After these its flights may graze, and
/// are followed.
const GRAZING: u8 = 12;

/// Closes the region that begins with some rectangles of impacts: the cam angle, rad, and the velocity relative to the cam, m/s. The plane
/// has this number of squares per degree, and the region at most this number of cells.
pub fn trap(
    machine: &Machine,
    rpm: f64,
    impacts: &[[Interval; 2]],
    squares_per_degree: u32,
    most: usize,
    watch: &dyn Watch,
) -> Result<Region, OpenRegion> {
    // Ends of cells must be doubles.
    let squares_per_degree = squares_per_degree.next_power_of_two();
    /// Number of squares of a column up to a velocity that few impacts exceed.
    const SQUARES: f64 = 512.0;
    let height =
        elementary::exp2(elementary::log2(velocity_scale(machine) / SQUARES).floor()) / f64::from(squares_per_degree);
    let omega = angular_velocities([rpm; 2]);
    let plane = Plane { map: ImpactMap::new(machine), omega, per_degree: squares_per_degree, height };
    let mut cover = Cover { known: HashMap::new(), pending: HashMap::new(), turn: 360 * i64::from(squares_per_degree) };
    let escape = |cells, place: Place, flight| {
        let at = [place[0].middle() / f64::from(squares_per_degree), place[1].middle() * height];
        OpenRegion { squares_per_degree, cells, at, flight }
    };
    impacts.iter().for_each(|place| cover.touch(&plane.squares(*place)));
    if cover.pending.is_empty() {
        return Err(escape(0, [Interval::from(0.0); 2], None));
    }
    let (mut cells, mut looks) = (0, 0);
    while !cover.pending.is_empty() {
        watch.at("cells of a region that is carried into itself", cells as u64, 0);
        let wave: Vec<(Cell, Vec<Place>)> = cover.pending.drain().collect();
        looks += wave.len();
        let looked: Vec<_> = wave.par_iter().map(|(cell, _)| plane.look(cell)).collect();
        // The first failing cell in the plane is reported, independent of the order of threads.
        let stuck = wave.iter().zip(&looked).filter_map(|((cell, _), look)| Some((*cell, *look.as_ref().err()?)));
        if let Some((cell, flight)) = stuck.min_by_key(|(cell, _)| *cell) {
            return Err(escape(cells, [cell.side(0), cell.side(1)], Some(flight)));
        }
        // All cells are stored before any image touches one, so that none is examined twice.
        for ((cell, _), look) in wave.iter().zip(&looked) {
            let side = match look {
                Ok(Look::Halved(side)) => Some(*side),
                _ => None,
            };
            cells += usize::from(side.is_none());
            cover.known.insert(*cell, side);
        }
        for ((cell, touched), look) in wave.into_iter().zip(looked) {
            match look {
                Ok(Look::Whole(images)) => images.iter().for_each(|image| cover.touch(image)),
                Ok(Look::Halved(_)) => touched.iter().for_each(|place| cover.reach(cell, place)),
                Err(_) => {}
            }
        }
        if cells > most && !cover.pending.is_empty() {
            let last = cover.pending.keys().min().map_or([Interval::from(0.0); 2], |cell| [cell.side(0), cell.side(1)]);
            return Err(escape(cells, last, None));
        }
    }
    Ok(plane.region(&cover, looks))
}

/// Cells of a region.
struct Cover {
    /// Examined cells: `None` for a whole cell, otherwise the side across which it is halved.
    known: HashMap<Cell, Option<usize>>,
    /// Cells to be examined, with the rectangles that touch them.
    pending: HashMap<Cell, Vec<Place>>,
    /// Squares per turn.
    turn: i64,
}

impl Cover {
    /// Adds all cells that a rectangle touches.
    fn touch(&mut self, place: &Place) {
        let ends = |side: usize| place[side].low().floor() as i64..=place[side].high().floor() as i64;
        for across in ends(0) {
            let at = across.rem_euclid(self.turn);
            // A place beyond a turn equals the place one turn earlier.
            let shifted = [place[0] + (at - across) as f64, place[1]];
            for up in ends(1).filter(|up| *up >= 0) {
                self.reach(Cell { at: [at as u64, up as u64], halved: [0; 2] }, &shifted);
            }
        }
    }

    fn reach(&mut self, cell: Cell, place: &Place) {
        if cell.meets(place) {
            match self.known.get(&cell) {
                Some(None) => {}
                Some(Some(side)) => cell.halves(*side).into_iter().for_each(|half| self.reach(half, place)),
                None => self.pending.entry(cell).or_default().push(*place),
            }
        }
    }
}

impl Plane<'_> {
    /// Converts an angle, rad, and a velocity, m/s, to squares.
    fn squares(&self, [angle, velocity]: [Interval; 2]) -> Place {
        [angle * (Interval::from(360.0) / Interval::TURN) * f64::from(self.per_degree), velocity / self.height]
    }

    /// Converts impacts that follow those of a cell to squares. Returns an error if they are as wide as a turn or unbounded, and so not
    /// located.
    fn image(&self, contact: [Interval; 2]) -> Result<Place, UnprovedFlight> {
        let image = self.squares(contact);
        let turn = f64::from(360 * self.per_degree);
        if image.iter().all(|side| side.width() < turn) { Ok(image) } else { Err(UnprovedFlight::NoImpact) }
    }

    /// Encloses the impacts that follow those of a cell, or decides how to halve it.
    fn look(&self, cell: &Cell) -> Result<Look, UnprovedFlight> {
        let angle = cell.side(0) / f64::from(self.per_degree) * (Interval::TURN / 360.0);
        let place = [angle, cell.side(1) * self.height, self.omega];
        let centre = place.map(|side| Interval::from(side.middle()));
        let over = std::array::from_fn(|side| place[side] - centre[side]);
        let [angle, velocity, omega] = std::array::from_fn(|side| MeanValueForm::unknown(side, centre[side], &over));
        let from = Impact { angle, velocity, turns: 0 };
        let halved = cell.halved[0] + cell.halved[1];
        match self.map.next(&from, omega) {
            Ok(next) => {
                let image = self.image([next.angle.value(), next.velocity.value()])?;
                if image.iter().all(|side| side.width() <= 1.0) || halved >= HALVINGS {
                    return Ok(Look::Whole(vec![image]));
                }
                let long = |side: usize| {
                    let by = [next.angle, next.velocity].map(|part| part.whole.by[side].magnitude().into());
                    let [across, up] = self.squares(by);
                    across.high().max(up.high()) * place[side].width()
                };
                Ok(Look::Halved(usize::from(long(1) > long(0))))
            }
            Err(_) if halved < GRAZING => Ok(Look::Halved(usize::from(cell.halved[1] < cell.halved[0]))),
            Err(_) => {
                // Time in which half a square passes.
                let shortest = 0.5 / f64::from(360 * self.per_degree) * (Interval::TURN / self.omega).middle();
                let contacts = self.map.contacts(&from, omega, shortest)?;
                Ok(Look::Whole(contacts.into_iter().map(|contact| self.image(contact)).collect::<Result<_, _>>()?))
            }
        }
    }

    fn region(&self, cover: &Cover, looks: usize) -> Region {
        let mut cells: Vec<&Cell> =
            cover.known.iter().filter(|(_, side)| side.is_none()).map(|(cell, _)| cell).collect();
        cells.sort();
        let degree = f64::from(self.per_degree);
        let place = |cell: &&Cell| {
            let [across, up] = [cell.side(0), cell.side(1)];
            [[across.low() / degree, across.high() / degree], [up.low() * self.height, up.high() * self.height]]
        };
        let places: Vec<[[f64; 2]; 2]> = cells.iter().map(place).collect();
        let ends = |side: usize| {
            let hull =
                |[least, most]: [f64; 2], place: &[[f64; 2]; 2]| [least.min(place[side][0]), most.max(place[side][1])];
            places.iter().fold([f64::INFINITY, 0.0], hull)
        };
        let [angles_deg, velocities_m_s] = [ends(0), ends(1)];
        let area: f64 =
            places.iter().map(|[angle, velocity]| (angle[1] - angle[0]) * (velocity[1] - velocity[0])).sum();
        Region {
            squares_per_degree: self.per_degree,
            square_m_s: self.height,
            cells: places.len(),
            looks,
            part: area / (360.0 * velocities_m_s[1]),
            velocities_m_s,
            angles_deg,
            places,
        }
    }
}
