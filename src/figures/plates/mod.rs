//! The figures of a report, in the paper's order: one table.

mod drawn;

use serde::Serialize;

use crate::draw::Figure;
use crate::figures::{Fast, Slow, Subject};
use crate::show::command::command;

/// One figure of the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plate {
    /// Its name in commands.
    pub id: &'static str,
    /// Of which figure of the paper; empty for none.
    pub place: &'static str,
    /// What it is.
    pub title: String,
    /// What is shown and what to see, in one to three sentences; empty where there is no figure.
    pub caption: String,
    /// The command that makes this one.
    pub command: String,
    /// The figure.
    pub figure: Option<Figure>,
    /// Why there is none.
    pub absent: Option<String>,
}

/// A figure with what is to be seen in it.
struct Drawn {
    figure: Figure,
    caption: String,
}

/// A row of the table.
struct Entry {
    id: &'static str,
    place: &'static str,
    title: fn(&Subject) -> String,
    /// The figure under a title, or why there is none.
    draw: fn(&Subject, &str) -> Result<Drawn, String>,
}

/// Every figure, in the paper's order.
const TABLE: [Entry; 14] = [
    Entry {
        id: "cam-shape",
        place: "Figures 3(a) and 9",
        title: |subject| format!("{}: the cam, its segments and corners", subject.model.name),
        draw: drawn::cam_shape,
    },
    Entry {
        id: "cam",
        place: "Figure 3(b)",
        title: |subject| format!("{}: lift, velocity and acceleration of the cam", subject.model.name),
        draw: drawn::cam,
    },
    Entry {
        id: "slow-trace",
        place: "Figure 4(a) and (b)",
        title: |subject| {
            let with: fn(&Slow) -> String = if subject.is_paper {
                |slow| format!("chattering at {} rpm", slow.chattering)
            } else {
                |slow| format!("the motion at {} rpm", slow.chattering)
            };
            slow(subject, with, "a slow motion")
        },
        draw: drawn::slow_trace,
    },
    Entry {
        id: "slow-phase-plane",
        place: "Figure 4(c)",
        title: |subject| {
            slow(subject, |slow| format!("gap and its velocity at {} rpm", slow.chattering), "gap and its velocity")
        },
        draw: drawn::slow_phase_plane,
    },
    Entry {
        id: "slow-impacts",
        place: "Figure 5(a)",
        title: |subject| {
            slow(
                subject,
                |Slow { range: [low, high], .. }| format!("impacts on the cam, {low} to {high} rpm"),
                "impacts on the cam above detachment",
            )
        },
        draw: drawn::slow_impacts,
    },
    Entry {
        id: "interrupted-trace",
        place: "Figure 5(b)",
        title: |subject| slow(subject, |slow| format!("the motion at {} rpm", slow.interrupted), "another slow motion"),
        draw: drawn::interrupted_trace,
    },
    Entry {
        id: "fast-impacts",
        place: "Figure 5(c)",
        title: |subject| {
            fast(
                subject,
                |Fast { range: [low, high], .. }| format!("impacts and orbits, {low} to {high} rpm"),
                "impacts and orbits around the corner impact",
            )
        },
        draw: drawn::fast_impacts,
    },
    Entry {
        id: "fast-section",
        place: "Figure 5(d)",
        title: |subject| {
            fast(
                subject,
                |Fast { range: [low, high], .. }| format!("once a revolution, {low} to {high} rpm"),
                "once a revolution around the corner impact",
            )
        },
        draw: drawn::fast_section,
    },
    Entry {
        id: "corner-orbit",
        place: "Figure 5(e)",
        title: |subject| {
            let at = subject.found().map(|found| format!(" at {:.6} rpm", found.at.speed_rpm())).unwrap_or_default();
            format!("{}: the orbit whose impact is at the corner{at}", subject.model.name)
        },
        draw: drawn::corner_orbit,
    },
    Entry {
        id: "beyond-trace",
        place: "Figure 5(f)",
        title: |subject| {
            fast(subject, |fast| format!("the motion at {} rpm", fast.beyond), "the motion beyond the corner impact")
        },
        draw: drawn::beyond_trace,
    },
    Entry {
        id: "beyond-attractor",
        place: "",
        title: |subject| {
            fast(
                subject,
                |fast| format!("what the motion settles on at {} rpm", fast.beyond),
                "what the motion settles on beyond the corner impact",
            )
        },
        draw: drawn::beyond_attractor,
    },
    Entry {
        id: "composition",
        place: "Figure 6",
        title: |subject| format!("{}: the map of one revolution, composed of three", subject.model.name),
        draw: drawn::composition,
    },
    Entry {
        id: "discontinuity-mapping",
        place: "Figure 7",
        title: |subject| format!("{}: the discontinuity mapping on either side of the corner", subject.model.name),
        draw: drawn::discontinuity_mapping,
    },
    Entry {
        id: "local-map",
        place: "Figure 8",
        title: |subject| format!("{}: the orbits of the local map", subject.model.name),
        draw: drawn::local_map,
    },
];

/// A title with speeds above detachment, or without where there are none.
fn slow(subject: &Subject, with: fn(&Slow) -> String, without: &str) -> String {
    let words = subject.shown.slow.as_ref().map_or_else(|_| without.into(), with);
    format!("{}: {words}", subject.model.name)
}

/// A title with speeds around the corner impact, or without where there is none.
fn fast(subject: &Subject, with: fn(&Fast) -> String, without: &str) -> String {
    let words = subject.shown.fast.as_ref().map_or_else(|_| without.into(), with);
    format!("{}: {words}", subject.model.name)
}

/// A figure that can be asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Listed {
    /// Its name in commands.
    pub id: &'static str,
    /// Of which figure of the paper; empty for none.
    pub place: &'static str,
    /// What it is.
    pub title: String,
}

/// What there is to draw of a model, in order.
pub fn listed(subject: &Subject) -> Vec<Listed> {
    TABLE.iter().map(|entry| Listed { id: entry.id, place: entry.place, title: (entry.title)(subject) }).collect()
}

/// Every figure; `progress` is told how many of how many are done.
pub fn plates(subject: &Subject, progress: &mut dyn FnMut(usize, usize)) -> Vec<Plate> {
    let plates = TABLE.iter().enumerate().map(|(index, entry)| {
        progress(index, TABLE.len());
        entry.plate(subject)
    });
    let plates = plates.collect();
    progress(TABLE.len(), TABLE.len());
    plates
}

/// The figure of this name; `None` where the table has none.
pub fn plate(subject: &Subject, id: &str) -> Option<Plate> {
    TABLE.iter().find(|entry| entry.id == id).map(|entry| entry.plate(subject))
}

impl Entry {
    fn plate(&self, subject: &Subject) -> Plate {
        let title = (self.title)(subject);
        let (figure, caption, absent) = match (self.draw)(subject, &title) {
            Ok(Drawn { figure, caption }) => (Some(figure), caption, None),
            Err(why) => (None, String::new(), Some(why)),
        };
        let command = command("figure", &subject.model, &format!("{} --out {}.svg", self.id, self.id));
        Plate { id: self.id, place: self.place, title, caption, command, figure, absent }
    }
}
