//! Continuation of orbits as a number changes: their branches, the special points on them, and the motions on which runs settle.

use super::{StudyError, inside, machine};
use crate::model::Model;
use crate::orbit::branch::{Branch, Following, FoundBranches, crossing, doubled};
use crate::orbit::{Family, Parameter, Search, search};
use crate::progress::{Pieces, Watch};
use crate::study::survey::settled_impacts;

/// The branches through the orbits of one speed.
#[derive(Clone, Debug)]
pub struct Branches<'a> {
    model: &'a Model,
    from_rpm: f64,
    /// Settings with which they were followed.
    pub following: Following,
    /// Each branch once.
    pub branches: Vec<Branch>,
}

document!(Branches<'_> as it {
    schema: "corner-impact/continue/1",
    model: it.model.name,
    speed_rpm: it.from_rpm,
    parameter: it.following.parameter.name(),
    branches: it.branches,
});

/// Follows the orbits that a search finds at `from_rpm`. Then it follows the orbits that branch off with twice the period or cross them,
/// and repeats this `doublings` times.
pub fn branches<'a>(
    model: &'a Model,
    from_rpm: f64,
    wanted: &Search,
    following: Following,
    doublings: u32,
    watch: &dyn Watch,
) -> Result<Branches<'a>, StudyError> {
    let value = inside(model, from_rpm, &following)?;
    let machine = machine(model, from_rpm)?;
    watch.at("looking for periodic orbits", 0, 0);
    let orbits = search(&machine, wanted)?;
    if orbits.is_empty() {
        let (file, revolutions) = (model.file().to_string(), wanted.revolutions);
        return Err(StudyError::NothingToFollow { file, revolutions, rpm: from_rpm });
    }
    let family = Family::new(model, from_rpm, vec![following.parameter.clone()])?;
    let mut found = FoundBranches::default();
    let pieces = |count: usize| Pieces::new(watch, "following branches of orbits", count);
    let orbits: Vec<_> = orbits.into_iter().map(|orbit| (value, orbit)).collect();
    let count = orbits.len();
    found.follow(&family, &following, orbits, &pieces(count));
    let mut before = 0;
    for _ in 0..doublings {
        let fresh = &found.branches[before..];
        let met = [doubled(&family, &following, fresh), crossing(&family, &following, fresh)].concat();
        before = found.branches.len();
        let count = met.len();
        found.follow(&family, &following, met, &pieces(count));
    }
    let FoundBranches { branches, failed } = found;
    failed.map_or(Ok(Branches { model, from_rpm, following, branches }), |error| Err(error.into()))
}

impl Branches<'_> {
    /// Returns impacts of the motions on which runs settle, at `count` rising values of the varied number: each value, and the cam angle
    /// of an impact, rad.
    pub fn settled(&self, count: u32, watch: &dyn Watch) -> Result<Vec<[f64; 2]>, StudyError> {
        const TRANSIENT: u64 = 300;
        const RECORD: u64 = 100;
        let family = Family::new(self.model, self.from_rpm, vec![self.following.parameter.clone()])?;
        let [low, high] = self.following.range;
        let mut settled = Vec::new();
        for index in 0..count {
            watch.at("what runs settle on", u64::from(index), u64::from(count));
            let value = low + (high - low) * (f64::from(index) + 0.5) / f64::from(count);
            // The edge of the values that the model allows has been reported already.
            let Ok((machine, _)) = family.machine(&[value]) else { continue };
            settled.extend(settled_impacts(&machine, TRANSIENT, RECORD)?.into_iter().map(|angle| [value, angle]));
        }
        Ok(settled)
    }

    /// Title of a picture of the branches.
    pub fn title(&self) -> String {
        let parameter = &self.following.parameter;
        let what = if *parameter == Parameter::Speed { "speed" } else { parameter.name() };
        format!("{}: orbits found at {} rpm, followed in {what}", self.model.name, self.from_rpm)
    }
}
