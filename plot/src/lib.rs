//! Plots as SVG text: lines and points over axes with units, for reports, print and phones; and the frame of the pages
//! that they stand on.
//!
//! ```
//! use plot::{Axis, Figure, Panel, Series};
//! let path = Series::line("path", vec![[0.0, 0.0], [1.0, 2.0]]);
//! let panel = Panel::new(Axis::new("x", "m"), Axis::new("y", "m")).equal_aspect().with(path);
//! assert!(Figure::new("A drive").with(panel).to_svg().starts_with("<svg"));
//! ```

mod axis;
pub mod page;
mod svg;

/// One picture: panels side by side or below each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    title: String,
    panels: Vec<Panel>,
    columns: usize,
}

impl Figure {
    /// An empty picture; one column, so that it stays readable on a phone.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), panels: Vec::new(), columns: 1 }
    }

    /// Adds a panel.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Puts this many panels side by side, at least 1.
    #[must_use]
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = columns.max(1);
        self
    }

    /// The picture as a complete SVG document.
    pub fn to_svg(&self) -> String {
        svg::figure(self)
    }
}

/// What an axis shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    label: String,
    unit: String,
    range: Option<[f64; 2]>,
}

impl Axis {
    /// A quantity and its unit; an empty unit for none.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), range: None }
    }

    /// Shows this range instead of that of the data, which stays where `low` and `high` are not finite or `low` is not below.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = (low.is_finite() && high.is_finite() && low < high).then_some([low, high]);
        self
    }

    fn caption(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} [{}]", self.label, self.unit) }
    }
}

/// One pair of axes and what is drawn in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    title: String,
    x: Axis,
    y: Axis,
    equal: bool,
    height: f64,
    series: Vec<Series>,
}

impl Panel {
    /// An empty panel.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self { title: String::new(), x, y, equal: false, height: 300.0, series: Vec::new() }
    }

    /// A title above the panel.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// A metre is as long on x as on y: for maps. The panel is as high as the data want.
    #[must_use]
    pub fn equal_aspect(mut self) -> Self {
        self.equal = true;
        self
    }

    /// Height of the plotting area in pixels, 60 to 2000, for panels without equal aspect; what is no number changes nothing.
    #[must_use]
    pub fn height(mut self, pixels: f64) -> Self {
        if !pixels.is_nan() {
            self.height = pixels.clamp(60.0, 2000.0);
        }
        self
    }

    /// Adds a series, drawn over those before it.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }
}

/// Colours that stay apart in print and for colour-blind readers (Okabe and Ito, 2008).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Color {
    /// Black, for what is given.
    Black,
    /// Grey, for what is ideal or in the background.
    Grey,
    /// Blue, the first series that is given no colour.
    Blue,
    /// Vermilion, for what went wrong.
    Red,
    /// Bluish green, for what went right.
    Green,
    /// Orange, the fourth of those that are given to series without one.
    Orange,
    /// Reddish purple.
    Purple,
    /// Sky blue.
    Sky,
}

impl Color {
    /// Colours for series that are given none, in this order.
    const CYCLE: [Self; 6] = [Self::Blue, Self::Red, Self::Green, Self::Orange, Self::Purple, Self::Sky];

    fn hex(self) -> &'static str {
        match self {
            Self::Black => "#1a1a1a",
            Self::Grey => "#8c8c8c",
            Self::Blue => "#0072b2",
            Self::Red => "#d55e00",
            Self::Green => "#009e73",
            Self::Orange => "#e69f00",
            Self::Purple => "#cc79a7",
            Self::Sky => "#56b4e9",
        }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    Line,
    Dashed,
    Steps,
    Points,
    Crosses,
}

/// One line or cloud of points. Points that are not finite leave a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    label: String,
    points: Vec<[f64; 2]>,
    mark: Mark,
    color: Option<Color>,
    /// Place and direction (rad, counter-clockwise from x).
    headings: Vec<[f64; 3]>,
}

impl Series {
    fn new(label: impl Into<String>, points: Vec<[f64; 2]>, mark: Mark) -> Self {
        Self { label: label.into(), points, mark, color: None, headings: Vec::new() }
    }

    /// A line; an empty label keeps it out of the legend.
    pub fn line(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, Mark::Line)
    }

    /// A dashed line.
    pub fn dashed(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, Mark::Dashed)
    }

    /// A line that holds each value until the next: duties, set points.
    pub fn steps(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, Mark::Steps)
    }

    /// A dot for each pair, not joined.
    pub fn points(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, Mark::Points)
    }

    /// Crosses, for set points on a map.
    pub fn crosses(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::new(label, points, Mark::Crosses)
    }

    /// Draws in this colour instead of the next of the cycle.
    #[must_use]
    pub fn color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// Adds small arrows along a trajectory: x, y and direction (rad, counter-clockwise from x).
    #[must_use]
    pub fn headings(mut self, ticks: Vec<[f64; 3]>) -> Self {
        self.headings = ticks;
        self
    }
}

#[cfg(test)]
mod tests;
