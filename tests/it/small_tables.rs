//! Small tables, each with one oddity: what they are read as, or why they are refused.
//!
//! Each was found by a search for a table that one change of the reader would read otherwise, and then shortened while it did.

use std::fmt::Write;

use corner_impact::model::CamProfile;

use crate::reading::model_of;
use crate::snapshots;

/// Law of the cam, text of the table, and fields beside it.
const TABLES: &[(&str, &str, &str)] = &[
    ("table", "72;0.00\n180;8.00", "mirrored = true"),
    ("table", "39,6|0\n46,8|0\n54,0|0", "outside = \"base\""),
    ("table", "180|0.0000\n300|3.0000", "mirrored = true"),
    ("table", "0;0.00\n90;0.00\n180;8.00\n270;0.00", "outside = \"base\""),
    ("table", "x#\n0,0.0000\n150,4.0000\n270,0.0000", ""),
    ("table", "90.0|4\n180.0|0\n270.0|4\n315.0|2\n337.5|1", ""),
    ("table", "50,0.0000,6\n150,4.0000,16\n250,0.0000,26", "angle_column = 1\nlift_column = 2"),
    ("table", "#angle,x\n0,0.0000\n150,4.0000\n270,0.0000", ""),
    ("table", "144  .2361\n150  6.0000\n162  3.6489\n318  10.0000\n348  10.0000", ""),
    ("table", "angle,x,v\n67.5;0.0000;3\n90.0;0.0000;0\n247.5;0.0000;0\n270.0;0.0000;7", ""),
    (
        "table",
        "58;1\n64;2\n70;2\n76;2\n82;3\n88;3\n94;3\n100;4\n154;6\n160;6\n166;6\n172;6\n202;6\n208;1 234\n238;5\n244;4\n298;2\n304;1\n310;1\n370;0",
        "",
    ),
    (
        "table",
        "90;-0,0500\n105;-0,0500\n120;-0,0500\n135;0,6716\n150;3,5000\n165;6,7784\n180;7,5000\n195;6,7784\n210;3,5000\n225;0,6716\n285;-0,0500\n330;-0,0500\n345;-0,5000\n360;-0,0500\n375;-0,0500\n420;-0,0500\n435;-0,0500",
        "",
    ),
    (
        "table",
        "10,0.0000\n20,0.0000\n30,0.0000\n40,0.5000\n50,0.5000\n60,0.5000\n70,0.5000\n80,0.5000\n180,80.0000\n190,74.6410\n200,6.0000\n210,4000.0000\n220,0.2000\n300,0.0000\n310,0.0000\n320,0.0000\n330,0.0000\n340,0.0000\n350,0.0000\n360,0.0000",
        "",
    ),
    ("table", "|", ""),
    ("table", "x%s °", ""),
    ("table", "in[º,x", ""),
    ("table", "sep=\n1", ""),
    ("table", "280,0°", ""),
    ("table", "angle\u{202f}ius", ""),
    ("table", "45  1 234", ""),
    ("table", "=,6 ) 0,0", ""),
    ("table", "x\n0\t0.0000", "angle_column = 3"),
    ("table", "sep=;\n15,0", ""),
    ("table", "sep=|\n20;4", ""),
    ("table", "°\n0;0.0000", "angle_unit = \"rad\""),
    ("table", "146.25,5.5", "outside = \"base\""),
    ("table", "1.0277;0.12", "mirrored = false"),
    ("table", "rad\n0,0.000", ""),
    ("table", "0,\u{a0}'000.0000", ""),
    ("table", "1\u{202f}90\u{a0} 7.4641", ""),
    ("table", "\tin\n0\t0.0000", ""),
    ("table", "1  -60  0.00", ""),
    ("table", "sep=,\n675\t0.0", ""),
    ("table", "0.7083,0.0000", "mirrored = true"),
    ("table", ",##\n240,1000.0", ""),
    ("table", "%mm\t.\n0\t0.0000", "angle_column = 3"),
    ("table", "# #[in\n20,0.0000", ""),
    ("table", "10;0.0\n729.99;0.0", ""),
    ("table", "gon 1|%\n20|0.0000", ""),
    ("table", "Pt#x   x\n0,0.0000", ""),
    ("table", "4,0.0000 # 0.1 in", ""),
    ("table", "#;Angle;x\n0;0.0000", ""),
    ("table", "#\tdeg\tx\n0\t0.0000\t1", ""),
    ("table", "72|2.0729\n144|#N/A", ""),
    ("table", "690,0.00\n120,0.0mm", ""),
    ("table", "Grad,Hub\n1e400,0.00", ""),
    ("table", "x,#  ),/\n0,0.0000,1", ""),
    ("table", "0.0  0.000000\n## ##", ""),
    ("table", "Angle,x\n\"\n250,0.0000", ""),
    ("table", "0;10.0000\nangle,x\n0,0", ""),
    ("table", "120|0.1000\n120|0.0000", "turn_deg = 3600"),
    ("table", "angle,angle\n2,330,1000", ""),
    ("table", "130,inf\n250,1000.000000", ""),
    ("table", "rev|m\n0;0.0000\n30;0.0000", ""),
    ("table", "x°;2mm\nangle;in\n20;0.0000", ""),
    ("table", "0.5\t2\n0.7\t10\n0.8\t10\n0.9\t7", "mirrored = true"),
    ("table", "0.0;-5.0000\n400.0;-5.0000", ""),
    ("table", "220;1200\n230;1054\n240;1000", "outside = \"base\""),
    ("table", "grad;Hub\n2.617993878,10.00", "angle_unit = \"rad\""),
    ("table", "angle,x\n',6\n233.3333,5.5981", ""),
    ("table", "%s;angle\n0;0.0000\n30;0.0000", ""),
    ("table", "gon,mm\n-90,10.5000\n315,9.3284", ""),
    ("table", "#angle;x\ndeg;furlong\n20;0.0000", ""),
    ("table", "382.5|0\n247.5|0\ndeg,mm\n292.5|0", ""),
    ("table", "112.5\t-0.5\n157.5\t5.5\n202.5\t5.0", "outside = \"base\""),
    ("table", "630,100.00\n540,100.00\n360,20.00", ""),
    ("table", "0,0;0,0\n0,001;2,0\nno\n0,0014;0,0", ""),
    ("table", "330,0.0000\n340,0.0000\n350,0.0000", "angle_column = 1\nlift_column = 2"),
    ("table", "\"0.0\"\t180.00\n3.0\t300.00\n3.0\t420.00", ""),
    ("table", "10,100.0000\n10,120.0000\n10,240.0000", ""),
    ("table", "180;-0.5000\n210;-0.0500\n240;-0.5000", "outside = \"base\""),
    ("table", " 1e-2 mm angle;Lift*0.01 mm\n0  0.0000", ""),
    ("table", "angle,x,v\n1,0,0.00\n2,45,0.88\n8,315,0.88", ""),
    ("table", "deg,mm\n240,4.5000\n312,5.7406\n672,0.2594", ""),
    ("table", "-135;1117.2000\n-180;1800.0000\n-225;1117.3000", ""),
    ("table", "-180;8.000000\n72;0.000000\nangle x\n144;2.763900", ""),
    ("table", "120;10,0000\n0;10000\n240;10,0000\n120;10,0000\n0;10,0000", ""),
    ("contour", "x,y\n19.815,3.494\n-19.633,4.895\n-12.176,-19.485\n-12.123,-19.401", ""),
    ("contour", "x,y", "radius_column = 2"),
    ("contour", "0;0.0000", ""),
    ("contour", "29.0,19.1", "radius_column = 2"),
    ("contour", "x,y\n0.000,0.000", ""),
    ("contour", "y\n1030.%000,0.000", ""),
    ("contour", "x,y\n23.0,0.0\n-26.0,0.0\n-0.0,-23.0", ""),
    ("contour", "-151,2\t1,2\n-144,0\t7,2361\n-136,8\t8,5497", ""),
    ("contour", "19.0,6.2\n-19.6,-6.4\n-19.6,6.4\n19.0,-6.2", "x_column = 1\ny_column = 2"),
    ("contour", "x,y\n0.000,23.000\n0.000,26.000\n-0.000,-23.000", ""),
    ("contour", "x,y\n-27.5,0.0\n-0.0,-19.5\n-5.2,-19.3\n16.9,9.7", ""),
    ("contour", "x,y\n25.000000,-25.980762\n35.000000,25.980762\n70.000000,0.000000", ""),
    ("contour", "x,y\n-21.213,-21.213\n21.213,21.213\n-21.213,-21.213\n21.213,21.213", ""),
];

#[test]
fn small_tables_are_read_or_refused_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let mut told = String::new();
    for (law, csv, fields) in TABLES {
        let said = match model_of(law, &folder, csv, fields) {
            Err(words) => words.replace(&*folder.path().to_string_lossy(), ""),
            Ok(model) => {
                let table = match &model.cam {
                    CamProfile::Table(table) => table,
                    CamProfile::Contour(contour) => &contour.table,
                    other => panic!("{other:?}"),
                };
                let rows = table.rows.iter().map(|row| format!("{} {} {}", row.line, row.angle_deg, row.lift));
                let reading = serde_json::to_string(&*table.reading).unwrap();
                format!("{reading}\n  {}\n  {}", rows.collect::<Vec<_>>().join(", "), table.doubts().join("; "))
            }
        };
        writeln!(told, "{law} {csv:?} {fields:?}\n  {}", said.trim_end()).unwrap();
    }
    snapshots::settings().bind(|| insta::assert_snapshot!("small-tables", told));
}
