//! Where orbits go when a number changes: branches of them, the points that they pass, and what runs settle on.

use super::{StudyError, inside, machine};
use crate::diagram::settled_impacts;
use crate::draw::Density;
use crate::model::Model;
use crate::orbit::branch::{Branch, Following};
use crate::orbit::{Family, Parameter, Search, search};
use crate::progress::Watch;

/// The branches through the orbits of one speed.
#[derive(Clone, Debug)]
pub struct Branches<'a> {
    model: &'a Model,
    from_rpm: f64,
    /// How they were followed.
    pub following: Following,
    /// Each branch once.
    pub branches: Vec<Branch>,
}

/// Follows the orbits that a search finds at `from_rpm`.
pub fn branches<'a>(
    model: &'a Model,
    from_rpm: f64,
    wanted: &Search,
    following: Following,
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
    let mut branches: Vec<Branch> = Vec::new();
    for (index, orbit) in orbits.iter().enumerate() {
        watch.at("following the orbits found", index as u64, orbits.len() as u64);
        if !branches.iter().any(|branch| branch.holds(value, orbit)) {
            branches.push(Branch::through(model, from_rpm, orbit, &following)?);
        }
    }
    Ok(Branches { model, from_rpm, following, branches })
}

impl Branches<'_> {
    /// What runs settle on at `count` values of what changes: phases of impacts in degrees; nothing for none.
    pub fn settled(&self, count: u32, watch: &dyn Watch) -> Result<Option<Density>, StudyError> {
        const TRANSIENT: u64 = 300;
        const RECORD: u64 = 100;
        if count == 0 {
            return Ok(None);
        }
        let family = Family::new(self.model, self.from_rpm, vec![self.following.parameter.clone()])?;
        let [low, high] = self.following.range;
        let mut density = Density::new([low, high], [0.0, 360.0]);
        for index in 0..count {
            watch.at("what runs settle on", u64::from(index), u64::from(count));
            let value = low + (high - low) * (f64::from(index) + 0.5) / f64::from(count);
            // The edge of what the model allows has been told already.
            let Ok((machine, _)) = family.machine(&[value]) else { continue };
            for angle in settled_impacts(&machine, TRANSIENT, RECORD)? {
                density.push(value, angle.to_degrees());
            }
        }
        Ok(Some(density))
    }

    /// What a picture of them is called.
    pub fn title(&self) -> String {
        let parameter = &self.following.parameter;
        let what = if *parameter == Parameter::Speed { "speed" } else { parameter.name() };
        format!("{}: orbits found at {} rpm, followed in {what}", self.model.name, self.from_rpm)
    }
}
