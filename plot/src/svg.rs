//! Layout and drawing.

use std::fmt::Write as _;

use super::axis::{drawable, label, padded, round_step, ticks};
use super::{Color, Figure, Mark, Panel, Series};

/// Width of a panel with its margins, px; text of 15 px is still 9 px on a phone 360 px wide.
const PANEL_WIDTH: f64 = 600.0;
/// Room for a tick's label of six characters beside the axis's caption.
const LEFT: f64 = 84.0;
const RIGHT: f64 = 18.0;
const BOTTOM: f64 = 54.0;
const TITLE: f64 = 34.0;
const ROW_GAP: f64 = 10.0;
/// Mean width of a character of the 14 px legend text; sans-serif fonts differ by a tenth.
const CHARACTER: f64 = 7.6;
const LEGEND_LINE: f64 = 21.0;
const LEGEND_SWATCH: f64 = 34.0;
/// Highest and lowest maps before they get margins at the sides instead.
const MAP_HEIGHT: [f64; 2] = [140.0, 620.0];
/// How far outside its panel a point is drawn, in units of the panel.
const FAR: f64 = 200.0;

pub(super) fn figure(figure: &Figure) -> String {
    let columns = figure.columns.min(figure.panels.len().max(1));
    let width = PANEL_WIDTH * columns as f64;
    let top = if figure.title.is_empty() { 8.0 } else { 46.0 };
    let mut body = String::new();
    if !figure.title.is_empty() {
        text(&mut body, [width / 2.0, 30.0], "middle", "t", &figure.title);
    }
    let mut y = top;
    for row in figure.panels.chunks(columns) {
        let layouts: Vec<Layout> = row.iter().map(Layout::of).collect();
        let height = layouts.iter().map(Layout::total_height).fold(0.0, f64::max);
        for (i, (panel, layout)) in row.iter().zip(&layouts).enumerate() {
            let _ = writeln!(body, "<g transform=\"translate({} {y:.1})\">", PANEL_WIDTH * i as f64);
            layout.draw(&mut body, panel);
            body.push_str("</g>\n");
        }
        y += height + ROW_GAP;
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {y:.0}\" width=\"{width}\" height=\"{y:.0}\" \
         style=\"max-width:100%;height:auto\" font-family=\"'Helvetica Neue',Helvetica,Arial,'DejaVu Sans',sans-serif\" \
         role=\"img\" aria-label=\"{}\">\n<style>.t{{font-size:19px;font-weight:600;fill:#1a1a1a}}\
         .p{{font-size:16px;font-weight:600;fill:#1a1a1a}}.a{{font-size:15px;fill:#1a1a1a}}\
         .k{{font-size:14px;fill:#444}}.l{{font-size:14px;fill:#1a1a1a}}</style>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n",
        escape(&figure.title)
    )
}

/// Where things are in one panel.
struct Layout {
    x: [f64; 2],
    y: [f64; 2],
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    /// Rows of legend entries: series and x offset.
    legend: Vec<Vec<(usize, f64)>>,
}

impl Layout {
    fn of(panel: &Panel) -> Self {
        let ends = |i: usize| {
            let points = panel.series.iter().flat_map(move |s| s.points.iter().map(move |p| p[i]));
            padded(points.chain(panel.series.iter().flat_map(move |s| s.headings.iter().map(move |h| h[i]))))
        };
        let mut x = drawable(panel.x.range.unwrap_or_else(|| ends(0)));
        let mut y = drawable(panel.y.range.unwrap_or_else(|| ends(1)));
        let width = PANEL_WIDTH - LEFT - RIGHT;
        let mut height = panel.height;
        if panel.equal {
            let scale = width / (x[1] - x[0]);
            height = ((y[1] - y[0]) * scale).clamp(MAP_HEIGHT[0], MAP_HEIGHT[1]);
            // Whichever axis has room to spare shows more than the data.
            let scale = scale.min(height / (y[1] - y[0]));
            x = widened(x, width / scale);
            y = widened(y, height / scale);
        }
        let legend = legend_rows(panel, width);
        let title = if panel.title.is_empty() { 6.0 } else { TITLE };
        let top = title + legend.len() as f64 * LEGEND_LINE + if legend.is_empty() { 0.0 } else { 8.0 };
        Self { x, y, left: LEFT, top, width, height, legend }
    }

