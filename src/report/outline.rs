//! The picture of an outline and of its visibility diagram, side by side.

use glam::DVec2;

use super::colour::mix;
use super::diagram::green;
use super::legend;
use super::picture::{Area, FAINT, Font, INK, LINE, Picture, TextStyle, WHITE};
use crate::visibility::outline::{Outline, OutlineDiagram};

/// Room around everything, and between the two halves.
const MARGIN: u32 = 36;
/// Room left of the diagram for the cameras' angles.
const ANGLES: u32 = 44;
/// Pixels along the side of the drawing.
const DRAWING: u32 = 600;
/// Radius of the circle of cameras, in the drawing.
const RING: f64 = 0.44 * DRAWING as f64;
/// Largest distance of the outline from the middle, in radii of the circle.
const REACH: f64 = 0.82;
/// Thickness of the boundary.
const STROKE: f64 = 2.5;
/// What is solid.
const SOLID: [u8; 3] = [226, 226, 226];
/// Length of the marks at the axes.
const TICK: u32 = 6;

const TITLE: TextStyle = TextStyle { font: Font::Bold, scale: 1, colour: INK };
const NAME: TextStyle = TextStyle { font: Font::Bold, scale: 1, colour: INK };
const QUIET: TextStyle = TextStyle { font: Font::Small, scale: 1, colour: FAINT };

/// Draws an outline with the names of its corners, and beside it which camera sees which point.
///
/// In the diagram the boundary runs from left to right, from corner A all the way round, cameras from below to above; it is
/// white where a camera does not see a point, else green, the brighter the more squarely it looks. One pixel is one sample
/// and one camera.
///
/// Source: Zhang & Turk 2002, figure 1.
#[must_use]
pub fn outline_picture(outline: &Outline, diagram: &OutlineDiagram) -> Picture {
    let (columns, rows) = (diagram.samples as u32, diagram.cameras as u32);
    let top = MARGIN + TITLE.height() + 12;
    let plot = Area { left: 2 * MARGIN + DRAWING + ANGLES, top, width: columns, height: rows };
    let key = legend::gradient(green, &key_ticks(), "cosine at which a camera sees a point; white: unseen", 480);
    let axes = TICK + 2 * (NAME.height() + 4);
    let height = top + DRAWING.max(rows + axes) + 16 + key.height() + MARGIN;
    let mut page = Picture::filled(plot.left + columns.max(key.width()) + MARGIN, height, WHITE);

    page.text("outline, and the circle of cameras", MARGIN, MARGIN, TITLE);
    page.blit(&drawing(outline), MARGIN, top + (rows.max(DRAWING) - DRAWING) / 2);
    page.text("which camera sees which point of the boundary", plot.left, MARGIN, TITLE);
    page.frame(plot, LINE);
    page.blit(&pixels(diagram), plot.left, plot.top);
    draw_boundary_axis(&mut page, outline, plot);
    draw_camera_axis(&mut page, plot);
    page.blit(&key, plot.left - legend::SIDE, height - MARGIN - key.height());
    page
}

fn key_ticks() -> [(f64, String); 3] {
    [0.0, 0.5, 1.0].map(|place| (place, place.to_string()))
}

/// The diagram itself.
fn pixels(diagram: &OutlineDiagram) -> Picture {
    let (columns, rows) = (diagram.samples as u32, diagram.cameras as u32);
    let mut picture = Picture::filled(columns, rows, WHITE);
    for x in 0..columns {
        for y in 0..rows {
            let cosine = diagram.cosine(x as usize, (rows - 1 - y) as usize);
            if cosine > 0.0 {
                picture.set(x, y, green(cosine));
            }
        }
    }
    picture
}

/// The name of the `i`-th sharp corner: A to Z, then numbers.
fn name(i: usize) -> String {
    u8::try_from(i).ok().filter(|i| *i < 26).map_or_else(|| (i + 1).to_string(), |i| char::from(b'A' + i).to_string())
}

