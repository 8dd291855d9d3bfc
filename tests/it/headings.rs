//! Are the words and units above a table of lifts understood, or refused with the line of the model that makes them read?

use std::fmt::Write;

use tempfile::TempDir;

use crate::reading::{is_the_lobe, lift, model, reading};

/// A table with the lobe in every second degree: these lines, and rows in which A is the angle, L the lift and N the row's number.
fn table(head: &str, row: &str) -> String {
    let mut text = format!("{head}\n");
    for (number, angle) in (0..360).step_by(2).enumerate() {
        let lift = format!("{:.4}", lift(f64::from(angle)));
        let row = row.replace('A', &angle.to_string()).replace('L', &lift).replace('N', &(number + 1).to_string());
        writeln!(text, "{row}").unwrap();
    }
    text
}

fn refusal(csv: &str, fields: &str) -> String {
    let Err(words) = model(&TempDir::new().unwrap(), csv, fields) else { panic!("{:?} is read", &csv[..60]) };
    words
}

/// Rows by the signs that part them.
const COMMA: &str = "A,L";
const SEMICOLON: &str = "A;L";
const BLANKS: &str = "A  L";
const TAB: &str = "A\tL";

#[test]
fn headers_are_read_wherever_they_stand() {
    for (head, row, size) in [
        // In comments, where no other line is a header.
        ("# Angle [deg], Lift [in]", COMMA, 25.4),
        ("# Angle [deg], Lift [in]", BLANKS, 25.4),
        ("% angle lift\n% deg in", BLANKS, 25.4),
        ("* Cam Angle (deg)\tLift (inch)", TAB, 25.4),
        ("// theta[deg],h[um]", COMMA, 1e-3),
        ("# by hand\n# angle_deg lift_cm\n# 360 rows", BLANKS, 10.0),
        ("#Angle;Lift;\n#[deg];[in];", SEMICOLON, 25.4),
        ("#\tAngle\tLift\n#\tdeg\tinch", TAB, 25.4),
        ("*** DEG   LIFT(IN) ***", BLANKS, 25.4),
        ("\u{a0}* DEG   LIFT(IN)", BLANKS, 25.4),
        ("#,Angle [deg],Lift [in]", "N,A,L", 25.4),
        ("# Rocker ratio 1.5, lash 0.25 mm\n# angle_deg, lift_in", COMMA, 25.4),
        ("# Lift [in], Angle [deg]", "L,A", 25.4),
        ("# speed 3, lift 4\nangle,lift", COMMA, 1.0),
        // A unit that any of the lines names is used.
        ("# Angle [deg], Lift [in]\nangle,lift", COMMA, 25.4),
        ("Angle [deg],Lift [in]\nangle,lift", COMMA, 25.4),
        ("angle,lift\n# deg,in", COMMA, 25.4),
        ("Angle;Lift\n°;mm", SEMICOLON, 1.0),
        ("Angle,Lift\n\"deg\",\"in\"", COMMA, 25.4),
        ("angle,lift\n-,in", COMMA, 25.4),
        ("angle lift\n(DEG) (IN)", BLANKS, 25.4),
        ("(DEG) (IN)", BLANKS, 25.4),
        ("deg,\"", COMMA, 25.4),
        ("no,angle,lift,force\n-,deg,in,kN", "N,A,L,3", 25.4),
        ("angle,lift,p\n[deg],[in],[bar]", "A,L,3", 25.4),
        ("ANGLE   LIFT   VEL\nDEG     IN     IN/DEG", "A L 0", 25.4),
        ("deg,in,in/deg,in/deg^2", "A,L,0,0", 25.4),
        // Titles and comments may have units that are no other.
        ("angle,lift  # deg, mm", COMMA, 1.0),
        ("# lifts in mm\nangle,lift", COMMA, 1.0),
        ("# dial gauge, 0.001 mm\nangle,lift", COMMA, 1.0),
        ("# intake cam, dial gauge 0.01 mm\nangle,lift", COMMA, 1.0),
        ("# cam 3; gauge 1/100 mm\nangle;lift", SEMICOLON, 1.0),
        ("# mm, by dial gauge\nangle,lift", COMMA, 1.0),
        ("# cam of the press, read on a gauge with 0.01 mm\nangle,lift", COMMA, 1.0),
        ("# lift by dial gauge, accuracy 0.01 mm\nangle,lift", COMMA, 1.0),
        ("# intake cam cylinder 1, dial gauge 0.001 mm\ncam angle [deg],valve lift [in]", COMMA, 25.4),
        ("# angle in deg, lift in 1/100 mm\nangle,lift", COMMA, 0.01),
        ("Base circle radius 18,0 mm\nangle;lift", SEMICOLON, 1.0),
        ("Base circle radius 18,0 mm", COMMA, 1.0),
        ("Centre at 110 deg, for 240 deg\nangle,lift", COMMA, 1.0),
        ("Two turns of m on foot, in rev 3\nangle,lift", COMMA, 1.0),
        ("\"Cam 2\" of 1998, in steel\nangle,lift", COMMA, 1.0),
        ("Lobe: INT,Base Dia (mm),36\nDegree,Lift (in),Vel (in/deg)", "A,L,0", 25.4),
        ("20 °C, 3 mm/s\nangle,lift", COMMA, 1.0),
        // The header may be parted otherwise than the rows.
        ("Cam Angle  Valve Lift", BLANKS, 1.0),
        ("Cam Angle\tValve Lift in inch", BLANKS, 25.4),
        ("Cam angle (deg)    Lift of valve (in)", BLANKS, 25.4),
        ("Angle (deg), Valve Lift (in)", BLANKS, 25.4),
        ("Angle of cam; Valve lift in inches", BLANKS, 25.4),
        ("Angle of cam | Valve lift in inches", BLANKS, 25.4),
        ("Angle, deg, Lift, in", COMMA, 25.4),
        ("Cam Angle [deg]   Valve Lift [in]   Valve Velocity [in/rad]", "A   L   0", 25.4),
        ("angle lift [0.01 mm]", BLANKS, 0.01),
        // A sign in a name is no comment.
        ("Pt #,Angle,Lift", "N,A,L", 1.0),
        ("Pt # ;Angle;Lift", "N;A;L", 1.0),
        ("Pt #  Angle  Lift", "N A L", 1.0),
        ("Angle,Lift,Pt #", "A,L,N", 1.0),
        ("Angle,Lift,#", "A,L,N", 1.0),
        ("Cam #,Angle,Lift", "N,A,L", 1.0),
        // Units above other columns do not count.
        ("deg,mm,mm/s2", "A,L,0", 1.0),
        ("angle,lift,area\n-,mm,mm^2", "A,L,0", 1.0),
        ("angle,lift,area\n-,in,in^2", "A,L,0", 25.4),
        // A title or a comment may have a rate, an accuracy, or a part of a unit that is not of the lift.
        ("# cm/deg\nangle,lift", COMMA, 1.0),
        ("# velocity in cm/s\nangle,lift", COMMA, 1.0),
        ("# lift ± 0.01 mm\nangle,lift", COMMA, 1.0),
        ("# dial: mm\nangle,lift", COMMA, 1.0),
        ("# mm x10\nangle,lift", COMMA, 1.0),
        ("# mm/100\nangle,lift", COMMA, 1.0),
        ("5\" cam\nangle,lift", COMMA, 1.0),
        // The column of the angle is the second.
        ("Hub,Position θ", "L,A", 1.0),
        ("lift,pos [deg]", "L,A", 1.0),
        ("lift no 1,angle", "L,A", 1.0),
    ] {
        is_the_lobe(&table(head, row), "", size);
    }
}

