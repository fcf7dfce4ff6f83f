//! `report.html`: one file, pictures inside, no script.

use plot::page::{Page, Table};
use plot::{Axis, Color, Figure, Panel, Series};

use super::{firmware, regimes, terminal, words};
use crate::analysis::{Analysis, overall};
use crate::units::{self, short};
use links::motion::WindowResiduals;

/// Points a plot has at most.
const POINTS: usize = 700;

pub(super) fn page(a: &Analysis) -> String {
    let mut page = Page::new(&format!("Gap report: {}", a.name));
    page.links(
        [
            ("gap.json", "for programs: gap.json"),
            ("robot.toml", "robot.toml with what is named"),
            ("#firmware", "into your firmware"),
            ("#limits", "what could hide"),
            ("#decided", "how it was decided"),
        ]
        .into_iter()
        .filter(|(to, _)| *to != "#firmware" || firmware::of(a).is_some()),
    );
    page.verdict(&terminal::sentence(a));
    mistakes(&mut page, a);
    in_words(&mut page, a);
    next(&mut page, a);
    effects(&mut page, a);
    typed_in(&mut page, a);
    waterfall(&mut page, a);
    regime_map(&mut page, a);
    trajectories(&mut page, a);
    residuals(&mut page, a);
    limits(&mut page, a);
    statement(&mut page, a);
    page.finish()
}

fn mistakes(page: &mut Page, a: &Analysis) {
    for mistake in &a.mistakes {
        page.note(&format!("Set up wrong: {mistake}. Until that is mended, no name and no size here can be trusted."));
    }
}

fn in_words(page: &mut Page, a: &Analysis) {
    let mut items = vec![words::links(a)];
    items.extend(a.effects.iter().map(words::effect));
    items.extend(words::own(a));
    items.extend(a.alternatives.iter().map(|set| format!("These data cannot tell apart: {}.", words::tied(set))));
    items.extend(words::conditions(a));
    let open = |u: &crate::analysis::Leftover| {
        format!("No effect explains this in the {} link: {}.", u.link.name(), u.structure)
    };
    items.extend(a.unexplained.iter().map(open));
    let places = a.located.iter().take(8);
    items.extend(places.map(|l| format!("{} ({:.1} noise floors).", sentence(&l.place), l.excess)));
    page.list(items);
}

/// With a capital, and without a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}", letters.as_str().trim_end_matches('.'))
}

fn next(page: &mut Page, a: &Analysis) {
    let Some(e) = &a.next_experiment else { return };
    let mut text = format!(
        "Next: {} ({}, about {:.0} s), to tell {} apart: {}.",
        e.what,
        e.kind,
        e.seconds,
        e.separates.join(" and "),
        e.why
    );
    if e.kind == "manoeuvre" {
        text += &format!(
            " Rehearse it with `racbot simulate --robot robot.toml --manoeuvre {} --times {}`.",
            e.what, e.times
        );
    }
    if !e.others.is_empty() {
        let others: Vec<String> = e.others.iter().map(|(what, s)| format!("{what} ({s:.0} s)")).collect();
        text += &format!(" These would do as well: {}.", others.join(", "));
    }
    page.note(&text);
}

fn effects(page: &mut Page, a: &Analysis) {
    if a.effects.is_empty() {
        return;
    }
    page.heading("What is missing");
    let mut table = Table::new(&[
        "effect",
        "wheels",
        "parameter",
        "value",
        "interval",
        "in other units",
        "gap closed on its link",
        "evidence",
    ]);
    for e in &a.effects {
        for (k, (name, v, known)) in e.parameters.iter().enumerate() {
            let interval = known
                .ends()
                .map_or_else(String::new, |[lo, hi]| format!("{} {} to {}", known.label(), short(lo), short(hi)));
            let first = |s: String| if k == 0 { s } else { String::new() };
            table.row([
                first(e.name.clone()),
                first(words::list(&e.wheels)),
                name.clone(),
                short(*v),
                interval,
                units::value(name, *v),
                first(format!("{:.1} %", 100.0 * e.gain)),
                first(e.evidence.words()),
            ]);
        }
    }
    page.table(&table);
    for e in &a.effects {
        page.small(&format!("{}: {}", e.name, e.equation));
    }
}

