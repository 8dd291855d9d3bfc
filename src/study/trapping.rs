//! Trapping regions at a speed: regions of impacts that the impact map sends into themselves.

use serde::Serialize;

use crate::cam::Cam;
use crate::corner::locate;
use crate::covering::region::{OpenRegion, Region, parted, trap};
use crate::covering::sample::impacts;
use crate::covering::{HSet, HSetFrame};
use crate::elementary;
use crate::interval::Interval;
use crate::model::Model;
use crate::progress::Watch;
use crate::study::{StudyError, machine};

/// Trapping regions, and the failed attempts to prove one.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Trapping {
    /// The region next to the corner impact, if there is one, before the region of all motions.
    pub regions: Vec<Trapped>,
    /// Reason why the attempt failed, for each size of squares without a region.
    pub escapes: Vec<OpenRegion>,
}

/// A trapping region.
#[derive(Clone, Debug)]
pub struct Trapped {
    /// The region.
    pub region: Region,
    /// Whether the strips of the last theorem at the speed lie in the region, and with them its set of chaotic motions.
    pub holds_chaos: bool,
    /// Least factor by which some deviations of every motion in the region grow at each impact; none if not proved.
    pub parted: Option<f64>,
}

document!(Trapped as it {
    proved: true,
    holds_chaos: it.holds_chaos,
    least_growth_per_impact: it.parted,
    region: it.region,
});

/// Impacts of a run, impacts left out before, and the largest number of cells: some ten seconds of work.
const SHOWN: usize = 5_000;
const SETTLING: usize = 500;
const CELLS: usize = 30_000;

/// Looks for trapping regions at a speed, rpm. First it looks next to the corner impact. Then it looks about the strips of an h-set, or
/// about the impacts of a run from there or from rest.
pub(super) fn trapping(model: &Model, rpm: f64, set: Option<&HSet>, watch: &dyn Watch) -> Result<Trapping, StudyError> {
    let machine = machine(model, rpm)?;
    let mut found = Trapping::default();
    let closed = |impacts: &[[Interval; 2]], squares_per_degree, holds_chaos| {
        let region = trap(&machine, rpm, impacts, squares_per_degree, CELLS, watch)?;
        Ok(Trapped { parted: parted(&machine, rpm, &region), region, holds_chaos })
    };
    let point = |[angle, velocity]: [f64; 2]| [Interval::from(angle.to_radians()), velocity.into()];
    if let Some(run) = beside_the_corner_impact(model, rpm)? {
        let angles = run.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], [angle, _]| {
            [least.min(*angle), most.max(*angle)]
        });
        let run: Vec<[Interval; 2]> = run.into_iter().map(point).collect();
        /// Numbers of squares across the run, the fewest first, and the most squares a degree that rounding allows.
        const ACROSS: [f64; 3] = [32.0, 64.0, 128.0];
        const FINEST: f64 = 1_048_576.0;
        for across in ACROSS {
            let squares = elementary::exp2(elementary::log2(across / (angles[1] - angles[0])).ceil());
            if (1.0..=FINEST).contains(&squares)
                && let Ok(trapped) = closed(&run, squares as u32, false)
            {
                found.regions.push(trapped);
                break;
            }
        }
    }
    let start = set.map_or([0.0; 2], |set| [set.centre[0].to_radians(), set.centre[1]]);
    let run: Vec<[Interval; 2]> = impacts(&machine, start, SETTLING, SHOWN)?.into_iter().map(point).collect();
    let strips: Vec<[Interval; 2]> = set.map_or_else(Vec::new, |set| {
        let frame = HSetFrame::new(set);
        set.strips.iter().flat_map(|strip| frame.rectangles(set, strip)).collect()
    });
    for squares_per_degree in [1, 2] {
        let about_strips = (!strips.is_empty()).then(|| closed(&strips, squares_per_degree, true).ok()).flatten();
        match about_strips.map_or_else(|| closed(&run, squares_per_degree, false), Ok) {
            Ok(trapped) => {
                found.regions.push(trapped);
                break;
            }
            Err(escape) => found.escapes.push(escape),
        }
    }
    Ok(found)
}

/// Returns the impacts of a run that starts with the corner impact of `[study]`, if there is one and the run stays next to it.
fn beside_the_corner_impact(model: &Model, rpm: f64) -> Result<Option<Vec<[f64; 2]>>, StudyError> {
    /// Farthest distance that counts as next to the corner impact, degrees.
    const BESIDE: f64 = 5.0;
    let Ok((corner_impact, _)) = locate(model, &Cam::new(model)?) else { return Ok(None) };
    let angle = corner_impact.corner.angle;
    let velocity = corner_impact.velocity_after - corner_impact.cam_velocity;
    let run = impacts(&machine(model, rpm)?, [angle, velocity], SETTLING, SHOWN)?;
    let is_beside = |[at, _]: &[f64; 2]| (at - angle.to_degrees()).abs() < BESIDE;
    Ok(Some(run).filter(|run| !run.is_empty() && run.iter().all(is_beside)))
}
