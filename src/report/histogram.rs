//! How a quantity from 0 to 1 is spread, as a bar chart in the colours of its map; SVG.

use std::io;

use plotters::prelude::*;

use super::colour::ColourMap;

/// Shares of a whole in classes of equal width from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// The share of each class, in %.
    pub percents: Vec<f64>,
    /// What is spread, below the axis.
    pub x: String,
    /// What the shares are of, beside the axis.
    pub y: String,
    /// End of the vertical axis in %, so that several histograms can share it.
    pub top: f64,
    /// Colours of the bars.
    pub map: ColourMap,
}

/// Pixels.
const SIZE: (u32, u32) = (440, 270);

impl Histogram {
    /// Shares of the classes: `weights` of `values`, both in the same order; values outside 0 to 1 go to the end classes.
    #[must_use]
    pub fn percents_of(values: &[f64], weights: &[f64], classes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; classes];
        for (value, weight) in values.iter().zip(weights) {
            sums[((value * classes as f64) as usize).min(classes - 1)] += weight;
        }
        let total: f64 = sums.iter().sum();
        sums.iter().map(|sum| if total > 0.0 { 100.0 * sum / total } else { 0.0 }).collect()
    }

    /// The chart as an SVG document.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn to_svg(&self) -> io::Result<String> {
        let mut svg = String::new();
        {
            let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            root.fill(&WHITE).map_err(io::Error::other)?;
            self.draw(&root).map_err(io::Error::other)?;
            root.present().map_err(io::Error::other)?;
        }
        Ok(svg)
    }

    fn draw<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let mut chart = ChartBuilder::on(root)
            .margin(10)
            .x_label_area_size(44)
            .y_label_area_size(58)
            .build_cartesian_2d(0.0..1.0, 0.0..self.top)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| format!("{x:.1}"))
            .y_label_formatter(&|y| format!("{y:.0} %"))
            .y_labels(5)
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(228, 228, 228))
            .draw()?;
        let width = 1.0 / self.percents.len() as f64;
        let bars = self.percents.iter().enumerate().flat_map(|(class, &percent)| {
            let left = class as f64 * width;
            let [r, g, b] = self.map.colour(left + 0.5 * width);
            let corners = [(left, 0.0), (left + width, percent)];
            [
                Rectangle::new(corners, RGBColor(r, g, b).filled()),
                Rectangle::new(corners, RGBColor(90, 90, 90).stroke_width(1)),
            ]
        });
        chart.draw_series(bars).map(drop)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn classes_hold_the_weights_of_their_values() {
        let percents = Histogram::percents_of(&[0.0, 0.2, 0.5, 0.99, 1.0, 7.0], &[1.0, 1.0, 4.0, 2.0, 1.0, 1.0], 4);
        assert_eq!(percents, [20.0, 0.0, 40.0, 40.0]);
        assert_eq!(Histogram::percents_of(&[], &[], 2), [0.0, 0.0]);
    }

    #[test]
    fn every_class_is_a_bar_of_its_colour() {
        let percents = vec![25.0, 75.0];
        let (x, y) = ("visibility".to_owned(), "surface".to_owned());
        let svg = Histogram { percents, x, y, top: 80.0, map: ColourMap::Paper }.to_svg().unwrap();
        // The paper's map at 1/4 and 3/4: three quarters of the way from white to red, a quarter from yellow to green.
        assert!(svg.contains("#FF4040") && svg.contains("#BFFF00"), "{svg}");
        assert!(svg.contains("visibility") && svg.contains("surface"));
    }
}
