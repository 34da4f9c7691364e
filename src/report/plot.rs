//! Plots as SVG.

mod scatter;
mod two_axes;

pub use scatter::{NamedPoint, ScatterGroup, ScatterPlot};
pub use two_axes::{MethodCurves, TwoAxisPlot};

use std::io;

use plotters::coord::Shift;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;

/// Curves over logarithmic axes, in panels side by side that share their ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct LogLogPlot {
    /// From left to right.
    pub panels: Vec<Panel>,
    /// What the horizontal axis counts.
    pub x: String,
    /// What the vertical axis measures, with its unit.
    pub y: String,
    /// A thin line shows this power of x, for comparison.
    pub slope: f64,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Curves that belong together have one colour.
    pub groups: Vec<Vec<Curve>>,
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// In the legend.
    pub name: String,
    /// Ascending in x; both above 0, other points are left out.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub mark: Mark,
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Dashed, with open circles.
    Open,
    /// Drawn through, with discs.
    Filled,
}

/// Pixels of a panel.
const PANEL: (u32, u32) = (620, 560);

/// Pixels of a line of a legend.
const LEGEND_LINE: f64 = 18.0;
/// The largest share of a plot that is kept free for its legend; a longer one is laid over the curves.
const MOST_LEGEND: f64 = 0.5;

/// Okabe & Ito 2008: told apart by every eye.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

/// Colours for two methods that are compared, and for more.
const PAIR: [RGBColor; 4] = [COLOURS[1], COLOURS[0], COLOURS[2], COLOURS[3]];

/// Lines at the numbers of an axis.
const GRID: RGBColor = RGBColor(225, 225, 225);

type Ranges = [(f64, f64); 2];
type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<WithKeyPoints<LogCoord<f64>>, LogCoord<f64>>>;
type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

impl LogLogPlot {
    /// The plot as an SVG document.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn to_svg(&self) -> io::Result<String> {
        let size = (PANEL.0 * self.panels.len().max(1) as u32, PANEL.1);
        svg_of(size, |root| {
            let areas = root.split_evenly((1, self.panels.len().max(1)));
            let ranges = self.ranges();
            self.panels.iter().zip(&areas).try_for_each(|(panel, area)| self.draw_panel(panel, area, ranges))
        })
    }

    /// Ranges of x and y that hold all points.
    fn ranges(&self) -> Ranges {
        let points = || self.panels.iter().flat_map(|p| p.groups.iter().flatten()).flat_map(visible);
        let range = |value: fn((f64, f64)) -> f64| {
            let least = points().map(value).fold(f64::INFINITY, f64::min);
            let most = points().map(value).fold(0.0, f64::max);
            if least <= most { (least / 1.3, most * 1.3) } else { (0.1, 1.0) }
        };
        let (x, y) = (range(|p| p.0), range(|p| p.1));
        // Whole decades of y, so that enough of its numbers are round.
        let (least, top) = (libm::log10(y.0), f64::ceil(libm::log10(y.1)));
        // The legend stands at the lower left, and no point behind it.
        let legend = self.legend_share();
        let bottom = f64::floor(least).min((least - legend * top) / (1.0 - legend));
        [x, (libm::exp10(bottom), libm::exp10(top))]
    }

    /// The share of a panel's height that the legend takes.
    fn legend_share(&self) -> f64 {
        let curves = |panel: &Panel| panel.groups.iter().map(Vec::len).sum::<usize>();
        let lines = 1 + self.panels.iter().map(curves).max().unwrap_or(0);
        (LEGEND_LINE * (lines + 1) as f64 / f64::from(PANEL.1)).min(MOST_LEGEND)
    }

    /// Every x that has a point: these are numbered, not round ones that nobody measured.
    fn places(&self) -> Vec<f64> {
        let curves = self.panels.iter().flat_map(|panel| panel.groups.iter().flatten());
        let mut places: Vec<f64> = curves.flat_map(visible).map(|(x, _)| x).collect();
        places.sort_unstable_by(f64::total_cmp);
        places.dedup();
        places
    }

    fn draw_panel<B: DrawingBackend>(&self, panel: &Panel, area: &DrawingArea<B, Shift>, ranges: Ranges) -> Drawn<B> {
        let [x, y] = ranges;
        let mut chart = ChartBuilder::on(area)
            .caption(&panel.title, ("sans-serif", 18))
            .margin(14)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d((x.0..x.1).log_scale().with_key_points(self.places()), (y.0..y.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| plain(*y))
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .light_line_style(RGBColor(235, 235, 235))
            .draw()?;
        self.draw_slope(&mut chart, ranges)?;
        for (group, colour) in panel.groups.iter().zip(COLOURS.iter().cycle()) {
            group.iter().try_for_each(|curve| draw_curve(&mut chart, curve, *colour))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .label_font(("sans-serif", 13))
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .draw()
    }

    /// The line of comparison, from the upper left corner down.
    fn draw_slope<'a, B: DrawingBackend + 'a>(&self, chart: &mut Chart<'a, B>, [x, y]: Ranges) -> Drawn<B> {
        let grey = RGBColor(120, 120, 120);
        let end = x.1.min(x.0 * libm::pow(y.0 / y.1, 1.0 / self.slope));
        let at = |x_here: f64| (x_here, y.1 * libm::pow(x_here / x.0, self.slope));
        chart
            .draw_series([PathElement::new([at(x.0), at(end)], grey)])?
            .label(format!("slope {}", self.slope))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], grey));
        Ok(())
    }
}