fn typed_in(page: &mut Page, a: &Analysis) {
    let Some(found) = firmware::of(a) else { return };
    page.heading("Into your firmware");
    page.anchor("firmware");
    page.text(
        "The robot as it was found. Replace the kinematics of your own program by these; wheels are counted in the order of \
         the log's columns, and turn as their encoders count.",
    );
    let mut table = Table::new(&["wheel", "radius", "forward, rad/m", "to the left, rad/m", "counter-clockwise"]);
    for (i, ([x, y, w], radius)) in found.inverse.iter().zip(&found.radius_m).enumerate() {
        let row = [format!("{} mm", short(1e3 * radius)), format!("{y:.4}"), format!("{:.4}", -x), format!("{w:.4}")];
        table.row([(i + 1).to_string()].into_iter().chain(row));
    }
    page.table(&table);
    page.verbatim(&found.c_arrays());
}

fn waterfall(page: &mut Page, a: &Analysis) {
    let (before, after) = overall(&a.links);
    page.heading("How the gap shrinks");
    page.text(&format!(
        "RMS over all compared signals, in units of the noise floor: {before:.2} before, {after:.2} with robot.toml as it is \
         written, read again; nothing else is adjusted. Each bar has the effects down to its own, on all links."
    ));
    let bars = a.waterfall.iter().enumerate().map(|(k, (label, value))| {
        let color = match (k, label.as_str()) {
            (_, "noise floor") => Color::Grey,
            (0, _) => Color::Red,
            _ => Color::Green,
        };
        (label.clone(), *value, color)
    });
    page.bars(&bars.collect::<Vec<_>>());
    let mut table = Table::new(&["link", "signal", "before", "after", "floor", "unit"]);
    for l in &a.links {
        for (i, rms) in l.rms.iter().enumerate() {
            table.row([
                l.link.name().to_owned(),
                signal(l.link.name(), i, l.signals),
                short(rms[0]),
                short(rms[1]),
                short(l.floor.get(i).copied().unwrap_or(0.0)),
                l.units.get(i).copied().unwrap_or("").to_owned(),
            ]);
        }
    }
    page.table(&table);
}

fn signal(link: &str, i: usize, signals: usize) -> String {
    match link {
        "motion" => ["x", "y", "heading"].get(i).copied().unwrap_or("").to_owned(),
        // A gyroscope of one axis is that of the heading.
        "gyroscope" if signals == 1 => "gyro z".to_owned(),
        "gyroscope" | "accelerometer" => ["x", "y", "z"].get(i).copied().unwrap_or("").to_owned(),
        "timing" => "camera stamps".to_owned(),
        "command" => format!("set point {}", i + 1),
        "controller" => format!("duty {}", i + 1),
        _ => format!("wheel {}", i + 1),
    }
}

fn regime_map(page: &mut Page, a: &Analysis) {
    let Some(table) = regimes::table(a) else { return };
    page.heading("Regime map");
    page.small(
        "RMS in noise floors, before → after, by situation; the colour is that of before: white agrees, orange is five \
         floors off. Forwards and backwards are the wheel's, or along the body's y axis.",
    );
    page.table(&table);
}

fn trajectories(page: &mut Page, a: &Analysis) {
    let Some([before, after]) = &a.whole else { return };
    page.heading("Trajectories");
    page.small("Whole runs by encoders alone, laid over what the camera saw as well as one start pose allows.");
    let mut figures = Vec::new();
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
        figures.push(Figure::new(name).with(panel).to_svg());
    }
    page.figures(&figures);
}

