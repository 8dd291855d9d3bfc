//! The document of a verification: one value, read by every renderer and every test of a report.
//!
//! Its fields are those of the `verify --json` contract, and more. Nothing is computed here; values are laid out.

use std::collections::BTreeMap;

use nalgebra::Matrix2;
use serde::Serialize;

use crate::agreement::Agreement;
use crate::border_collision::Refusal;
use crate::corner::CornerImpact;
use crate::corner::map::{CornerMap, Eigenvalue, Route, SideMap, Uncertainty};
use crate::model::Model;
use crate::published::{PrintedNumber, Verdict};
use crate::study::verify::border_collision::{
    ClassificationEntry, ConditionEntry, NormalFormEntry, OutcomeEntry, RangeEntry,
};
use crate::study::verify::{Findings, Skipped};

/// What `verify` found; serializes to the document `corner-impact/verify/1`.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// `corner-impact/verify/1`.
    pub schema: &'static str,
    /// Name and source of the model.
    pub model: ModelLabel,
    /// The orbit.
    pub corner_impact: Orbit,
    /// Further corner impacts in `[study]`; the one verified is the slowest.
    pub other_corner_impacts: Vec<Place>,
    /// The map by each route that ran.
    pub routes: BTreeMap<&'static str, RouteEntry>,
    /// Every comparison.
    pub agreement: Vec<AgreementEntry>,
    /// Of A- and A+, by the closed form.
    pub eigenvalues: Sides<[EigenvalueEntry; 2]>,
    /// Absent where the map is degenerate; `skipped` says why.
    pub normal_form: Option<NormalFormEntry>,
    /// Absent where the map is degenerate; `skipped` says why.
    pub classification: Option<ClassificationEntry>,
    /// Why there is no classification, where there is none.
    pub refusal: Option<String>,
    /// What classification, stability and normal form rest on.
    pub conditions: Vec<ConditionEntry>,
    /// The local map's own motions: faster, slower, and at the corner impact. Empty without a classification.
    pub local_map: Vec<OutcomeEntry>,
    /// How far the local map is within a tenth of the real one. Empty without a classification.
    pub linear_range: Vec<RangeEntry>,
    /// The paper's numbers; empty for another model.
    pub published: Vec<PublishedEntry>,
    /// What did not run, and why.
    pub skipped: Vec<SkippedEntry>,
    /// Whether every comparison agrees and every route of this program ran.
    pub agrees: bool,
}

/// Name and source of a model.
#[derive(Clone, Debug, Serialize)]
pub struct ModelLabel {
    /// Its name.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
}

/// A corner impact in brief.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Place {
    /// omega*, rpm.
    pub speed_rpm: f64,
    /// Of the corner, rad.
    pub cam_angle_rad: f64,
}

/// The orbit that hits the corner.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Orbit {
    /// T*.
    pub period_s: f64,
    /// Where T* was bracketed.
    pub period_bracket_s: [f64; 2],
    /// Of the equation for T*, over its terms.
    pub period_residual: f64,
    /// omega*.
    pub speed_rpm: f64,
    /// Of the corner.
    pub cam_angle_rad: f64,
    /// The paper's x*.
    pub state: [f64; 2],
    /// Position that x* is measured from, in the cam's coordinates.
    pub state_origin_m: f64,
    /// Miss of one simulated revolution, over the orbit's size.
    pub closure: f64,
    /// q = c at the impact.
    pub position_m: f64,
    /// v-.
    pub velocity_before_m_s: f64,
    /// v+.
    pub velocity_after_m_s: f64,
    /// c'.
    pub cam_velocity_m_s: f64,
    /// c'' before and after the corner.
    pub cam_acceleration_m_s2: Sides<f64>,
}

/// A pair of values, one for each side of the corner.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sides<T> {
    /// Impacts before the corner.
    pub minus: T,
    /// Impacts after the corner.
    pub plus: T,
}

/// One side's matrices, rows first.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SideEntry {
    /// 2x2.
    #[serde(rename = "A")]
    pub a: [[f64; 2]; 2],
    /// 2.
    #[serde(rename = "B")]
    pub b: [f64; 2],
}

/// A map as a document shows it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MapEntry {
    /// Impacts before the corner.
    pub minus: SideEntry,
    /// Impacts after the corner.
    pub plus: SideEntry,
    /// `h (A+ - A-)`.
    #[serde(rename = "C")]
    pub c: [f64; 2],
    /// `h (B+ - B-)`.
    #[serde(rename = "D")]
    pub d: f64,
}

/// A map and how well it is known.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RouteEntry {
    /// The map.
    #[serde(flatten)]
    pub map: MapEntry,
    /// Of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<Sides<SideEntry>>,
    /// Estimated bias of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub systematic_error: Option<Sides<SideEntry>>,
    /// Of a fit's scaled design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub condition_number: Option<f64>,
    /// Of an extrapolation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extrapolation_error: Option<Sides<SideEntry>>,
}

/// A comparison.
#[derive(Clone, Debug, Serialize)]
pub struct AgreementEntry {
    /// Which two routes.
    pub routes: [String; 2],
    /// In which quantity.
    pub quantity: String,
    /// Of any entry.
    pub max_abs_diff: f64,
    /// Of any entry, over that entry.
    pub max_rel_diff: f64,
    /// `max_abs_diff` must stay below.
    pub tolerance: f64,
    /// Why.
    pub reason: &'static str,
    /// Whether it does.
    pub agrees: bool,
}

/// An eigenvalue.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct EigenvalueEntry {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