/// Names of corners below the diagram, where they have room.
fn draw_boundary_axis(page: &mut Picture, outline: &Outline, plot: Area) {
    let foot = plot.top + plot.height;
    let mut free_from = 0;
    let marks = outline.sharp_corners().into_iter().enumerate().map(|(i, corner)| (name(i), outline.length_to(corner)));
    for (name, length) in marks {
        let x = plot.left + (length / outline.length() * f64::from(plot.width)).round() as u32;
        page.fill(Area { left: x, top: foot, width: 1, height: TICK }, FAINT);
        let left = x.saturating_sub(NAME.width_of(&name) / 2);
        if left >= free_from {
            page.text(&name, left, foot + TICK + 2, NAME);
            free_from = left + NAME.width_of(&name) + 2;
        }
    }
    let text = "along the boundary, counter-clockwise";
    page.text(text, plot.left, foot + TICK + NAME.height() + 6, QUIET);
}

/// Directions of cameras beside the diagram, in degrees.
fn draw_camera_axis(page: &mut Picture, plot: Area) {
    for degrees in [0_u32, 90, 180, 270, 360] {
        let y = plot.top + plot.height - degrees * plot.height / 360;
        page.fill(
            Area { left: plot.left - TICK - 1, top: y.min(plot.top + plot.height - 1), width: TICK, height: 1 },
            FAINT,
        );
        let text = format!("{degrees}°");
        let left = plot.left - TICK - 4 - QUIET.width_of(&text);
        page.text(&text, left, y.saturating_sub(QUIET.height() / 2), QUIET);
    }
}

/// Where the drawing's units lie in its pixels.
struct Placing {
    centre: DVec2,
    /// Pixels per unit.
    scale: f64,
}

impl Placing {
    fn of(outline: &Outline) -> Self {
        let fold = |f: fn(DVec2, DVec2) -> DVec2| outline.corners().iter().copied().reduce(f).unwrap_or_default();
        let centre = fold(DVec2::min).midpoint(fold(DVec2::max));
        let reach = outline.corners().iter().map(|c| c.distance(centre)).fold(f64::MIN_POSITIVE, f64::max);
        Self { centre, scale: REACH * RING / reach }
    }

    /// In pixels from the middle of the drawing, upward positive.
    fn pixel_of(&self, point: DVec2) -> DVec2 {
        (point - self.centre) * self.scale
    }
}

/// The outline, filled, with names at its corners and the circle of cameras around it.
fn drawing(outline: &Outline) -> Picture {
    let placing = Placing::of(outline);
    let segments: Vec<[DVec2; 2]> =
        (0..outline.corners().len()).map(|i| outline.segment(i).map(|c| placing.pixel_of(c))).collect();
    let mut picture = Picture::filled(DRAWING, DRAWING, WHITE);
    for y in 0..DRAWING {
        for x in 0..DRAWING {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(DRAWING - y) - 0.5) - 0.5 * f64::from(DRAWING);
            picture.set(x, y, ink(at, &segments));
        }
    }
    draw_names(&mut picture, outline, &placing);
    draw_directions(&mut picture);
    picture
}

/// The colour of a place: boundary over solid over the circle over white, edges softened over one pixel.
fn ink(at: DVec2, segments: &[[DVec2; 2]]) -> [u8; 3] {
    let covered = |distance: f64, width: f64| (0.5 * width + 0.5 - distance).clamp(0.0, 1.0);
    let is_solid = segments.iter().filter(|s| is_crossed_rightward(at, **s)).count() % 2 == 1;
    let ground = if is_solid { SOLID } else { mix(WHITE, LINE, covered((at.length() - RING).abs(), 1.0)) };
    let distance = segments.iter().map(|s| distance_to(at, *s)).fold(f64::INFINITY, f64::min);
    mix(ground, INK, covered(distance, STROKE))
}

