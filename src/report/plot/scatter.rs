//! Two numbers of several models: where each stands, by name.

use std::io;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::{Drawn, GRID, PAIR, plain, svg_of};
use crate::report::rank::spearman;

/// Points with names over linear axes, in one or several groups; the title tells each group's rank correlation.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterPlot {
    /// Above it; the correlations follow in a second line.
    pub title: String,
    /// What the horizontal axis measures, with its unit.
    pub x: String,
    /// What the vertical axis measures, with its unit.
    pub y: String,
    /// One colour each.
    pub groups: Vec<ScatterGroup>,
}

/// Points that are ranked together.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterGroup {
    /// In the legend.
    pub name: String,
    /// Places that are not finite are left out.
    pub points: Vec<NamedPoint>,
}

/// A point with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPoint {
    /// Beside the point.
    pub name: String,
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
}

/// Pixels of the plot.
const SIZE: (u32, u32) = (820, 600);
/// Pixels of a name's letters.
const LETTERS: u32 = 13;

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl ScatterPlot {
    /// The plot as an SVG document.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn to_svg(&self) -> io::Result<String> {
        svg_of(SIZE, |area| {
            let area =
                area.titled(&self.title, ("sans-serif", 18))?.titled(&self.correlations(), ("sans-serif", 15))?;
            let [x, y] = [range(self.values(|p| p.x)), range(self.values(|p| p.y))];
            let mut chart = ChartBuilder::on(&area)
                .margin(14)
                .x_label_area_size(44)
                .y_label_area_size(64)
                .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
            chart
                .configure_mesh()
                .x_desc(&self.x)
                .y_desc(&self.y)
                .x_label_formatter(&|x| plain(*x))
                .y_label_formatter(&|y| plain(*y))
                .label_style(("sans-serif", 14))
                .axis_desc_style(("sans-serif", 15))
                .bold_line_style(GRID)
                .light_line_style(TRANSPARENT)
                .draw()?;
            // Nothing gained, nothing lost.
            chart.draw_series([PathElement::new([(x.0, 0.0), (x.1, 0.0)], RGBColor(120, 120, 120))])?;
            self.draw_points(&mut chart)
        })
    }

    fn draw_points<'a, B: DrawingBackend + 'a>(&self, chart: &mut Chart<'a, B>) -> Drawn<B> {
        for (group, colour) in self.groups.iter().zip(PAIR.iter().cycle()) {
            let points = group.points.iter().filter(|p| p.is_finite());
            chart
                .draw_series(points.map(|p| Circle::new((p.x, p.y), 4, colour.filled())))?
                .label(&group.name)
                .legend(|at| Circle::new((at.0 + 10, at.1), 4, colour.filled()));
        }
        let points: Vec<(&NamedPoint, RGBColor)> = self.coloured_points();
        let pixels: Vec<(i32, i32)> = points.iter().map(|(p, _)| chart.backend_coord(&(p.x, p.y))).collect();
        let area = chart.plotting_area().strip_coord_spec();
        let (ranges, names) = (area.get_pixel_range(), points.iter().map(|(p, _)| p.name.as_str()));
        let boxes = place_names(&pixels, &names.collect::<Vec<_>>(), [ranges.0.end, ranges.1.end]);
        for ((point, colour), at) in points.iter().zip(boxes) {
            let at = (at.left - ranges.0.start, at.top - ranges.1.start);
            area.draw(&Text::new(point.name.clone(), at, ("sans-serif", LETTERS).into_font().color(colour)))?;
        }
        if self.groups.len() < 2 {
            return Ok(());
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font(("sans-serif", 14))
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .draw()
    }

    /// All points that can be shown, with the colours of their groups.
    fn coloured_points(&self) -> Vec<(&NamedPoint, RGBColor)> {
        let groups = self.groups.iter().zip(PAIR.iter().cycle());
        groups.flat_map(|(group, colour)| group.points.iter().filter(|p| p.is_finite()).map(|p| (p, *colour))).collect()
    }

    fn values(&self, value: fn(&NamedPoint) -> f64) -> Vec<f64> {
        self.coloured_points().into_iter().map(|(p, _)| value(p)).collect()
    }

    /// `Spearman's rank correlation: paper −0.71 (7 models), best −0.86 (7 models)`.
    fn correlations(&self) -> String {
        let of = |group: &ScatterGroup| {
            let points: Vec<&NamedPoint> = group.points.iter().filter(|p| p.is_finite()).collect();
            let [xs, ys] =
                [|p: &&NamedPoint| p.x, |p: &&NamedPoint| p.y].map(|f| points.iter().map(f).collect::<Vec<_>>());
            let value = spearman(&xs, &ys).map_or("unknown".to_owned(), |r| format!("{r:.2}").replace('-', "−"));
            let name = if self.groups.len() > 1 { format!("{} ", group.name) } else { String::new() };
            format!("{name}{value} ({} models)", points.len())
        };
        format!("Spearman's rank correlation: {}", self.groups.iter().map(of).collect::<Vec<_>>().join(", "))
    }
}