/// A number of the paper.
#[derive(Clone, Debug, Serialize)]
pub struct PublishedEntry {
    /// Which.
    pub quantity: String,
    /// Where it stands.
    #[serde(rename = "where")]
    pub place: String,
    /// As printed.
    pub printed: Vec<String>,
    /// As computed.
    pub computed: Vec<f64>,
    /// Of any entry.
    pub max_abs_diff: f64,
    /// Most that the difference may be for the number to hold.
    pub tolerance: f64,
    /// Why.
    pub reason: &'static str,
    /// Whether it is below.
    pub agrees: bool,
    /// `holds`, `misprint` or `refuted`.
    pub verdict: Verdict,
    /// What is wrong.
    pub note: &'static str,
    /// Whether the comparison came out as the verdict says.
    pub as_found: bool,
}

/// Something that did not run.
#[derive(Clone, Debug, Serialize)]
pub struct SkippedEntry {
    /// The route, or the result that it would have given.
    pub route: String,
    /// Why.
    pub why: String,
    /// Whether it should have run.
    pub failed: bool,
}

impl Verification {
    /// Lays out what was found about `model`.
    pub fn new(model: &Model, findings: &Findings) -> Self {
        let Findings {
            at,
            others,
            routes,
            comparisons,
            border,
            normal_form,
            classification,
            refusal,
            conditions,
            outcomes,
            ranges,
            published,
            skipped,
            agrees,
        } = findings;
        let eigenvalues = |side: &SideMap| side.eigenvalues().map(|Eigenvalue { re, im }| EigenvalueEntry { re, im });
        let map = &findings.closed_form().map;
        Self {
            schema: "corner-impact/verify/1",
            model: ModelLabel { name: model.name.clone(), source: model.source.clone() },
            corner_impact: Orbit::new(at),
            other_corner_impacts: others
                .iter()
                .map(|at| Place { speed_rpm: at.speed_rpm(), cam_angle_rad: at.corner.angle })
                .collect(),
            routes: routes.iter().map(|route| (route.name, RouteEntry::new(route))).collect(),
            agreement: comparisons.iter().map(AgreementEntry::new).collect(),
            eigenvalues: Sides { minus: eigenvalues(&map.minus), plus: eigenvalues(&map.plus) },
            normal_form: normal_form.as_ref().map(NormalFormEntry::new),
            classification: classification.as_ref().map(|verdict| ClassificationEntry::new(verdict, *border)),
            refusal: refusal.as_ref().map(Refusal::to_string),
            conditions: conditions.iter().map(ConditionEntry::new).collect(),
            local_map: outcomes.iter().map(OutcomeEntry::new).collect(),
            linear_range: ranges.iter().map(RangeEntry::new).collect(),
            published: published.iter().map(PublishedEntry::new).collect(),
            skipped: skipped.iter().map(SkippedEntry::new).collect(),
            agrees: *agrees,
        }
    }
}

impl Orbit {
    fn new(at: &CornerImpact) -> Self {
        let [minus, plus] = at.cam_acceleration();
        Self {
            period_s: at.period,
            period_bracket_s: at.bracket,
            period_residual: at.residual,
            speed_rpm: at.speed_rpm(),
            cam_angle_rad: at.corner.angle,
            state: at.x_star().into(),
            state_origin_m: at.origin,
            closure: at.closure,
            position_m: at.corner.plus.value,
            velocity_before_m_s: at.velocity_before,
            velocity_after_m_s: at.velocity_after,
            cam_velocity_m_s: at.cam_velocity,
            cam_acceleration_m_s2: Sides { minus, plus },
        }
    }
}

pub(crate) fn rows(matrix: &Matrix2<f64>) -> [[f64; 2]; 2] {
    matrix.transpose().into()
}

impl SideEntry {
    pub(crate) fn new(side: &SideMap) -> Self {
        Self { a: rows(&side.a), b: side.b.into() }
    }
}

impl Sides<SideEntry> {
    fn new(map: &CornerMap) -> Self {
        Self { minus: SideEntry::new(&map.minus), plus: SideEntry::new(&map.plus) }
    }
}

impl SkippedEntry {
    pub(crate) fn new(skipped: &Skipped) -> Self {
        let Skipped { route, why, failed } = skipped.clone();
        Self { route, why, failed }
    }
}

impl RouteEntry {
    fn new(route: &Route) -> Self {
        let sides = Sides::new(&route.map);
        let map = MapEntry { minus: sides.minus, plus: sides.plus, c: route.map.c().into(), d: route.map.d() };
        let mut entry = Self {
            map,
            standard_error: None,
            systematic_error: None,
            condition_number: None,
            extrapolation_error: None,
        };
        match &route.uncertainty {
            Some(Uncertainty::Fit { standard, systematic, condition_number }) => {
                entry.standard_error = Some(Sides::new(standard));
                entry.systematic_error = systematic.as_ref().map(Sides::new);
                entry.condition_number = Some(*condition_number);
            }
            Some(Uncertainty::Extrapolation(correction)) => entry.extrapolation_error = Some(Sides::new(correction)),
            None => {}
        }
        entry
    }
}

impl AgreementEntry {
    pub(crate) fn new(agreement: &Agreement) -> Self {
        let Agreement { routes, quantity, max_abs_diff, max_rel_diff, bound, agrees } = agreement.clone();
        Self { routes, quantity, max_abs_diff, max_rel_diff, tolerance: bound.value, reason: bound.reason, agrees }
    }
}

impl PublishedEntry {
    fn new(number: &PrintedNumber) -> Self {
        let PrintedNumber { place, printed, computed, agreement, verdict, note, as_found } = number.clone();
        Self {
            quantity: agreement.quantity,
            place,
            printed,
            computed,
            max_abs_diff: agreement.max_abs_diff,
            tolerance: agreement.bound.value,
            reason: agreement.bound.reason,
            agrees: agreement.agrees,
            verdict,
            note,
            as_found,
        }
    }
}