    fn total_height(&self) -> f64 {
        self.top + self.height + BOTTOM
    }

    /// Where a point is, px; of one that is not finite no number.
    fn place(&self, p: [f64; 2]) -> [f64; 2] {
        // Far outside the panel renderers lose precision; the clip hides it anyway.
        let share = |v: f64, [low, high]: [f64; 2]| {
            if v.is_finite() { ((v - low) / (high - low)).clamp(-FAR, FAR) } else { f64::NAN }
        };
        [self.left + self.width * share(p[0], self.x), self.top + self.height * (1.0 - share(p[1], self.y))]
    }

    fn draw(&self, out: &mut String, panel: &Panel) {
        if !panel.title.is_empty() {
            text(out, [self.left, 21.0], "start", "p", &panel.title);
        }
        self.grid(out, panel);
        let clip = format!(
            "<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{:.1}\" viewBox=\"{} {} {} {:.1}\" overflow=\"hidden\">",
            self.left, self.top, self.width, self.height, self.left, self.top, self.width, self.height
        );
        let _ = writeln!(out, "{clip}");
        for (i, series) in panel.series.iter().enumerate() {
            self.series(out, series, color_of(panel, i).hex());
        }
        out.push_str("</svg>\n");
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{:.1}\" fill=\"none\" stroke=\"#444\"/>",
            self.left, self.top, self.width, self.height
        );
        self.draw_legend(out, panel);
    }

    fn grid(&self, out: &mut String, panel: &Panel) {
        let (nx, ny) = (9, (self.height / 36.0).clamp(2.0, 9.0) as usize);
        let (mut sx, mut sy) = (round_step(self.x[1] - self.x[0], nx), round_step(self.y[1] - self.y[0], ny));
        if panel.equal {
            // Squares, so that distances can be read off.
            sx = sx.max(sy);
            sy = sx;
        }
        let (bottom, right) = (self.top + self.height, self.left + self.width);
        for v in ticks(self.x, sx) {
            let [px, _] = self.place([v, 0.0]);
            let _ = writeln!(out, "<path d=\"M{px:.1} {}V{bottom:.1}\" stroke=\"#e2e2e2\"/>", self.top);
            text(out, [px, bottom + 19.0], "middle", "k", &label(v, sx));
        }
        for v in ticks(self.y, sy) {
            let [_, py] = self.place([0.0, v]);
            let _ = writeln!(out, "<path d=\"M{} {py:.1}H{right:.1}\" stroke=\"#e2e2e2\"/>", self.left);
            text(out, [self.left - 8.0, py + 5.0], "end", "k", &label(v, sy));
        }
        text(out, [self.left + self.width / 2.0, bottom + 43.0], "middle", "a", &panel.x.caption());
        let (x, y) = (15.0, self.top + self.height / 2.0);
        let caption = escape(&panel.y.caption());
        let _ = writeln!(
            out,
            "<text class=\"a\" text-anchor=\"middle\" transform=\"translate({x} {y:.1}) rotate(-90)\">{caption}</text>"
        );
    }

    fn series(&self, out: &mut String, series: &Series, color: &str) {
        let placed = series.points.iter().map(|p| self.place(*p));
        match series.mark {
            Mark::Line | Mark::Dashed | Mark::Steps => {
                let dash = if series.mark == Mark::Dashed { " stroke-dasharray=\"7 5\"" } else { "" };
                let d = path(placed, series.mark == Mark::Steps);
                let _ = writeln!(
                    out,
                    "<path d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\" stroke-linejoin=\"round\"{dash}/>"
                );
            }
            Mark::Points | Mark::Crosses => {
                for [x, y] in placed.filter(|p| p[0].is_finite() && p[1].is_finite()) {
                    out.push_str(&mark(series.mark, x, y, color));
                    out.push('\n');
                }
            }
        }
        for [x, y, angle] in &series.headings {
            let [x, y] = self.place([*x, *y]);
            if x.is_finite() && y.is_finite() && angle.is_finite() {
                let _ = writeln!(
                    out,
                    "<path transform=\"translate({x:.1} {y:.1}) rotate({:.1})\" d=\"M0 0H15M9.5 -3.5L15.5 0L9.5 3.5\" \
                     fill=\"none\" stroke=\"{color}\" stroke-width=\"1.5\"/><circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.3\" fill=\"{color}\"/>",
                    -(angle % std::f64::consts::TAU).to_degrees()
                );
            }
        }
    }

    fn draw_legend(&self, out: &mut String, panel: &Panel) {
        let first = if panel.title.is_empty() { 20.0 } else { TITLE + 14.0 };
        for (row, entries) in self.legend.iter().enumerate() {
            let y = first + row as f64 * LEGEND_LINE;
            for (i, offset) in entries {
                let (series, x) = (&panel.series[*i], self.left + offset);
                let (color, middle) = (color_of(panel, *i).hex(), y - 5.0);
                match series.mark {
                    Mark::Points | Mark::Crosses => out.push_str(&mark(series.mark, x + 12.0, middle, color)),
                    Mark::Line | Mark::Dashed | Mark::Steps => {
                        let dash = if series.mark == Mark::Dashed { " stroke-dasharray=\"7 5\"" } else { "" };
                        let _ = write!(
                            out,
                            "<path d=\"M{x:.1} {middle:.1}h24\" stroke=\"{color}\" stroke-width=\"2.5\"{dash}/>"
                        );
                    }
                }
                text(out, [x + LEGEND_SWATCH - 4.0, y], "start", "l", &series.label);
            }
        }
    }
}

