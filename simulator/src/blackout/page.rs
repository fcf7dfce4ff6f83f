//! A start as one page: what came of it, where the robot drove, and its pictures with what was found drawn in.

use super::{Blackout, Outcome, REACHED, Senses, Story};
use crate::eye::Shot;
use plot::{Axis, Color, Figure, Panel, Series};
use std::fmt::Write as _;
use vision::onboard::Glance;

/// Pictures on the page at most.
const PICTURES: usize = 36;
/// Points of a curve.
const POINTS: usize = 400;

const STYLE: &str = "body{font:16px/1.5 Helvetica,Arial,sans-serif;max-width:62rem;margin:0 auto;padding:1rem;color:#1a1a1a}\
h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.15rem;margin-top:2.2rem;border-bottom:1px solid #ccc}svg{max-width:100%;height:auto}\
table{border-collapse:collapse;width:100%;font-size:.88rem;font-variant-numeric:tabular-nums}\
td,th{text-align:left;padding:.25rem .6rem .25rem 0;border-bottom:1px solid #e2e2e2;vertical-align:top}th{font-weight:600}\
.v{font-size:1.15rem;background:#eef4f8;padding:.8rem;border-left:5px solid #0072b2}\
.g{display:grid;grid-template-columns:repeat(auto-fit,minmax(19rem,1fr));gap:1rem}figure{margin:0}figcaption{color:#444;font-size:.85rem}";

/// Path of a frame below the page's folder, counted from 0.
#[must_use]
pub fn picture_name(number: usize) -> String {
    format!("pictures/{number:04}.jpg")
}

/// In words, for a table.
#[must_use]
pub fn senses_name(senses: Senses) -> &'static str {
    match senses {
        Senses::Wheels => "wheels",
        Senses::Gyroscope => "wheels, gyroscope",
        Senses::Camera => "wheels, gyroscope, camera",
    }
}

/// The page; `others` are the same start with less on board. Its pictures lie beside it by [`picture_name`].
#[must_use]
pub fn html(start: &Blackout, story: &Story, others: &[(Senses, Outcome)]) -> String {
    let mut out = String::new();
    let title = "A robot without overhead camera";
    let _ = write!(
        out,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>{STYLE}</style></head><body>\
         <h1>{title}</h1><p class=\"v\">{}</p>",
        sentence(story)
    );
    out.push_str("<table><tr><th>on board</th><th>front to the ball, mm</th><th>off the coordinates, mm</th></tr>");
    for (senses, outcome) in others.iter().copied().chain([(Senses::Camera, story.outcome)]) {
        let _ = write!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
            senses_name(senses),
            millimetres(outcome.ball_miss),
            millimetres(outcome.miss)
        );
    }
    out.push_str("</table>");
    refused(&mut out, story);
    let _ = write!(out, "<h2>Where it drove</h2>{}", map(start, story));
    out.push_str("<h2>What it saw</h2><p>Orange: balls and their scores. Blue: points on lines. Green: the carpet's boundary. Red: goals.</p><div class=\"g\">");
    let every = story.shots.len().div_ceil(PICTURES).max(1);
    for (number, shot) in story.shots.iter().enumerate().step_by(every) {
        picture(&mut out, number, shot);
    }
    out.push_str("</div></body></html>\n");
    out
}

fn millimetres(metres: f64) -> String {
    if metres.is_finite() { format!("{:.0}", 1e3 * metres) } else { "-".to_owned() }
}

fn sentence(story: &Story) -> String {
    let Outcome { ball_miss, miss } = story.outcome;
    let reached = |m: f64| if m < REACHED { "reached" } else { "missed" };
    format!(
        "Ball {} (front {} mm off), coordinates {} ({} mm off), in {} drives with {} pictures.",
        reached(ball_miss),
        millimetres(ball_miss),
        reached(miss),
        millimetres(miss),
        story.legs.len(),
        story.shots.len()
    )
}