/// What `draw` draws on white, which dark pages show too, as an SVG document of so many pixels.
fn svg_of(
    size: (u32, u32),
    draw: impl for<'a> FnOnce(&DrawingArea<SVGBackend<'a>, Shift>) -> Drawn<SVGBackend<'a>>,
) -> io::Result<String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).and_then(|()| draw(&root)).and_then(|()| root.present()).map_err(io::Error::other)?;
    }
    Ok(svg)
}

/// Points that a logarithmic axis can show.
fn visible(curve: &Curve) -> Vec<(f64, f64)> {
    curve.points.iter().copied().filter(|&(x, y)| x > 0.0 && y > 0.0).collect()
}

/// A number without the digits that only rounding gave it: `0.3`, not `0.30000000000000004`.
fn plain(number: f64) -> String {
    let digits = format!("{number:.9}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    if digits == "-0" { "0".to_owned() } else { digits.to_owned() }
}

fn draw_curve<'a, B: DrawingBackend + 'a>(chart: &mut Chart<'a, B>, curve: &Curve, colour: RGBColor) -> Drawn<B> {
    let line = colour.stroke_width(2);
    let filled = curve.mark == Mark::Filled;
    let marker = if filled { colour.filled() } else { line };
    let drawn = if filled {
        chart.draw_series([PathElement::new(visible(curve), line)])?
    } else {
        chart.draw_series(DashedLineSeries::new(visible(curve), 10, 6, line))?
    };
    drawn.label(&curve.name).legend(move |(x, y)| {
        EmptyElement::at((x, y)) + PathElement::new([(0, 0), (20, 0)], line) + Circle::new((10, 0), 4, marker)
    });
    chart.draw_series(visible(curve).into_iter().map(|point| Circle::new(point, 4, marker)))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn names_axes_and_every_point_are_in_the_document() {
        let points = vec![(6.0, 0.2), (18.0, 0.1), (66.0, 0.0)];
        let curve = Curve { name: "one, equal".to_owned(), points, mark: Mark::Filled };
        let panel = Panel { title: "the title".to_owned(), groups: vec![vec![curve]] };
        let plot = LogLogPlot { panels: vec![panel], x: "cameras".to_owned(), y: "error".to_owned(), slope: -0.75 };
        let svg = plot.to_svg().unwrap();
        for text in ["the title", "one, equal", "cameras", "error", "slope -0.75"] {
            assert!(svg.contains(text), "{text}");
        }
        // Two points can be shown, and one disc stands in the legend.
        assert_eq!(svg.matches("<circle").count(), 3);
    }

    /// Attribute `name` of an element of the document.
    fn number(element: &str, name: &str) -> f64 {
        element.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
    }

    #[test]
    fn no_point_lies_behind_the_legend() {
        // Low at the left, as no convergence is, and just above a decade.
        let curve = |i: usize| {
            let points = vec![(6.0, 0.0101), (18.0, 0.1), (4098.0, 0.0101)];
            Curve { name: format!("a mesh with a long name, {i}"), points, mark: Mark::Filled }
        };
        let panel = Panel { title: String::new(), groups: vec![(0..4).map(curve).collect()] };
        let plot = LogLogPlot { panels: vec![panel], x: String::new(), y: String::new(), slope: -0.75 };
        let svg = plot.to_svg().unwrap();
        let legend = svg.lines().rfind(|line| line.starts_with("<rect")).unwrap();
        let top = number(legend, "y");
        let circles: Vec<f64> =
            svg.lines().filter(|line| line.starts_with("<circle")).map(|line| number(line, "cy")).collect();
        // Three points on each of four curves above it, and one mark for each curve within.
        assert_eq!(circles.iter().filter(|&&y| y + 4.0 < top).count(), 12);
        assert_eq!(circles.iter().filter(|&&y| y > top).count(), 4);
    }

    #[test]
    fn numbers_lose_what_only_rounding_gave_them() {
        assert_eq!([0.1 + 0.2, -1e-17, -2.5, 100.0].map(plain), ["0.3", "0", "-2.5", "100"]);
    }

    #[test]
    fn a_plot_without_points_is_still_a_document() {
        let panel = Panel { title: String::new(), groups: Vec::new() };
        let plot = LogLogPlot { panels: vec![panel], x: String::new(), y: String::new(), slope: -1.0 };
        assert!(plot.to_svg().unwrap().ends_with("</svg>\n"));
    }
}