fn residuals(page: &mut Page, a: &Analysis) {
    if let Some([before, after]) = &a.motion {
        page.heading("Residuals");
        page.small(if a.ways.is_some() {
            "Camera minus what prediction and camera before let expect, group of frames after group, in its standard deviations."
        } else {
            "Camera minus prediction within a window, frame after frame, in units of the camera's noise."
        });
        let mut figures = Vec::new();
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
            let of = if a.ways.is_some() { "group" } else { "frame" };
            let panel = Panel::new(Axis::new(of, ""), Axis::new("residual", "noise"))
                .height(190.0)
                .with(Series::points("before", points(before)).color(Color::Red))
                .with(Series::points("after", points(after)).color(Color::Green));
            figures.push(Figure::new(format!("camera {name}")).with(panel).to_svg());
        }
        page.figures(&figures);
    }
    if let Some([before, after]) = &a.drive {
        page.heading("Unexplained torque");
        page.small(
            "Of each wheel against its speed: a step at zero is dry friction, a slope is viscous friction or a wrong constant.",
        );
        let mut figures = Vec::new();
        for i in 0..before.torque.first().map_or(0, Vec::len) {
            let points = |d: &links::drive::DriveResiduals| {
                let all: Vec<[f64; 2]> = (0..d.torque.len())
                    .filter(|b| d.weights[*b][i] > 0.0)
                    .map(|b| [a.driven.test_functions[b][i].speed, 1e3 * d.torque[b][i]])
                    .collect();
                thin(&all)
            };
            let panel = Panel::new(Axis::new("wheel speed", "rad/s"), Axis::new("torque", "mNm"))
                .height(190.0)
                .with(Series::points("before", points(before)).color(Color::Red))
                .with(Series::points("after", points(after)).color(Color::Green));
            figures.push(Figure::new(format!("wheel {}", i + 1)).with(panel).to_svg());
        }
        page.figures(&figures);
    }
}

fn thin(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stride = points.len().div_ceil(POINTS).max(1);
    points.iter().enumerate().filter(|(k, p)| k % stride == 0 || !p[0].is_finite()).map(|(_, p)| *p).collect()
}

fn limits(page: &mut Page, a: &Analysis) {
    page.heading("Detection limits");
    page.anchor("limits");
    page.small(
        "An effect of this size, beside what is named already, is named in nine of ten such data sets; one that its twin or \
         these drives hide is not listed. Estimates below it that differ from 0 by more than two standard deviations are \
         detectable but immaterial (marked *).",
    );
    let mut table = Table::new(&["effect", "parameter", "named from", "estimate", "standard deviation"]);
    for l in &a.limits {
        let mark = if l.estimate.abs() > 2.0 * l.sd { " *" } else { "" };
        let row = [format!("{}{mark}", l.name), l.parameter.clone(), short(l.limit), short(l.estimate), short(l.sd)];
        table.row(row);
    }
    page.table(&table);
}

fn statement(page: &mut Page, a: &Analysis) {
    let t = &a.thresholds;
    page.heading("How it was decided");
    page.anchor("decided");
    page.text(&format!(
        "Fixed before fitting: motion is compared in windows of {:.0} s with start poses fitted, against {}; the drive by test functions of 0.12 s, against what a generic regression on each wheel's own signals leaves (taken again with what was named in the model, where that had passed for noise). Every effect that is not named is held near zero with a standard deviation of {:.0} % of its materiality threshold, so that what every robot has a little of is neither named nor in the way. An effect is named if it lowers the objective by {:.0} beyond its cost, explains at least {:.1} % (motion) or {:.0} % (drive) of the held-out squares and {:.0} % of what exceeds the noise, and is material. Held out: {}.",
        a.window_s,
        if a.ways.is_some() {
            "what poses err and wheels wander beside every effect at once, as far as that does not matter"
        } else {
            "the camera's noise from third differences of its own frames (or robot.toml)"
        },
        100.0 * t.held_share,
        t.gain,
        100.0 * t.shares[0],
        100.0 * t.shares[1],
        100.0 * t.share_of_excess,
        if a.runs.len() > 1 { "one run at a time" } else { "blocks of the single run" }
    ));
    page.text(&format!("Tried: {}, and probes for structure that none of them has.", a.tried.join(", ")));
    for r in &a.remarks {
        page.text(r);
    }
    let mut table = Table::new(&["threshold", "value", "what it is"]);
    for s in t.stated() {
        let values: Vec<String> = s.values.iter().map(|v| short(*v)).collect();
        table.row([s.name.to_owned(), values.join(", "), s.meaning.to_owned()]);
    }
    page.table(&table);
}