/// Header cells of an angle and a lift, and the size of one lift in millimetres.
#[test]
fn words_and_units_are_known() {
    for (angle, lift, size) in [
        ("Nockenwinkel [°]", "Ventilhub [mm]", 1.0),
        ("Kurbelwinkel", "Ventilerhebung in Zoll", 25.4),
        ("°NW", "Hub", 1.0),
        ("Winkel [°NW]", "Erhebung [in]", 25.4),
        ("°KW", "Hub/mm", 1.0),
        ("angle (°CA)", "lift", 1.0),
        ("angolo (gradi)", "alzata (pollici)", 25.4),
        ("angle de came (degrés)", "levée (mm)", 1.0),
        ("CamAngleDeg", "ValveLiftInch", 25.4),
        ("'Angle'", "'Lift'", 1.0),
        ("θ/°", "s/in", 25.4),
        ("Cam Degrees / deg", "lift /mm", 1.0),
        ("θ [°]", "s(θ) [in]", 25.4),
        ("Angle (cam) [deg]", "Lift (exhaust valve) [in]", 25.4),
        ("angle [º]", "lift", 1.0),
        ("[Angle]", "(Lift)", 1.0),
        ("Lobe 1 deg", "Lobe 1 lift in", 25.4),
        ("Grad Nockenwelle", "Lift 2 in", 25.4),
        ("angle 0", "lift 0 in", 25.4),
        ("angle", "Lift x 2 [in]", 25.4),
        ("angle", "Lift 1/2 [in]", 25.4),
        ("angle", "lift in.", 25.4),
        ("angle", "lift [in.]", 25.4),
        ("Angle", "Lift (\")", 25.4),
        ("Angle", "\"Lift (\"\")\"", 25.4),
        ("Angle", "Lift ″", 25.4),
        ("Angle", "Lift in (in)", 25.4),
        ("Angle", "lift (1 in)", 25.4),
        ("Angle", "M (in)", 25.4),
        // Parts of a unit.
        ("angle", "Hub in 1/100 mm", 0.01),
        ("angle", "Lift in 0.01 mm", 0.01),
        ("angle", "Lift [mm/100]", 0.01),
        ("angle", "Hub [1/100mm]", 0.01),
        ("angle", "Lift [0,01 mm]", 0.01),
        ("angle", "hundredths of mm", 0.01),
        ("angle", "Hub in Hundertstel mm", 0.01),
        ("angle", "Lift (tenths of mm)", 0.1),
        ("angle", "Lift 0.1 mm", 0.1),
        ("angle", "Lift .1 mm", 0.1),
        ("angle", "Lift thousandths of an inch", 0.0254),
        ("angle", "Lift 1/1000\"", 0.0254),
        ("angle", "Lift [0.001 in]", 0.0254),
        ("angle", "Lift (10^-3 in)", 0.0254),
        ("angle", "Lift [10⁻² mm]", 0.01),
        ("angle", "Lift [1e-3 m]", 1.0),
        ("angle", "Lift [0.000001 m]", 1e-3),
        ("angle", "lift in [0.01 mm]", 0.01),
        ("angle", "lift in [tenths mm]", 0.1),
        ("angle", "lift in mm/100", 0.01),
        // Other words beside a unit.
        ("angle", "″ (lift)", 25.4),
        ("angle", "Lift (\" valve \")", 25.4),
        ("Angle \"deg\"", "Lift \"mm\"", 1.0),
        ("angle in [deg]", "lift in [mm]", 1.0),
        ("angle [deg]", "[in] lift", 25.4),
        ("CA", "in (lift)", 25.4),
        ("angle", "lift in (valve) net", 25.4),
        ("angle", "lift in net x", 1.0),
        ("angle", "lift mm 1", 1.0),
        ("angle", "lift mm s", 1.0),
        ("angle", "lift mm deg", 1.0),
        ("angle", "lift no 1", 1.0),
        ("angle", "lift '", 1.0),
        ("angle", "5' lift", 1.0),
        ("angle", "displ vs dθ", 1.0),
    ] {
        is_the_lobe(&table(&format!("{angle};{lift}"), SEMICOLON), "", size);
    }
    let told = |head: &str| reading(&table(head, SEMICOLON), "");
    let [hundredths, thou] = ["angle;Hub in 1/100 mm", "angle;Lift 1/1000\""].map(told);
    assert_eq!(
        (&hundredths["unit"], &hundredths["part"], &hundredths["step"]),
        (&"mm".into(), &"0.01 mm".into(), &1e-6.into())
    );
    assert_eq!((&thou["unit"], &thou["part"]), (&"thou".into(), &serde_json::Value::Null));
    let units = told("deg;in");
    assert_eq!((&units["header"], &units["units"]), (&serde_json::Value::Null, &"deg;in".into()));
}

