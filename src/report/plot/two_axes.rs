//! Two errors of several methods over the number of triangles, each error with an axis of its own.

use std::io;
use std::ops::Range;

use plotters::chart::DualCoordChartContext;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;

use super::{Drawn, GRID, LEGEND_LINE, MOST_LEGEND, PAIR, plain, svg_of};
use crate::report::table::thousands;

/// Image error against the left axis, geometric error against the right one, over the number of triangles.
///
/// All three axes are logarithmic. Triangles decrease to the right, as a simplification runs. Both errors have as many
/// pixels a decade, so that slopes compare, and bands of their own, so that their curves do not cross.
///
/// Source: Zhang & Turk 2002, figure 4.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoAxisPlot {
    /// Above it.
    pub title: String,
    /// What the left axis measures, with its unit.
    pub left: String,
    /// What the right axis measures, with its unit.
    pub right: String,
    /// One colour each.
    pub methods: Vec<MethodCurves>,
}

/// Both errors of a method as (triangles, error), both above 0, others are left out; descending or ascending in triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodCurves {
    /// In the legend.
    pub name: String,
    /// Drawn through, with discs.
    pub left: Vec<(usize, f64)>,
    /// Dashed, with open circles.
    pub right: Vec<(usize, f64)>,
}

/// Pixels of the plot.
const SIZE: (u32, u32) = (640, 500);
/// Of it, between the axes.
const INNER_HEIGHT: f64 = 400.0;

/// Room between a band and what is next to it, in decades.
const GAP: f64 = 0.12;

/// An axis of logarithms: the library's own has the system's logarithm and takes no marks at chosen places.
#[derive(Debug, Clone, PartialEq)]
struct Scale {
    ends: (f64, f64),
    marks: Vec<f64>,
}

type Chart<'a, B> = DualCoordChartContext<'a, B, Cartesian2d<Scale, Scale>, Cartesian2d<Scale, Scale>>;
/// Points as the axes place them.
type Places = Vec<(f64, f64)>;

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (place - self.ends.0) / (self.ends.1 - self.ends.0);
        from + libm::round(share * f64::from(to - from)) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.marks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

impl TwoAxisPlot {
    /// The plot as an SVG document.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn to_svg(&self) -> io::Result<String> {
        svg_of(SIZE, |area| {
            let bands = Bands::of(self);
            let mut chart = ChartBuilder::on(area)
                .caption(&self.title, ("sans-serif", 18))
                .margin(14)
                .x_label_area_size(44)
                .y_label_area_size(64)
                .right_y_label_area_size(72)
                .build_cartesian_2d(self.x_scale(), bands.left_scale())?
                .set_secondary_coord(self.x_scale(), bands.right_scale());
            self.draw_axes(&mut chart)?;
            for (method, colour) in self.methods.iter().zip(PAIR.iter().cycle()) {
                draw_method(&mut chart, method, *colour)?;
            }
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperLeft)
                .label_font(("sans-serif", 14))
                .background_style(WHITE.mix(0.85))
                .border_style(RGBColor(200, 200, 200))
                .draw()
        })
    }

    fn draw_axes<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>) -> Drawn<B> {
        let error = |place: &f64| plain(libm::exp10(*place));
        chart
            .configure_mesh()
            .x_desc("triangles (logarithmic, fewer to the right)")
            .y_desc(&self.left)
            .x_label_formatter(&|place| thousands(libm::round(libm::exp10(-place)) as u64))
            .y_label_formatter(&error)
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .bold_line_style(GRID)
            .draw()?;
        chart
            .configure_secondary_axes()
            .y_desc(&self.right)
            .y_label_formatter(&error)
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .draw()
    }

    /// Every number of triangles that has a point: these are numbered, as far as their numbers do not overlap.
    fn x_scale(&self) -> Scale {
        let points = self.methods.iter().flat_map(|method| method.left.iter().chain(&method.right));
        let mut marks: Vec<f64> = points.filter_map(|&(n, error)| place(n, error)).map(|(x, _)| x).collect();
        marks.sort_unstable_by(f64::total_cmp);
        let (from, to) = ends(&marks);
        let room = 0.1 * (to - from);
        marks.dedup_by(|next, kept| *next - *kept < room);
        Scale { ends: (from - 0.5 * room, to + 0.5 * room), marks }
    }
}

