use proptest::prelude::*;

use super::*;

fn count(svg: &str, what: &str) -> usize {
    svg.matches(what).count()
}

#[test]
fn names_are_escaped_and_tags_balance() {
    let panel = Panel::new(Axis::new("a<b", "m&s"), Axis::new("\"y\"\u{1}", ""))
        .title("x > y")
        .with(Series::line("</svg><script>", vec![[0.0, 1.0], [1.0, 0.0]]));
    let svg = Figure::new("R&D").with(panel).to_svg();
    assert!(svg.contains("R&amp;D") && svg.contains("a&lt;b [m&amp;s]") && svg.contains("&lt;/svg&gt;&lt;script&gt;"));
    assert!(!svg.contains("<script") && !svg.contains('\u{1}'));
    for tag in ["svg", "g", "text"] {
        assert_eq!(count(&svg, &format!("<{tag} ")), count(&svg, &format!("</{tag}>")), "{tag}");
    }
}

#[test]
fn equal_aspect_gives_squares() {
    let square = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let wide = vec![[0.0, 0.0], [50.0, 0.0]];
    let panel = Panel::new(Axis::new("x", "m"), Axis::new("y", "m")).equal_aspect();
    let svg = Figure::new("").with(panel.clone().with(Series::line("", square))).to_svg();
    let d = svg.split("stroke-width=\"2\"").next().unwrap().rsplit("d=\"").next().unwrap();
    let numbers: Vec<f64> =
        d.split('"').next().unwrap().split(['M', 'L', ' ']).filter_map(|n| n.parse().ok()).collect();
    let (across, up) = (numbers[2] - numbers[0], numbers[3] - numbers[5]);
    assert!((across - up).abs() < 0.25 && across > 100.0, "{numbers:?}");
    // A line along x is no map of no height.
    assert!(Figure::new("").with(panel.with(Series::line("", wide))).to_svg().contains("height=\"140.0\""));
}

#[test]
fn gaps_extremes_and_emptiness_are_drawn_without_nan() {
    let inf = f64::INFINITY;
    let points = vec![[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0], [inf, 1.0], [3.0, 1e300], [4.0, -1e300]];
    for series in [
        Series::line("a", points.clone()),
        Series::steps("b", points.clone()),
        Series::points("c", points.clone()).headings(vec![[0.0, 0.0, f64::NAN], [inf, 0.0, 0.0]]),
        Series::crosses("d", vec![]),
        Series::dashed("e", vec![[1.0, 1.0]]),
    ] {
        let panel = Panel::new(Axis::new("x", ""), Axis::new("y", "")).with(series);
        let svg = Figure::new("t").with(panel.clone()).with(panel).columns(2).to_svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    assert!(Figure::new("").to_svg().contains("<svg"));
}

#[test]
fn a_gap_starts_a_new_stroke() {
    let points = vec![[0.0, 0.0], [1.0, 1.0], [f64::NAN, 0.0], [2.0, 0.0], [3.0, 1.0]];
    let svg =
        Figure::new("").with(Panel::new(Axis::new("", ""), Axis::new("", "")).with(Series::line("", points))).to_svg();
    let d = svg.split("stroke-width=\"2\"").next().unwrap().rsplit("d=\"").next().unwrap().split('"').next().unwrap();
    assert_eq!(count(d, "M"), 2, "{d}");
}

#[test]
fn long_legends_wrap_and_every_label_appears() {
    let mut panel = Panel::new(Axis::new("t", "s"), Axis::new("w", "rad/s"));
    for i in 0..12 {
        panel = panel.with(Series::line(format!("a rather long label {i}"), vec![[0.0, f64::from(i)], [1.0, 2.0]]));
    }
    let svg = Figure::new("").with(panel).to_svg();
    assert_eq!(count(&svg, "a rather long label"), 12);
    for line in svg.lines().filter(|l| l.contains("class=\"l\"")) {
        let x: f64 = line.split(" x=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        assert!(x + 7.6 * 21.0 < 600.0, "{line}");
    }
}

/// A number of any size, and those at which arithmetic ends.
fn anything() -> impl Strategy<Value = f64> {
    let ends =
        [0.0, 1e-310, 5e-324, 1e300, f64::MAX, f64::INFINITY, f64::NAN, f64::MIN_POSITIVE, 1.0, 1.0 + f64::EPSILON];
    let signed = prop::sample::select(ends.to_vec()).prop_flat_map(|v| prop_oneof![Just(v), Just(-v)]);
    prop_oneof![signed, prop::num::f64::ANY, -1e3..1e3]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_data_and_no_range_make_a_place_that_is_no_number(
        numbers in prop::collection::vec([anything(), anything(), anything()], 0..5),
        (x, y) in (prop::option::of([anything(), anything()]), prop::option::of([anything(), anything()])),
        (equal, mark, height) in (any::<bool>(), 0..5usize, anything()),
    ) {
        let points: Vec<[f64; 2]> = numbers.iter().map(|[x, y, _]| [*x, *y]).collect();
        let marks = [Series::line, Series::dashed, Series::steps, Series::points, Series::crosses];
        let of = |name: &str, range: Option<[f64; 2]>| {
            let axis = Axis::new(name, "m");
            range.map_or(axis.clone(), |[low, high]| axis.range(low, high))
        };
        let panel = Panel::new(of("x", x), of("y", y)).height(height).with(marks[mark]("z", points).headings(numbers));
        let panel = if equal { panel.equal_aspect() } else { panel };
        let svg = Figure::new("t").with(panel).to_svg();
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        // As many decimals as a place needs, not as many as a number has.
        prop_assert!(svg.lines().all(|line| line.len() < 700), "{svg}");
    }
}
