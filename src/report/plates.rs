//! The figures of a report, in the paper's order: one table.

use serde::Serialize;

use super::figure::Figure;
use super::figures::cam_figure;
use crate::gallery::Subject;

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
const TABLE: [Entry; 1] = [Entry {
    id: "cam",
    place: "Figure 3(b)",
    title: |subject| format!("{}: lift, velocity and acceleration of the cam", subject.model.name),
    draw: |subject, title| {
        Ok(Drawn {
            figure: cam_figure(&subject.cam, title),
            caption: "The lift of the cam and its two derivatives against the angle that it has turned. The dotted lines are the \
                      corners: the places where one of the three jumps."
                .into(),
        })
    },
}];

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
        let command = format!("corner-impact figure {} {} --out {}.svg", subject.model.file(), self.id, self.id);
        Plate { id: self.id, place: self.place, title, caption, command, figure, absent }
    }
}