fn refused(out: &mut String, story: &Story) {
    if story.refused.is_empty() {
        return;
    }
    out.push_str("<h2>Pictures that gave no pose</h2><table><tr><th>pictures</th><th>why</th></tr>");
    for (why, count) in &story.refused {
        let _ = write!(out, "<tr><td>{count}</td><td>{}</td></tr>", escape(why));
    }
    out.push_str("</table>");
}

fn map(start: &Blackout, story: &Story) -> String {
    let thin = |points: Vec<[f64; 2]>| {
        let every = points.len().div_ceil(POINTS).max(1);
        points.into_iter().step_by(every).collect::<Vec<_>>()
    };
    let truth = story.legs.iter().flat_map(|leg| &leg.track).map(|(_, p)| [p.x, p.y]).collect();
    let believed = story.legs.iter().flat_map(|leg| &leg.believed).map(|p| [p.x, p.y]).collect();
    let [ball, target] = start.places();
    let panel = Panel::new(Axis::new("x", "m"), Axis::new("y", "m"))
        .equal_aspect()
        .with(Series::line("robot", thin(truth)).color(Color::Green))
        .with(Series::dashed("as it believes", thin(believed)).color(Color::Blue))
        .with(Series::crosses("ball", vec![ball]).color(Color::Orange))
        .with(Series::crosses("coordinates", vec![target]).color(Color::Black));
    Figure::new("Overhead camera off").with(panel).to_svg()
}

fn picture(out: &mut String, number: usize, shot: &Shot) {
    let (width, height) = (shot.picture.width(), shot.picture.height());
    let _ = write!(
        out,
        "<figure><svg viewBox=\"0 0 {width} {height}\" width=\"100%\"><image href=\"{}\" width=\"{width}\" height=\"{height}\"/>",
        picture_name(number)
    );
    let caption = match &shot.glance {
        Err(why) => format!("not used: {why}"),
        Ok(glance) => {
            drawn(out, glance);
            let ball = glance.scene.balls.first().map_or_else(
                || "no ball".to_owned(),
                |ball| format!("ball {:.0} pixels wide, score {:.2}", ball.region.width, ball.score),
            );
            let pose = match &glance.pose {
                Ok(found) => {
                    format!("pose {:.0} mm off", 1e3 * (found.pose.x - shot.truth.x).hypot(found.pose.y - shot.truth.y))
                }
                Err(why) => format!("no pose: {why}"),
            };
            format!("{ball}; {pose}")
        }
    };
    let _ = write!(out, "</svg><figcaption>{:.1} s: {}</figcaption></figure>", shot.t, escape(&caption));
}

/// What was found, in pixels.
fn drawn(out: &mut String, glance: &Glance) {
    let scene = &glance.scene;
    let boundary: Vec<String> = scene.boundary.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let _ = write!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#00c853\" stroke-width=\".8\"/>",
        boundary.join(" ")
    );
    for point in &scene.lines {
        let _ = write!(out, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\".9\" fill=\"#0072b2\"/>", point.x, point.y);
    }
    for goal in &scene.goals {
        let (x, y) = (goal.x - goal.width / 2.0, goal.y - goal.height / 2.0);
        let _ = write!(
            out,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#d50000\"/>",
            goal.width, goal.height
        );
    }
    for ball in &scene.balls {
        let r = ball.region;
        let _ = write!(
            out,
            "<ellipse cx=\"{:.1}\" cy=\"{:.1}\" rx=\"{:.1}\" ry=\"{:.1}\" fill=\"none\" stroke=\"#ff6d00\" stroke-width=\"1.2\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"8\" fill=\"#ff6d00\">{:.2}</text>",
            r.x,
            r.y,
            r.width / 2.0 + 1.5,
            r.height / 2.0 + 1.5,
            r.x + r.width / 2.0 + 2.0,
            r.y,
            ball.score
        );
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
