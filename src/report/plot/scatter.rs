//! Two numbers of several models: where each stands, by name.

use std::io;
use std::ops::Range;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::{Drawn, GRID, PAIR, plain, svg_of};
use crate::report::rank::rank_correlation;

/// Points with names over linear axes, in one or several groups. A line above tells each group's rank correlation, in its
/// colour: the legend. Points of the same name are joined, and named at the last of them.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterPlot {
    /// Above it; the correlations follow.
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
const SIZE: (u32, u32) = (1000, 680);
/// Pixels of a name's letters.
const LETTERS: u32 = 13;
/// Lines between points of one name.
const JOIN: RGBColor = RGBColor(190, 190, 190);

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl ScatterPlot {
    /// The plot as an SVG document.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn to_svg(&self) -> io::Result<String> {
        svg_of(SIZE, |area| {
            let mut area = area.titled(&self.title, ("sans-serif", 18))?;
            for (group, colour) in self.groups.iter().zip(PAIR.iter().cycle()) {
                area = area.titled(&self.correlation(group), ("sans-serif", 15).into_font().color(colour))?;
            }
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
        let points: Vec<(&NamedPoint, RGBColor)> = self.coloured_points();
        let last = |i: &usize| points[i + 1..].iter().all(|(later, _)| later.name != points[*i].0.name);
        let named: Vec<usize> = (0..points.len()).filter(last).collect();
        for &i in &named {
            let same = points.iter().filter(|(point, _)| point.name == points[i].0.name);
            chart.draw_series([PathElement::new(same.map(|(p, _)| (p.x, p.y)).collect::<Vec<_>>(), JOIN)])?;
        }
        chart.draw_series(points.iter().map(|(p, colour)| Circle::new((p.x, p.y), 4, colour.filled())))?;
        let pixels: Vec<(i32, i32)> = points.iter().map(|(p, _)| chart.backend_coord(&(p.x, p.y))).collect();
        let area = chart.plotting_area().strip_coord_spec();
        let ranges = area.get_pixel_range();
        let names: Vec<(usize, &str)> = named.iter().map(|&i| (i, points[i].0.name.as_str())).collect();
        let places = place_names(&pixels, &names, [ranges.0.clone(), ranges.1.clone()]);
        for ((i, name), at) in names.iter().zip(places) {
            let at = (at.left - ranges.0.start, at.top - ranges.1.start);
            area.draw(&Text::new((*name).to_owned(), at, ("sans-serif", LETTERS).into_font().color(&points[*i].1)))?;
        }
        Ok(())
    }

    /// All points that can be shown, with the colours of their groups.
    fn coloured_points(&self) -> Vec<(&NamedPoint, RGBColor)> {
        let groups = self.groups.iter().zip(PAIR.iter().cycle());
        groups.flat_map(|(group, colour)| group.points.iter().filter(|p| p.is_finite()).map(|p| (p, *colour))).collect()
    }

    fn values(&self, value: fn(&NamedPoint) -> f64) -> Vec<f64> {
        self.coloured_points().into_iter().map(|(p, _)| value(p)).collect()
    }

    /// `● paper: Spearman's rank correlation −0.71 (7 models)`
    fn correlation(&self, group: &ScatterGroup) -> String {
        let points: Vec<&NamedPoint> = group.points.iter().filter(|p| p.is_finite()).collect();
        let [xs, ys] = [|p: &&NamedPoint| p.x, |p: &&NamedPoint| p.y].map(|f| points.iter().map(f).collect::<Vec<_>>());
        let value = rank_correlation(&xs, &ys).map_or("unknown".to_owned(), |r| format!("{r:.2}").replace('-', "−"));
        format!("● {}: Spearman's rank correlation {value} ({} models)", group.name, points.len())
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

/// Lines that a name may stand above or below its point.
const FARTHEST: i32 = 6;

/// A place for each name of a point, given by its place among `points`: right, left, above or below, whichever is free first,
/// else farther up or down; right where nothing is free.
fn place_names(points: &[(i32, i32)], names: &[(usize, &str)], [columns, rows]: [Range<i32>; 2]) -> Vec<Place> {
    let mut taken: Vec<Place> = points.iter().map(|&at| Place::disc(at)).collect();
    for &(i, name) in names {
        let (x, y) = points[i];
        let height = LETTERS as i32 + 2;
        // Sans-serif letters are little more than half as wide as high.
        let width = (0.57 * f64::from(LETTERS) * name.chars().count() as f64) as i32;
        let at = |left: i32, line: i32| Place { left, top: y + line * height / 2 - height / 2, width, height };
        let around = |line: i32| [at(x + 8, line), at(x - 8 - width, line), at(x - width / 2, line)];
        let lines = (0..=2 * FARTHEST).flat_map(|line| [-line, line]);
        let is_free = |place: &Place| {
            let is_inside = place.left >= columns.start
                && place.left + place.width <= columns.end
                && place.top >= rows.start
                && place.top + place.height <= rows.end;
            is_inside && !taken.iter().any(|other| other.overlaps(place))
        };
        let found = lines.flat_map(around).find(is_free).unwrap_or(at(x + 8, 0));
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
        for text in ["gain", "V(M)", "less error, %", "Locomotive", "rank correlation −0.94 (6 models)"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(svg.matches("<circle").count(), 6);
    }

    #[test]
    fn each_group_has_its_own_correlation() {
        let rising = [("a", 0.0, 1.0), ("b", 1.0, 2.0), ("c", 2.0, 3.0), ("d", 3.0, 4.0), ("e", 4.0, 5.0)];
        let rising = group("best", &[&rising[..], &[("f", f64::NAN, 0.0)]].concat());
        let svg = plot(vec![rising, group("one", &[("g", 0.5, -1.0)])]).to_svg().unwrap();
        for text in ["rank correlation 1.00 (5 models)", "rank correlation unknown (1 models)"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(svg.matches("<circle").count(), 6);
    }

    #[test]
    fn a_model_in_two_groups_is_named_once() {
        let svg =
            plot(vec![group("paper", &[("cow", 0.5, 1.0)]), group("best", &[("cow", 0.4, 2.0)])]).to_svg().unwrap();
        assert_eq!(svg.lines().filter(|line| *line == "cow").count(), 1);
        assert_eq!(svg.matches("<circle").count(), 2);
    }

    #[test]
    fn names_stand_clear_of_points_and_of_each_other() {
        // A heap of points, as models of one kind are, the last two close to the edges.
        let heap = (0..18).map(|i| (100 + 7 * (i % 5), 100 + 5 * (i % 4)));
        let points: Vec<(i32, i32)> = heap.chain([(300, 8), (4, 398)]).collect();
        let names = (0..points.len()).map(|i| (i, "some model")).collect::<Vec<_>>();
        let places = place_names(&points, &names, [0..320, 0..400]);
        for (i, place) in places.iter().enumerate() {
            assert!(points.iter().all(|&at| !Place::disc(at).overlaps(place)), "{i} lies on a point");
            assert!(places[..i].iter().all(|other| !other.overlaps(place)), "{i} lies on a name");
            assert!(place.left >= 0 && place.left + place.width <= 320);
            assert!(place.top >= 0 && place.top + place.height <= 400);
        }
    }

    #[test]
    fn a_plot_without_points_is_still_a_document() {
        assert!(plot(vec![group("none", &[])]).to_svg().unwrap().ends_with("</svg>\n"));
    }
}
