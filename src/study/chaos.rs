//! Proofs of sets of chaotic motions, at a speed or at every speed of a range, and how near a failed proof came.

use crate::cam::Cam;
use crate::covering::find::{ProofScope, Proved, Short, find};
use crate::covering::prove::{Covered, Refused, prove};
use crate::covering::sample::{Line, impacts};
use crate::covering::{HSet, known};
use crate::known::Evidence;
use crate::model::Model;
use crate::progress::Watch;
use crate::study::trapping::{Trapping, trapping};
use crate::study::{StudyError, hypotheses, machine};

/// The proofs of a model's chaos: the document of `chaos --json`.
#[derive(Clone, Debug)]
pub struct Chaos {
    /// The model's name.
    pub model: String,
    /// Range of speeds, rpm.
    pub rpm: [f64; 2],
    /// Hypotheses on the machine, for all proofs.
    pub hypotheses: Vec<&'static str>,
    /// Theorems, by rising speed.
    pub theorems: Vec<Theorem>,
    /// Ranges of speeds at which nothing is proved.
    pub open: Vec<Open>,
    /// Trapping regions at the lowest speed, if requested.
    pub trapping: Option<Trapping>,
}

document!(Chaos as it {
    schema: "corner-impact/chaos/1",
    model: it.model,
    rpm: it.rpm,
    known: Evidence::proved_if(it.proves_something()),
    hypotheses: it.hypotheses,
    theorems: it.theorems,
    open: it.open,
    trapping if_any: it.trapping,
});

impl Chaos {
    /// Whether there is a set of chaotic motions or a trapping region.
    pub fn proves_something(&self) -> bool {
        !self.theorems.is_empty() || self.trapping.as_ref().is_some_and(|trapping| !trapping.regions.is_empty())
    }
}

/// A set of chaotic motions at every speed of a range.
#[derive(Clone, Debug)]
pub struct Theorem {
    /// The h-set for this range of speeds, with the strips that are proved to cover it.
    pub set: HSet,
    /// Proof of each strip.
    pub strips: Vec<Covered>,
    /// Strips whose proof failed.
    pub refused: Vec<Refused>,
    /// Hypotheses of the theorem.
    pub hypotheses: Vec<&'static str>,
}

document!(Theorem as it {
    rpm: it.set.rpm,
    symbols: it.set.strips.iter().map(|strip| strip.impacts).collect::<Vec<_>>(),
    entropy_per_revolution: it.set.entropy(),
    cones: it.set.cone_slope.is_some(),
    proved: true,
    hypotheses: it.hypotheses,
    h_set: it.set,
    strips: it.strips,
    refused: it.refused,
});

/// Speeds at which no chaos is proved, with the result of the search.
#[derive(Clone, Debug)]
pub struct Open {
    /// Range of speeds, rpm.
    pub rpm: [f64; 2],
    /// Result of the search.
    pub short: Short,
}

document!(Open as it {
    rpm: it.rpm,
    saddles: it.short.saddles,
    strips: it.short.strips,
    refused: it.short.refused,
});

/// Widest and narrowest range of speeds, rpm, for which one h-set is looked for. A narrower range counts as one speed: as much as
/// possible is proved there.
const WIDEST: f64 = 0.5;
const NARROWEST: f64 = 0.03;

/// Looks for sets of chaotic motions at a speed, or at every speed of a range, rpm. If requested, it also looks for trapping regions at
/// the lowest speed.
pub fn chaos(model: &Model, rpm: [f64; 2], wants_regions: bool, watch: &dyn Watch) -> Result<Chaos, StudyError> {
    let mut found = sets(model, rpm, watch)?;
    if wants_regions {
        // The strips of a range's higher speeds lie elsewhere.
        let strips = found.theorems.iter().map(|theorem| &theorem.set).rfind(|set| set.rpm[0] == rpm[0]);
        found.trapping = Some(trapping(model, rpm[0], strips, watch)?);
    }
    Ok(found)
}