/// True if the way from a place to the right crosses a segment.
fn is_crossed_rightward(at: DVec2, [a, b]: [DVec2; 2]) -> bool {
    (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
}

fn distance_to(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let share = ((at - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    at.distance(a + along * share)
}

/// Names outside the corners, in the direction between the two normals.
fn draw_names(picture: &mut Picture, outline: &Outline, placing: &Placing) {
    const AWAY: f64 = 14.0;
    let count = outline.corners().len();
    for (i, corner) in outline.sharp_corners().into_iter().enumerate() {
        let outward = outline.normal((corner + count - 1) % count) + outline.normal(corner);
        let at = placing.pixel_of(outline.corners()[corner]) + outward.normalize_or_zero() * AWAY;
        write_centred(picture, &name(i), at, NAME);
    }
}

/// The directions of some cameras, outside their circle.
fn draw_directions(picture: &mut Picture) {
    let out = RING + 20.0;
    let sides = [("0°", DVec2::X), ("90°", DVec2::Y), ("180°", DVec2::NEG_X), ("270°", DVec2::NEG_Y)];
    sides.iter().for_each(|(text, side)| write_centred(picture, text, *side * out, QUIET));
}

/// Writes text around a place of the drawing.
fn write_centred(picture: &mut Picture, text: &str, at: DVec2, style: TextStyle) {
    let middle = 0.5 * f64::from(DRAWING);
    let left = middle + at.x - 0.5 * f64::from(style.width_of(text));
    let top = middle - at.y - 0.5 * f64::from(style.height());
    picture.text(text, left.max(0.0).round() as u32, top.max(0.0).round() as u32, style);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn square() -> Outline {
        Outline::new([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from_array).to_vec()).unwrap()
    }

    #[test]
    fn the_bottom_of_a_square_is_brightest_from_below_and_unseen_from_above() {
        // The first quarter of the boundary is the bottom; row 0 is the last camera, the first camera is at the foot.
        let picture = pixels(&square().diagram(8, 360));
        let seen = |x: u32, degrees: u32| picture.pixel(x, 359 - degrees).unwrap();
        assert_eq!(seen(0, 270), [0, 255, 0]);
        assert_eq!(seen(0, 90), WHITE);
        assert_eq!(seen(1, 210), [0, 128, 0]);
        assert_eq!(seen(2, 0), [0, 255, 0], "the right side from the right");
    }

    #[test]
    fn the_drawing_is_solid_inside_and_white_outside() {
        let picture = drawing(&square());
        assert_eq!(picture.pixel(DRAWING / 2, DRAWING / 2), Some(SOLID));
        assert_eq!(picture.pixel(2, 2), Some(WHITE));
        // Half the diagonal is REACH of the circle's radius; the boundary is dark.
        let side = (REACH * RING / 2.0_f64.sqrt()) as u32;
        assert_eq!(picture.pixel(DRAWING / 2 + side, DRAWING / 2), Some(INK));
        assert_eq!(picture.pixel(DRAWING / 2 + side + 4, DRAWING / 2), Some(WHITE));
    }

    #[test]
    fn corners_are_named_from_a_to_z_and_then_by_number() {
        assert_eq!([0, 25, 26, 300].map(name), ["A", "Z", "27", "301"]);
    }

    #[test]
    fn the_page_holds_the_diagram_whole() {
        let diagram = square().diagram(400, 100);
        let page = outline_picture(&square(), &diagram);
        let is_green = |p: &&[u8]| p[0] == 0 && p[2] == 0 && p[1] > 0;
        let count = |picture: &Picture| picture.as_rgb().chunks(3).filter(is_green).count();
        // The key below has greens too.
        assert!(count(&page) > count(&pixels(&diagram)));
        assert!((0..page.height()).all(|y| (0..16).all(|x| page.pixel(x, y) == Some(WHITE))));
    }
}
