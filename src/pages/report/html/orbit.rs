//! Where the corner impact is.

use maud::html;

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::numbers::{fixed, number, size, symbol};
use crate::pages::report::html::{Section, wide};

pub(crate) fn section(dossier: &Dossier) -> Section {
    let body = match &dossier.verification {
        None => html! {
            p { "There is none to verify; " a href="#findings" { "the findings" } " say why. What follows is what cam and follower do without it." }
        },
        Some(found) => {
            let at = &found.at;
            let (state, [before, after]) = (at.x_star(), at.cam_acceleration());
            let [low, high] = at.bracket;
            html! {
                p {
                    "The orbit with one impact a revolution whose impact is on a corner, solved for from the model's numbers alone."
                }
                (wide("The corner impact", &html! {
                    table {
                        tbody {
                            tr { th scope="row" { "period" } td { (symbol("T", "", "∗")) } td.n { (number(at.period, 14)) } td { "s" } }
                            tr { th scope="row" { "speed" } td { (symbol("ω", "", "∗")) } td.n { (fixed(at.speed_rpm(), 9)) } td { "rpm" } }
                            @if let Some(angle) = dossier.corner_deg {
                                tr { th scope="row" { "cam angle of the corner" } td { i { "θ" } } td.n { (fixed(angle, 6)) } td { "deg" } }
                            }
                            tr { th scope="row" { "state half a revolution from it, position" } td { (symbol("x", "1", "∗")) } td.n { (number(state[0], 13)) } td { "m" } }
                            tr { th scope="row" { "and velocity" } td { (symbol("x", "2", "∗")) } td.n { (number(state[1], 13)) } td { "m/s" } }
                            tr { th scope="row" { "height of the cam there" } td { i { "c" } } td.n { (number(at.corner.plus.value, 10)) } td { "m" } }
                            tr { th scope="row" { "velocity of the follower before" } td { (symbol("v", "", "−")) } td.n { (number(at.velocity_before, 10)) } td { "m/s" } }
                            tr { th scope="row" { "and after" } td { (symbol("v", "", "+")) } td.n { (number(at.velocity_after, 10)) } td { "m/s" } }
                            tr { th scope="row" { "velocity of the cam" } td { i { "c" } "′" } td.n { (number(at.cam_velocity, 10)) } td { "m/s" } }
                            tr { th scope="row" { "acceleration of the cam before the corner" } td { i { "c" } "″" sub { "−" } } td.n { (number(before, 10)) } td { "m/s²" } }
                            tr { th scope="row" { "and after" } td { i { "c" } "″" sub { "+" } } td.n { (number(after, 10)) } td { "m/s²" } }
                        }
                    }
                }))
                p.note {
                    "Position is measured from " i { "q" } " = " (number(at.origin, 9)) " m. "
                    (symbol("T", "", "∗")) " lies between " (number(low, 16)) " and " (number(high, 16)) " s; one simulated revolution ends within "
                    (size(at.closure)) " of where it started, in parts of the orbit's size."
                }
                @for other in &found.others {
                    p.note { "There is another corner impact at " (fixed(other.speed_rpm(), 6)) " rpm: narrow [study] to verify that one." }
                }
            }
        }
    };
    Section { id: "corner-impact", title: "Where the corner impact is", body }
}
