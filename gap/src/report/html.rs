//! `report.html`: one file, pictures inside, no script.

use std::fmt::Write as _;

use plot::{Axis, Color, Figure, Panel, Series};

use super::{regimes, short, terminal, units, words};
use crate::analysis::{Analysis, overall};
use crate::motion::WindowResiduals;

/// Points a plot has at most.
const POINTS: usize = 700;

const STYLE: &str = "body{font:16px/1.5 Helvetica,Arial,sans-serif;max-width:62rem;margin:0 auto;padding:1rem;color:#1a1a1a}\
h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.15rem;margin-top:2.2rem;border-bottom:1px solid #ccc}svg{max-width:100%;height:auto}\
table{border-collapse:collapse;width:100%;font-size:.88rem;font-variant-numeric:tabular-nums}\
td,th{text-align:left;padding:.25rem .6rem .25rem 0;border-bottom:1px solid #e2e2e2;vertical-align:top}th{font-weight:600}\
.m td+td,.m th+th{text-align:center;padding:.25rem .3rem;white-space:nowrap}\
.v{font-size:1.15rem;background:#eef4f8;padding:.8rem;border-left:5px solid #0072b2}.n{background:#f6f6f0;padding:.6rem .8rem;border-left:5px solid #e69f00}\
.w{overflow-x:auto}.s{color:#555;font-size:.9rem}.g{display:grid;grid-template-columns:repeat(auto-fit,minmax(19rem,1fr));gap:.5rem}\
code{background:#f0f0f0;padding:0 .25rem}\
@media print{body{font-size:11px;max-width:none}h2{break-after:avoid}svg,tr,.v,.n{break-inside:avoid}.m td{-webkit-print-color-adjust:exact;print-color-adjust:exact}}";

pub(super) fn page(a: &Analysis) -> String {
    let mut out = String::new();
    let title = escape(&format!("Gap report: {}", a.name));
    let _ = write!(
        out,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>{STYLE}</style></head><body><h1>{title}</h1><p class=\"v\">{}</p>",
        escape(&terminal::sentence(a))
    );
    in_words(&mut out, a);
    next(&mut out, a);
    effects(&mut out, a);
    waterfall(&mut out, a);
    regime_map(&mut out, a);
    trajectories(&mut out, a);
    residuals(&mut out, a);
    limits(&mut out, a);
    statement(&mut out, a);
    out.push_str("</body></html>\n");
    out
}

fn in_words(out: &mut String, a: &Analysis) {
    let _ = write!(out, "<ul><li>{}</li>", escape(&words::links(a)));
    for e in &a.effects {
        let _ = write!(out, "<li>{}</li>", escape(&words::effect(e)));
    }
    for set in &a.alternatives {
        let _ = write!(out, "<li>These data cannot tell apart: {}.</li>", escape(&words::tied(set)));
    }
    for u in &a.unexplained {
        let _ =
            write!(out, "<li>No effect explains this in the {} link: {}.</li>", u.link.name(), escape(&u.structure));
    }
    for l in a.located.iter().take(8) {
        let _ = write!(out, "<li>{} ({:.1} noise floors).</li>", escape(&sentence(&l.place)), l.excess);
    }
    out.push_str("</ul>");
}

/// With a capital, and without a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}", letters.as_str().trim_end_matches('.'))
}

fn next(out: &mut String, a: &Analysis) {
    let Some(e) = &a.next_experiment else { return };
    let _ = write!(
        out,
        "<p class=\"n\">Next: <b>{}</b> ({}, about {:.0} s), to tell {} apart: {}.",
        escape(&e.what),
        e.kind,
        e.seconds,
        escape(&e.separates.join(" and ")),
        escape(&e.why)
    );
    if e.kind == "manoeuvre" {
        let _ = write!(
            out,
            " Rehearse it with <code>racbot simulate --robot robot.toml --manoeuvre {} --times {}</code>.",
            e.what, e.times
        );
    }
    if !e.others.is_empty() {
        let others: Vec<String> = e.others.iter().map(|(what, s)| format!("{what} ({s:.0} s)")).collect();
        let _ = write!(out, " These would do as well: {}.", escape(&others.join(", ")));
    }
    out.push_str("</p>");
}