fn color_of(panel: &Panel, series: usize) -> Color {
    let uncoloured = panel.series[..series].iter().filter(|s| s.color.is_none()).count();
    panel.series[series].color.unwrap_or(Color::CYCLE[uncoloured % Color::CYCLE.len()])
}

fn legend_rows(panel: &Panel, width: f64) -> Vec<Vec<(usize, f64)>> {
    let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
    let mut x = 0.0;
    for (i, series) in panel.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty()) {
        let wide = LEGEND_SWATCH + CHARACTER * series.label.chars().count() as f64 + 14.0;
        if rows.is_empty() || x + wide > width {
            rows.push(Vec::new());
            x = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((i, x));
        }
        x += wide;
    }
    rows
}

fn widened([low, high]: [f64; 2], span: f64) -> [f64; 2] {
    let middle = 0.5 * (low + high);
    [middle - 0.5 * span, middle + 0.5 * span]
}

/// Path data; points that repeat to a tenth of a pixel are left out, which keeps long logs small.
fn path(points: impl Iterator<Item = [f64; 2]>, steps: bool) -> String {
    let mut d = String::new();
    let mut last: Option<[f64; 2]> = None;
    for p in points {
        if !(p[0].is_finite() && p[1].is_finite()) {
            last = None;
            continue;
        }
        let p = p.map(|v| (v * 10.0).round() / 10.0);
        match last {
            None => drop(write!(d, "M{} {}", p[0], p[1])),
            Some(before) if before == p => {}
            Some(_) if steps => drop(write!(d, "H{}V{}", p[0], p[1])),
            Some(_) => drop(write!(d, "L{} {}", p[0], p[1])),
        }
        last = Some(p);
    }
    d
}

fn mark(kind: Mark, x: f64, y: f64, color: &str) -> String {
    if kind == Mark::Crosses {
        return format!(
            "<path d=\"M{:.1} {:.1}l11 11m0 -11l-11 11\" stroke=\"{color}\" stroke-width=\"2.2\" fill=\"none\"/>",
            x - 5.5,
            y - 5.5
        );
    }
    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{color}\" fill-opacity=\"0.7\"/>")
}

fn text(out: &mut String, [x, y]: [f64; 2], anchor: &str, class: &str, content: &str) {
    let content = escape(content);
    let _ =
        writeln!(out, "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{content}</text>");
}

/// Text for XML and HTML; characters that XML 1.0 forbids become the replacement character.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if (c < ' ' && !matches!(c, '\t' | '\n' | '\r')) || matches!(c, '\u{fffe}' | '\u{ffff}') => {
                out.push('\u{fffd}');
            }
            c => out.push(c),
        }
    }
    out
}