/// Where the two errors lie on their axes, in decades.
struct Bands {
    left: (f64, f64),
    right: (f64, f64),
    /// Kept free above for the legend.
    head: f64,
}

impl Bands {
    fn of(plot: &TwoAxisPlot) -> Self {
        let band = |curve: fn(&MethodCurves) -> &Vec<(usize, f64)>| {
            ends(&plot.methods.iter().flat_map(|m| places(curve(m))).map(|(_, y)| y).collect::<Vec<_>>())
        };
        let (left, right) = (band(|m| &m.left), band(|m| &m.right));
        let curves = left.1 - left.0 + right.1 - right.0 + 3.0 * GAP;
        let legend = (LEGEND_LINE * (2 * plot.methods.len() + 1) as f64 / INNER_HEIGHT).min(MOST_LEGEND);
        Self { left, right, head: curves * legend / (1.0 - legend) }
    }

    /// Decades from top to bottom.
    fn height(&self) -> f64 {
        self.head + (self.left.1 - self.left.0) + (self.right.1 - self.right.0) + 3.0 * GAP
    }

    fn left_scale(&self) -> Scale {
        let top = self.left.1 + GAP + self.head;
        Scale { ends: (top - self.height(), top), marks: round_numbers(self.left) }
    }

    fn right_scale(&self) -> Scale {
        let bottom = self.right.0 - GAP;
        Scale { ends: (bottom, bottom + self.height()), marks: round_numbers(self.right) }
    }
}

/// Least and greatest of some places, at least a fifth of a decade apart; a decade if there are none.
fn ends(places: &[f64]) -> (f64, f64) {
    let least = places.iter().copied().fold(f64::INFINITY, f64::min);
    let most = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if least > most { (-1.0, 0.0) } else { (least.min(most - 0.1), most.max(least + 0.1)) }
}

/// The places of 1, 2 and 5 times the powers of ten in a band, and one beyond each end; powers alone where it is high.
fn round_numbers((from, to): (f64, f64)) -> Vec<f64> {
    let within = |place: &f64| (from - 2.0 * GAP..=to + 2.0 * GAP).contains(place);
    let digits: &[f64] = if to - from > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = libm::floor(from) as i32 - 1..=libm::ceil(to) as i32;
    let marks = decades.flat_map(|decade| digits.iter().map(move |d| f64::from(decade) + libm::log10(*d)));
    marks.filter(within).collect()
}

/// Where a point is drawn; `None` where a logarithmic axis has no place for it.
fn place(triangles: usize, error: f64) -> Option<(f64, f64)> {
    (triangles > 0 && error > 0.0).then(|| (-libm::log10(triangles as f64), libm::log10(error)))
}

fn places(curve: &[(usize, f64)]) -> Places {
    curve.iter().filter_map(|&(n, error)| place(n, error)).collect()
}

fn draw_method<'a, B: DrawingBackend + 'a>(
    chart: &mut Chart<'a, B>,
    method: &MethodCurves,
    colour: RGBColor,
) -> Drawn<B> {
    let line = colour.stroke_width(2);
    let (left, right) = (places(&method.left), places(&method.right));
    chart
        .draw_series(LineSeries::new(left.clone(), line))?
        .label(format!("{}, left axis", method.name))
        .legend(move |at| EmptyElement::at(at) + stroke(0, 20, line) + Circle::new((10, 0), 4, colour.filled()));
    chart.draw_series(left.into_iter().map(|at| Circle::new(at, 4, colour.filled())))?;
    chart
        .draw_secondary_series(DashedLineSeries::new(right.clone(), 10, 6, line))?
        .label(format!("{}, right axis", method.name))
        .legend(move |at| {
            EmptyElement::at(at) + stroke(0, 6, line) + stroke(14, 20, line) + Circle::new((10, 0), 4, line)
        });
    chart.draw_secondary_series(right.into_iter().map(|at| Circle::new(at, 4, line)))?;
    Ok(())
}