fn effects(out: &mut String, a: &Analysis) {
    if a.effects.is_empty() {
        return;
    }
    out.push_str("<h2>What is missing</h2><div class=\"w\"><table><tr><th>effect</th><th>wheels</th><th>parameter</th><th>value</th><th>interval</th><th>in other units</th><th>gap closed on its link</th><th>evidence</th></tr>");
    for e in &a.effects {
        for (k, (name, v, known)) in e.parameters.iter().enumerate() {
            let interval = known
                .ends()
                .map_or_else(String::new, |[lo, hi]| format!("{} {} to {}", known.label(), short(lo), short(hi)));
            let first = |s: String| if k == 0 { s } else { String::new() };
            let _ = write!(
                out,
                "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                first(escape(&e.name)),
                first(words::list(&e.wheels)),
                escape(name),
                short(*v),
                interval,
                escape(&units::value(name, *v)),
                first(format!("{:.1} %", 100.0 * e.gain)),
                first(escape(&e.evidence.words()))
            );
        }
    }
    out.push_str("</table></div>");
    for e in &a.effects {
        let _ = write!(out, "<p class=\"s\"><b>{}</b>: {}</p>", escape(&e.name), escape(&e.equation));
    }
}

fn waterfall(out: &mut String, a: &Analysis) {
    let (before, after) = overall(&a.links);
    let _ = write!(
        out,
        "<h2>How the gap shrinks</h2><p>RMS over all compared signals, in units of the noise floor: {before:.2} before, {after:.2} with robot.toml as it is written, read again; nothing else is adjusted.</p>"
    );
    let top = a.waterfall.iter().map(|w| w.1).fold(1.0, f64::max);
    let (row, left, width) = (30.0, 250.0, 300.0);
    let height = row * a.waterfall.len() as f64 + 10.0;
    let _ = write!(
        out,
        "<svg viewBox=\"0 0 640 {height}\" role=\"img\" aria-label=\"waterfall of the gap\" font-family=\"sans-serif\" font-size=\"14\">"
    );
    for (k, (label, value)) in a.waterfall.iter().enumerate() {
        let y = row * k as f64 + 5.0;
        let color = if label == "noise floor" {
            "#8c8c8c"
        } else if k == 0 {
            "#d55e00"
        } else {
            "#009e73"
        };
        let _ = write!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><rect x=\"{left}\" y=\"{y}\" width=\"{:.1}\" height=\"20\" fill=\"{color}\"/><text x=\"{:.1}\" y=\"{}\">{value:.2}</text>",
            left - 8.0,
            y + 15.0,
            escape(label),
            (width * value / top).max(1.0),
            left + width * value / top + 6.0,
            y + 15.0
        );
    }
    let floor = left + width / top;
    let _ = write!(
        out,
        "<line x1=\"{floor:.1}\" x2=\"{floor:.1}\" y1=\"0\" y2=\"{height}\" stroke=\"#1a1a1a\" stroke-dasharray=\"4 3\"/>"
    );
    out.push_str("</svg><div class=\"w\"><table><tr><th>link</th><th>signal</th><th>before</th><th>after</th><th>floor</th><th>unit</th></tr>");
    for l in &a.links {
        for (i, rms) in l.rms.iter().enumerate() {
            let _ = write!(
                out,
                "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                l.link.name(),
                signal(l.link.name(), i),
                short(rms[0]),
                short(rms[1]),
                short(l.floor.get(i).copied().unwrap_or(0.0)),
                l.units.get(i).copied().unwrap_or("")
            );
        }
    }
    out.push_str("</table></div>");
}

fn signal(link: &str, i: usize) -> String {
    match link {
        "motion" => ["x", "y", "heading"].get(i).copied().unwrap_or("").to_owned(),
        "timing" => "camera stamps".to_owned(),
        "command" => format!("set point {}", i + 1),
        "controller" => format!("duty {}", i + 1),
        _ => format!("wheel {}", i + 1),
    }
}

fn regime_map(out: &mut String, a: &Analysis) {
    let Some(table) = regimes::table(a) else { return };
    out.push_str("<h2>Regime map</h2><p class=\"s\">RMS in noise floors, before → after, by situation; the colour is that of before: white agrees, orange is five floors off. Forwards and backwards are the wheel's, or along the body's y axis.</p>");
    out.push_str(&table);
}

fn trajectories(out: &mut String, a: &Analysis) {
    let Some([before, after]) = &a.whole else { return };
    out.push_str("<h2>Trajectories</h2><p class=\"s\">Whole runs by encoders alone, laid over what the camera saw as well as one start pose allows.</p><div class=\"g\">");
    for (b, f) in before.iter().zip(after).take(4) {
        let name = a.runs.get(b.run).map_or("", String::as_str);
        let seen: Vec<[f64; 2]> = a
            .driven
            .seen
            .iter()
            .filter(|(run, _)| *run == b.run)
            .flat_map(|(_, places)| places.iter().copied())
            .collect();
        let path = |w: &WindowResiduals| -> Vec<[f64; 2]> { w.predicted.iter().map(|p| [p.x, p.y]).collect() };
        let panel = Panel::new(Axis::new("x", "m"), Axis::new("y", "m"))
            .equal_aspect()
            .with(Series::line("camera", thin(&seen)).color(Color::Grey))
            .with(Series::line("model before", thin(&path(b))).color(Color::Red))
            .with(Series::line("model after", thin(&path(f))).color(Color::Green));
        out.push_str(&Figure::new(name).with(panel).to_svg());
    }
    out.push_str("</div>");
}