impl NamedPoint {
    fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

/// A range that holds all values and 0, with room beyond what is not 0.
fn range(values: Vec<f64>) -> (f64, f64) {
    let least = values.iter().copied().fold(0.0, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    let room = 0.08 * (most - least);
    let beyond = |end: f64, room: f64| if end == 0.0 { end } else { end + room };
    if least < most { (beyond(least, -room), beyond(most, room)) } else { (0.0, 1.0) }
}

/// Where a name stands, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    left: i32,
    top: i32,
    width: i32,
    height: i32,
}

impl Place {
    fn overlaps(&self, other: &Self) -> bool {
        let apart = |a: i32, a_size: i32, b: i32, b_size: i32| a + a_size <= b || b + b_size <= a;
        !apart(self.left, self.width, other.left, other.width) && !apart(self.top, self.height, other.top, other.height)
    }

    /// The square that a point's disc fills.
    fn disc((x, y): (i32, i32)) -> Self {
        Self { left: x - 4, top: y - 4, width: 8, height: 8 }
    }
}

/// A place for each name beside its point: right, left, above, below, or a line lower and so on, whichever is free first.
fn place_names(points: &[(i32, i32)], names: &[&str], [right, bottom]: [i32; 2]) -> Vec<Place> {
    let mut taken: Vec<Place> = points.iter().map(|&at| Place::disc(at)).collect();
    for (&(x, y), name) in points.iter().zip(names) {
        let height = LETTERS as i32 + 2;
        // Sans-serif letters are about half as wide as high.
        let width = (0.55 * f64::from(LETTERS) * name.chars().count() as f64) as i32;
        let beside = |dy: i32| [(x + 8, y + dy), (x - 8 - width, y + dy)];
        let spots = [0, -height, height, -2 * height, 2 * height].into_iter().flat_map(|dy| beside(dy - height / 2));
        let places = spots.map(|(left, top)| Place { left, top, width, height });
        let is_free = |place: &Place| {
            let is_inside = place.left + place.width <= right && place.top + place.height <= bottom;
            is_inside && !taken.iter().any(|other| other.overlaps(place))
        };
        let first = Place { left: x + 8, top: y - height / 2, width, height };
        let found = places.into_iter().find(is_free).unwrap_or(first);
        taken.push(found);
    }
    taken.split_off(points.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn group(name: &str, points: &[(&str, f64, f64)]) -> ScatterGroup {
        let point = |&(name, x, y): &(&str, f64, f64)| NamedPoint { name: name.to_owned(), x, y };
        ScatterGroup { name: name.to_owned(), points: points.iter().map(point).collect() }
    }

    fn plot(groups: Vec<ScatterGroup>) -> ScatterPlot {
        ScatterPlot { title: "gain".to_owned(), x: "V(M)".to_owned(), y: "less error, %".to_owned(), groups }
    }

    fn table_2() -> ScatterGroup {
        let models = crate::report::paper::MODELS;
        let rows: Vec<_> = models.iter().filter_map(|m| Some((m.name, m.table2?))).collect();
        let points: Vec<_> = rows.iter().map(|(name, row)| (*name, row.visibility, row.less_error)).collect();
        group("Zhang & Turk", &points)
    }

    #[test]
    fn names_axes_and_the_correlation_are_in_the_document() {
        let svg = plot(vec![table_2()]).to_svg().unwrap();
        for text in ["gain", "V(M)", "less error, %", "Locomotive", "rank correlation: −0.94 (6 models)"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(svg.matches("<circle").count(), 6);
        assert!(!svg.contains("Zhang"), "one group needs no legend");
    }

    #[test]
    fn each_group_has_its_own_correlation() {
        let rising = group("best", &[("a", 0.0, 1.0), ("b", 1.0, 2.0), ("c", 2.0, 3.0), ("d", f64::NAN, 0.0)]);
        let svg = plot(vec![rising, group("one", &[("e", 0.5, -1.0)])]).to_svg().unwrap();
        assert!(svg.contains("best 1.00 (3 models), one unknown (1 models)"));
        // Four points and two marks in the legend.
        assert_eq!(svg.matches("<circle").count(), 6);
    }

    #[test]
    fn names_stand_clear_of_points_and_of_each_other() {
        // Five points in a heap, as models of one kind are.
        let points = [(100, 100), (110, 102), (120, 104), (100, 110), (300, 8)];
        let names = ["engine", "hand", "part", "skull", "bunny at the edge"];
        let places = place_names(&points, &names, [320, 400]);
        for (i, place) in places.iter().enumerate() {
            assert!(points.iter().all(|&at| !Place::disc(at).overlaps(place)), "{} lies on a point", names[i]);
            assert!(places[..i].iter().all(|other| !other.overlaps(place)), "{} lies on a name", names[i]);
            assert!(place.left + place.width <= 320);
        }
    }

    #[test]
    fn a_plot_without_points_is_still_a_document() {
        assert!(plot(vec![group("none", &[])]).to_svg().unwrap().ends_with("</svg>\n"));
    }
}