fn sets(model: &Model, rpm: [f64; 2], watch: &dyn Watch) -> Result<Chaos, StudyError> {
    let hypotheses = hypotheses(&Cam::new(model)?);
    let mut found = Chaos {
        model: model.name.clone(),
        rpm,
        hypotheses: hypotheses.clone(),
        theorems: Vec::new(),
        open: Vec::new(),
        trapping: None,
    };
    let is_one = |[low, high]: [f64; 2]| high - low <= NARROWEST;
    let wanted = match is_one(rpm) {
        true => ProofScope { strips: 8, cones: true },
        false => ProofScope { strips: 3, cones: false },
    };
    let kept: Vec<HSet> = known(&model.name).into_iter().filter(|set| is_one(set.rpm) == is_one(rpm)).collect();
    let (mut from, mut width) = (rpm[0], WIDEST);
    loop {
        watch.at("h-sets that cover themselves: rpm", (from - rpm[0]) as u64, (rpm[1] - rpm[0]) as u64);
        let machine = machine(model, from)?;
        let holds = |set: &&HSet| set.rpm[0] <= from && (from < set.rpm[1] || rpm[1] <= set.rpm[1]);
        let by_known = kept.iter().find(holds).and_then(|set| {
            let set = HSet { rpm: [from, rpm[1].min(set.rpm[1])], ..set.clone() };
            Some(Proved { strips: prove(&machine, &set).ok()?, set, without_cones: None, refused: Vec::new() })
        });
        let next = kept.iter().map(|set| set.rpm[0]).filter(|next| *next > from).fold(rpm[1], f64::min);
        let to = by_known.as_ref().map_or(next.min(from + width), |proved| proved.set.rpm[1]);
        match by_known.map_or_else(|| find(&machine, [from, to], wanted, watch), |proved| Ok(Ok(proved)))? {
            Ok(Proved { set, strips, without_cones, refused }) => {
                found.theorems.push(Theorem { set, strips, refused, hypotheses: hypotheses.clone() });
                found.theorems.extend(without_cones.map(|(set, strips)| Theorem {
                    set,
                    strips,
                    refused: Vec::new(),
                    hypotheses: hypotheses.clone(),
                }));
                width = WIDEST.min(2.0 * width);
            }
            Err(_) if to - from > NARROWEST => {
                width = 0.5 * (to - from);
                continue;
            }
            Err(short) => found.open.push(Open { rpm: [from, to], short }),
        }
        from = to;
        if from >= rpm[1] {
            return Ok(found);
        }
    }
}

/// The drawing of a theorem: impacts of a long run, and the strips' images, in degrees of the cam and m/s relative to it.
#[derive(Clone, Debug)]
pub struct Portrait {
    /// Impacts of a run that starts in the h-set.
    pub impacts: Vec<[f64; 2]>,
    /// Outline of each strip's image, where it is found.
    pub images: Vec<Vec<[f64; 2]>>,
}

/// Computes the drawing of a theorem at its lowest speed.
pub fn portrait(model: &Model, set: &HSet) -> Result<Portrait, StudyError> {
    /// Number of impacts of the run, and of those left out before.
    const SHOWN: usize = 400_000;
    const SETTLING: usize = 500;
    /// Number of points along each side of an image.
    const POINTS: usize = 400;
    let machine = machine(model, set.rpm[0])?;
    let impacts = impacts(&machine, [set.centre[0].to_radians(), set.centre[1]], SETTLING, SHOWN)?;
    let images = set.strips.iter().map(|strip| {
        let points = |part: usize| strip.x[0] + (strip.x[1] - strip.x[0]) * part as f64 / POINTS as f64;
        let side = |y: f64| {
            let points = (0..=POINTS).map(points).collect();
            let line = Line::new(&machine, set, y, points, strip.impacts as usize);
            let arrived = line.arrivals.iter().filter_map(|arrivals| arrivals.get(strip.impacts as usize - 1));
            arrived.map(|arrival| set.at([arrival.x, arrival.y])).collect::<Vec<_>>()
        };
        let [low, high] = set.y.map(side);
        low.into_iter().chain(high.into_iter().rev()).collect()
    });
    Ok(Portrait { impacts, images: images.collect() })
}