/// A quantity that is neither the angle nor the lift is left out.
#[test]
fn other_columns_are_left_out() {
    for head in [
        "angle [deg];y [mm];y1 [mm/rad];y2 [mm/rad^2]",
        "angle [deg];s [mm];c [mm/deg];d [mm/deg²]",
        "angle [deg];s [mm];c [mm per deg];d [mm rad^-1]",
        "angle [deg];s [mm];c [mm/s];d [deg/s]",
        "Angle;Lift;Lift';Lift''",
        "θ;s;s'(θ);s’’",
        "Angle;Lift;Lift rate;Lift error",
        "Winkel;Hub;Krümmungsradius;Geschwindigkeit",
        "angle;s;ds/dθ;d2s/dθ2",
        "angle;s;ds/dt;j",
        "Winkel [°];Erhebung [mm];Krümmungsradius [mm];#",
        "Angle de came (°);Levée (mm);Vitesse",
        "Angle (deg);Lift (mm);R (mm);radius",
        "Angle (deg);Lift (mm);Temp [°C];x [kN]",
        "Angle (deg);Lift (\");v (\"/deg);()",
        "Crank angle;Lift;Cam angle;t",
        "Angle;Lift;cam vel",
        "θ;s;()",
    ] {
        let is_turned = head.starts_with("Crank");
        let row = if is_turned { "0;L;A;0" } else { &"A;L;0;0"[..2 * head.split(';').count() - 1] };
        let size = if head.contains('"') { 25.4 } else { 1.0 };
        is_the_lobe(&table(head, row), "", size);
    }
}