/// A piece of a line in the legend.
fn stroke(from: i32, to: i32, style: ShapeStyle) -> PathElement<(i32, i32)> {
    PathElement::new([(from, 0), (to, 0)], style)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn plot(methods: Vec<MethodCurves>) -> TwoAxisPlot {
        TwoAxisPlot { title: "Motor".to_owned(), left: "image".to_owned(), right: "geometry".to_owned(), methods }
    }

    fn engine() -> TwoAxisPlot {
        let counts = [55_168, 27_584, 13_792, 6_896, 3_448, 1_724, 862];
        let curve = |errors: [f64; 7]| counts.into_iter().zip(errors).collect::<Vec<_>>();
        let quadric = MethodCurves {
            name: "QB".to_owned(),
            left: curve([9.0, 17.1, 19.4, 25.0, 28.7, 32.9, 37.3]),
            right: curve([0.01, 0.03, 0.06, 0.1, 0.2, 0.4, 0.9]),
        };
        let visibility = MethodCurves {
            name: "VG".to_owned(),
            left: curve([1.0, 5.4, 9.0, 18.6, 22.0, 25.5, 30.6]),
            right: curve([0.02, 0.08, 0.1, 0.3, 0.6, 1.2, 2.4]),
        };
        plot(vec![quadric, visibility])
    }

    /// The height above the bottom of each circle of a colour, in the order in which they are drawn.
    fn heights(svg: &str) -> Vec<f64> {
        let circles = svg.lines().filter(|line| line.starts_with("<circle"));
        let attribute = |line: &str| line.split("cy=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>();
        circles.map(|line| f64::from(SIZE.1) - attribute(line).unwrap()).collect()
    }

    #[test]
    fn both_axes_all_methods_and_every_point_are_in_the_document() {
        let svg = engine().to_svg().unwrap();
        for text in ["Motor", "image", "geometry", "QB, left axis", "VG, right axis", "55,168", "862", "triangles"] {
            assert!(svg.contains(text), "{text}");
        }
        // 7 points on 4 curves, and a mark for each curve in the legend.
        assert_eq!(heights(&svg).len(), 28 + 4);
        assert_eq!(svg, engine().to_svg().unwrap());
    }

    #[test]
    fn every_image_error_stands_above_every_geometric_one() {
        let heights = heights(&engine().to_svg().unwrap());
        let band = |curve: usize| &heights[7 * curve..7 * (curve + 1)];
        let lowest = [band(0), band(2)].concat().into_iter().fold(f64::INFINITY, f64::min);
        let highest = [band(1), band(3)].concat().into_iter().fold(0.0, f64::max);
        assert!(lowest > highest);
        // Errors grow to the coarse end.
        assert!((0..4).all(|curve| band(curve).is_sorted()));
    }

    #[test]
    fn a_decade_is_as_high_on_both_sides() {
        let same = |factor: f64| MethodCurves {
            name: String::new(),
            left: vec![(100, 1.0), (10, factor)],
            right: vec![(100, 0.01), (10, 0.01 * factor)],
        };
        let heights = heights(&plot(vec![same(10.0)]).to_svg().unwrap());
        // Pixels are whole numbers.
        assert!((heights[1] - heights[0] - (heights[3] - heights[2])).abs() <= 1.0);
    }

    #[test]
    fn errors_of_zero_are_left_out_and_no_errors_make_an_empty_plot() {
        let zero = MethodCurves { name: "QB".to_owned(), left: vec![(8, 0.0), (4, 1.0)], right: vec![(0, 1.0)] };
        assert_eq!(heights(&plot(vec![zero]).to_svg().unwrap()).len(), 1 + 2);
        assert!(plot(Vec::new()).to_svg().unwrap().ends_with("</svg>\n"));
    }
}
