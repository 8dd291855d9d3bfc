//! Commented model files as starting points, one for each law of the cam.

/// Law with its part of a model file.
pub struct ModelTemplate {
    /// Name of the law in `[cam]`.
    pub law: &'static str,
    cam: &'static str,
    /// Name and text of the table that the file names; its follower fits the size of the cam.
    pub table: Option<(&'static str, &'static str)>,
    /// Whether the cam has corners of order 2, so that `verify` can search for corner impacts.
    has_study: bool,
}

/// Name of the machine in the templates.
pub const TEMPLATE_NAME: &str = "my-machine";

const FOLLOWER: &str = include_str!("templates/follower.toml");
const STUDY: &str = include_str!("templates/study.toml");

const fn template(law: &'static str, cam: &'static str, has_study: bool) -> ModelTemplate {
    ModelTemplate { law, cam, table: None, has_study }
}

/// Laws in the order of `new --help`.
pub static TEMPLATES: [ModelTemplate; 7] = [
    template("arcs", include_str!("templates/arcs.toml"), true),
    template("harmonic", include_str!("templates/harmonic.toml"), false),
    template("rectified-sine", include_str!("templates/rectified-sine.toml"), false),
    template("program", include_str!("templates/program.toml"), true),
    template("polynomial", include_str!("templates/polynomial.toml"), true),
    ModelTemplate {
        table: Some(("lifts.csv", include_str!("templates/lifts.csv"))),
        ..template("table", include_str!("templates/table.toml"), false)
    },
    ModelTemplate {
        table: Some(("contour.csv", include_str!("templates/contour.csv"))),
        ..template("contour", include_str!("templates/contour.toml"), false)
    },
];

impl ModelTemplate {
    /// Template of a law.
    pub fn of(law: &str) -> Option<&'static Self> {
        TEMPLATES.iter().find(|template| template.law == law)
    }

    /// Text of the model file.
    pub fn text(&self) -> String {
        // A measured cam comes with a follower of its size.
        let follower = if self.table.is_some() { "" } else { FOLLOWER };
        let study = if self.has_study { STUDY } else { "" };
        let text = [follower, self.cam, study].concat();
        text.trim_end().to_owned() + "\n"
    }

    /// Text of a model file that needs no table beside it.
    pub fn whole(&self) -> String {
        let Some((name, table)) = self.table else { return self.text() };
        let is_row = |line: &&str| line.starts_with(|first: char| first.is_ascii_digit());
        let rows: Vec<String> = table.lines().filter(is_row).map(|row| format!("[{row}]")).collect();
        let named = format!("file = \"{name}\"");
        self.text().replace(&named, &format!("rows = [{}]", rows.join(", ")))
    }
}