#[test]
fn a_unit_that_is_not_understood_is_refused_with_the_line_that_says_it() {
    let [one_of, multiple] = ["the unit of the lift must be one of", "names a multiple of a unit"];
    // Header, complaint, and the line of the model with which it is read as one millimetre or so.
    for (head, says, line, size) in [
        ("angle;Lift*100 mm", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift x1000 (in)", multiple, "unit = \"thou\"", 0.0254),
        ("angle;Lift x 100 [mm]", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift [mm x 100]", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift × 1000 [m]", multiple, "unit = \"mm\"", 1.0),
        ("angle;Lift/100 [mm]", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift [mm] / 100", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift 0.01 [mm]", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift*0.01 mm", one_of, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift mm × 0.01", one_of, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift mm 0.01", one_of, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift [mm × 1]", one_of, "unit = \"mm\"", 1.0),
        ("angle;valve lift [mm × 0.01] 0.1", multiple, "unit = \"0.1 mm\"", 0.1),
        ("angle;Hub in 1/100 1/100 mm", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Hub/C", one_of, "unit = \"mm\"", 1.0),
        ("angle;s/dθ", one_of, "unit = \"mm\"", 1.0),
        ("angle;valve M [mm]", "name both m and mm", "unit = \"mm\"", 1.0),
        ("angle;(M) mm", "name both m and mm", "unit = \"mm\"", 1.0),
        ("angle % [deg];lift", "the unit of the angle must be one of", "angle_unit = \"deg\"", 1.0),
        ("angle x 10;lift", "the unit of the angle must be one of", "angle_unit = \"deg\"", 1.0),
        ("angle;Lift in hundredths (mm)", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift thousandths (inch)", multiple, "unit = \"thou\"", 0.0254),
        ("angle;lift (1/16 in)", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift [0.5 mm]", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift [2 mm]", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift 12 mm", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift [10 mm]", multiple, "unit = \"0.1 mm\"", 0.1),
        ("angle;lift hundredths", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;Lift /100", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;lift (x10)", multiple, "unit = \"0.1 mm\"", 0.1),
        ("angle;lift [mm²]", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift mm2", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift [1]", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift [-]", one_of, "unit = \"mm\"", 1.0),
        ("angle;Hub [1/100]", multiple, "unit = \"0.01 mm\"", 0.01),
        ("angle;lift [%]", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift (%)", one_of, "unit = \"mm\"", 1.0),
        ("angle [deg];lift % of 8 mm", one_of, "unit = \"mm\"", 1.0),
        ("angle [deg];lift %", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift deg", one_of, "unit = \"mm\"", 1.0),
        ("angle;Lift\"", one_of, "unit = \"in\"", 25.4),
        ("angle;Hub / Elle", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift in/mm", one_of, "unit = \"mm\"", 1.0),
        ("angle;lift\ndeg;furlong", one_of, "unit = \"mm\"", 1.0),
        ("angle [°C];lift", "the unit of the angle must be one of", "angle_unit = \"deg\"", 1.0),
        ("Angle [deg];Lift (mm) inches", "name both mm and in", "unit = \"mm\"", 1.0),
        ("Angle [deg];Lift [mm]\nDEG;INCH", "name both mm and in", "unit = \"in\"", 25.4),
        ("# angle [deg]; lift [mm]\nangle;lift [in]", "name both mm and in", "unit = \"in\"", 25.4),
        ("Angle [deg];Lift [mm]\nrad;mm", "name both deg and rad", "angle_unit = \"deg\"", 1.0),
        ("# lifts in inches\nangle;lift", "unit = inches: is a unit of length", "unit = \"in\"", 25.4),
        ("angle;lift  # deg, inch", "unit = inch: is a unit of length", "unit = \"in\"", 25.4),
        ("# Lift in 0.01 mm\nangle;lift", "is a unit of length", "unit = \"0.01 mm\"", 0.01),
        ("# Lift in mm × 0.01\nangle;lift", "is a unit of length", "unit = \"0.01 mm\"", 0.01),
        ("# lift in 1/100 mm, by dial gauge\nangle;lift", "is a unit of length", "unit = \"0.01 mm\"", 0.01),
        ("# Lift in hundredths (mm)\nangle;lift", "is a unit of length", "unit = \"0.01 mm\"", 0.01),
        ("Cam Lift Data (in)\nangle;lift", "unit = in: is a unit of length", "unit = \"in\"", 25.4),
        ("highest at 0.450 in\nangle;lift", "unit = in: is a unit of length", "unit = \"in\"", 25.4),
        ("# angles in rad\nangle;lift", "unit = rad: is a unit of angle", "angle_unit = \"deg\"", 1.0),
    ] {
        let csv = table(head, SEMICOLON);
        let said = refusal(&csv, "");
        assert!(said.contains(says), "{head}: no \"{says}\" in {said}");
        let is_meant = said.contains(line) || says == one_of || says.starts_with("unit = rad");
        assert!(is_meant && said.contains("in [cam]"), "{head}: no {line} in {said}");
        is_the_lobe(&csv, line, size);
    }
    // A comment behind the rows has a unit as well; one in a row is about that row.
    let behind = table("angle,lift", COMMA) + "# all in inches\n";
    assert!(refusal(&behind, "").contains(":182: unit = inches"));
    is_the_lobe(&table("angle,lift", COMMA).replace("4,0.0000\n", "4,0.0000 # 0.1 in\n"), "", 1.0);
    let cases = [
        ("# angle [deg], radius [mm]", "A,L", "", "names a radius"),
        ("# angle [deg], lift [mm], lift [in]", "A,L,L", "", "set lift_column in [cam]"),
        ("angle [deg],lift [mm]", "A,L", "unit = \"in\"", "must be the unit in the header of the table: mm"),
        ("angle [deg],lift [mm]", "A,L", "unit = \"0.01 mm\"", "must be the unit in the header of the table: mm"),
        ("angle [deg],lift [mm]", "A,L", "angle_unit = \"gon\"", "must be the unit in the header of the table: deg"),
        ("angle,lift", "A,L", "unit = \"0.5 mm\"", "must be one of: \"m\", \"cm\", \"mm\""),
        ("angle,lift", "A,L", "unit = \"1 mm\"", "must be one of"),
        ("angle,lift", "A,L", "unit = \"in 0.01 mm\"", "must be one of"),
        ("angle,lift", "A,L", "unit = \"0.01 deg\"", "must be one of"),
        ("angle,lift", "A,L", "unit = 5", "must be text in quotes"),
        ("angle,lift", "A,L", "angle_column = 0", "must be the name of a column in quotes, or its number from 1"),
        ("angle,lift", "A,L", "angle_column = -1", "or its number from 1"),
        ("angle,lift", "A,L", "angle_column = 1.5", "or its number from 1"),
        ("angle,lift", "A,L", "lift_column = 1e7", "or its number from 1"),
        ("angle,lift", "A,L", "lift_column = 1000000", "has 2 columns"),
        ("angle,lift", "A,L", "lift_column = \"lift [mm]\"", "its columns are angle, lift"),
        ("# theta h", "A L 0", "", "has 3 columns without names"),
        ("x,y", "A,L", "", "or set the columns in [cam], such as angle_column = 1 and lift_column = 2"),
        ("angle,no lift in", "A,L", "", "must name the angle"),
        ("deg/angle,lift", "A,L", "", "must name the angle"),
        ("cm deg,lift", "A,L", "", "must name the angle"),
        ("angle,-,lift,-", "A,L", "", "must be two numbers"),
        ("angle [0.1 rad] lift", "A L", "", "names a part of a unit"),
    ];
    for (head, row, fields, says) in cases {
        let said = refusal(&table(head, row), fields);
        assert!(said.contains(says), "{head}: no \"{says}\" in {said}");
    }
    is_the_lobe(&table("x,y", COMMA), "angle_column = 1\nlift_column = 2", 1.0);
    is_the_lobe(&table("angle,lift", COMMA), "unit = \"0.001 in\"", 0.0254);
    let by_name = "angle_column = \"Angle [deg]\"\nlift_column = \"LIFT\"";
    is_the_lobe(&table("x [mm],angle [deg],lift [mm]", "0,A,L"), by_name, 1.0);
    is_the_lobe(&table("# deg, 0.01 mm", COMMA), "", 0.01);
}