fn residuals(out: &mut String, a: &Analysis) {
    if let Some([before, after]) = &a.motion {
        out.push_str("<h2>Residuals</h2><p class=\"s\">Camera minus prediction within a window, frame after frame, in units of the camera's noise.</p><div class=\"g\">");
        for (i, name) in ["x", "y", "heading"].iter().enumerate() {
            let points = |w: &[WindowResiduals]| {
                let all: Vec<[f64; 2]> = w
                    .iter()
                    .flat_map(|w| w.residuals.iter().map(|r| r[i]))
                    .zip(0..)
                    .map(|(r, k)| [f64::from(k), r])
                    .collect();
                thin(&all)
            };
            let panel = Panel::new(Axis::new("frame", ""), Axis::new("residual", "noise"))
                .height(190.0)
                .with(Series::points("before", points(before)).color(Color::Red))
                .with(Series::points("after", points(after)).color(Color::Green));
            out.push_str(&Figure::new(format!("camera {name}")).with(panel).to_svg());
        }
        out.push_str("</div>");
    }
    if let Some([before, after]) = &a.drive {
        out.push_str("<h2>Unexplained torque</h2><p class=\"s\">Of each wheel against its speed: a step at zero is dry friction, a slope is viscous friction or a wrong constant.</p><div class=\"g\">");
        for i in 0..before.torque.first().map_or(0, Vec::len) {
            let points = |d: &crate::drive::DriveResiduals| {
                let all: Vec<[f64; 2]> = (0..d.torque.len())
                    .filter(|b| d.weights[*b][i] > 0.0)
                    .map(|b| [a.driven.bumps[b][i].speed, 1e3 * d.torque[b][i]])
                    .collect();
                thin(&all)
            };
            let panel = Panel::new(Axis::new("wheel speed", "rad/s"), Axis::new("torque", "mNm"))
                .height(190.0)
                .with(Series::points("before", points(before)).color(Color::Red))
                .with(Series::points("after", points(after)).color(Color::Green));
            out.push_str(&Figure::new(format!("wheel {}", i + 1)).with(panel).to_svg());
        }
        out.push_str("</div>");
    }
}

fn thin(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stride = points.len().div_ceil(POINTS).max(1);
    points.iter().enumerate().filter(|(k, p)| k % stride == 0 || !p[0].is_finite()).map(|(_, p)| *p).collect()
}

fn limits(out: &mut String, a: &Analysis) {
    out.push_str("<h2>Detection limits</h2><p class=\"s\">An effect of this size, beside what is named already, is named in nine of ten such data sets; one that its twin or these drives hide is not listed. Estimates below it that differ from 0 by more than two standard deviations are detectable but immaterial (bold).</p><div class=\"w\"><table><tr><th>effect</th><th>parameter</th><th>named from</th><th>estimate</th><th>standard deviation</th></tr>");
    for l in &a.limits {
        let (b, e) = if l.estimate.abs() > 2.0 * l.sd { ("<b>", "</b>") } else { ("", "") };
        let _ = write!(
            out,
            "<tr><td>{b}{}{e}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&l.name),
            escape(&l.parameter),
            short(l.limit),
            short(l.estimate),
            short(l.sd)
        );
    }
    out.push_str("</table></div>");
}

fn statement(out: &mut String, a: &Analysis) {
    let t = &a.thresholds;
    let _ = write!(
        out,
        "<h2>How it was decided</h2><p>Fixed before fitting: motion is compared in windows of {:.0} s with start poses fitted, against the camera's noise from third differences of its own frames (or robot.toml); the drive in bumps of 0.12 s, against what a generic regression on each wheel's own signals leaves (taken again with what was named in the model, where that had passed for noise). Every effect that is not named is held near zero with a standard deviation of {:.0} % of its materiality threshold, so that what every robot has a little of is neither named nor in the way. An effect is named if it lowers the objective by {:.0} beyond its cost, explains at least {:.1} % (motion) or {:.0} % (drive) of the held-out squares and {:.0} % of what exceeds the noise, and is material. Held out: {}.</p>",
        a.window_s,
        100.0 * t.held_share,
        t.gain,
        100.0 * t.shares[0],
        100.0 * t.shares[1],
        100.0 * t.share_of_excess,
        if a.runs.len() > 1 { "one run at a time" } else { "blocks of the single run" }
    );
    let _ =
        write!(out, "<p>Tried: {}, and probes for structure that none of them has.</p>", escape(&a.tried.join(", ")));
    for r in &a.remarks {
        let _ = write!(out, "<p>{}</p>", escape(r));
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
