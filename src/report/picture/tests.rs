#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;

const RED: [u8; 3] = [255, 0, 0];

fn count(picture: &Picture, colour: [u8; 3]) -> usize {
    picture.as_rgb().chunks(3).filter(|p| *p == colour).count()
}

fn decoded(bytes: &[u8]) -> Picture {
    let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut rgb).unwrap();
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    Picture::from_rgb(frame.width, frame.height, rgb).unwrap()
}

#[test]
fn a_png_decodes_to_the_same_pixels() {
    let rgb = (0..37 * 11 * 3).map(|i| (i * 89 % 256) as u8).collect();
    let picture = Picture::from_rgb(37, 11, rgb).unwrap();
    let mut bytes = Vec::new();
    picture.write_png(&mut bytes).unwrap();
    assert_eq!(decoded(&bytes), picture);
}

#[test]
fn no_pixels_no_png() {
    assert!(Picture::filled(0, 5, WHITE).write_png(Vec::new()).is_err());
}

#[test]
fn a_full_disk_is_reported() {
    let mut disk = [0_u8; 40];
    let picture = Picture::filled(64, 64, WHITE);
    assert!(picture.write_png(&mut disk[..]).is_err());
}

#[test]
fn grey_levels_are_rounded_and_clamped() {
    let picture = Picture::from_grey(3, 2, &[0.0, 0.5, 254.6, 300.0, -7.0, f32::NAN]).unwrap();
    let levels: Vec<_> = picture.as_rgb().iter().step_by(3).copied().collect();
    assert_eq!(levels, [0, 1, 255, 255, 0, 0]);
}

#[test]
fn wrong_lengths_are_errors() {
    assert!(matches!(Picture::from_grey(2, 2, &[0.0; 5]), Err(Error::ShapeMismatch { got: 5, expected: 4, .. })));
    assert!(matches!(Picture::from_rgb(2, 2, vec![0; 4]), Err(Error::ShapeMismatch { got: 4, expected: 12, .. })));
}

#[test]
fn a_blit_lands_where_it_should_and_is_clipped() {
    let mut picture = Picture::filled(6, 5, WHITE);
    picture.blit(&Picture::filled(2, 3, RED), 1, 1);
    assert_eq!(count(&picture, RED), 6);
    assert_eq!([picture.pixel(1, 1), picture.pixel(2, 3), picture.pixel(3, 3)], [Some(RED), Some(RED), Some(WHITE)]);
    picture.blit(&Picture::filled(9, 9, INK), 4, 3);
    assert_eq!(count(&picture, INK), 4);
    picture.blit(&Picture::filled(9, 9, INK), 60, 60);
    picture.blit(&Picture::filled(9, 9, INK), u32::MAX, 0);
    assert_eq!(count(&picture, INK), 4);
}

#[test]
fn a_frame_lies_just_around_its_box() {
    let mut picture = Picture::filled(8, 7, WHITE);
    let area = Area { left: 2, top: 2, width: 3, height: 2 };
    picture.frame(area, RED);
    assert_eq!(count(&picture, RED), 2 * 5 + 2 * 2);
    picture.fill(area, INK);
    assert_eq!(count(&picture, INK), 6);
    assert_eq!(count(&picture, RED), 14);
    assert_eq!([picture.pixel(1, 1), picture.pixel(5, 4)], [Some(RED); 2]);
}

#[test]
fn text_is_drawn_within_its_box_and_nowhere_else() {
    for (font, scale) in [(Font::Small, 1), (Font::Small, 3), (Font::Large, 2)] {
        let style = TextStyle { font, scale, colour: RED };
        let (width, height) = (style.width_of("Vg"), style.height());
        let mut picture = Picture::filled(width + 10, height + 10, WHITE);
        picture.text("Vg", 5, 5, style);
        let drawn = count(&picture, RED);
        assert!(drawn > 20 * (scale * scale) as usize);
        picture.fill(Area { left: 5, top: 5, width, height }, WHITE);
        assert_eq!(count(&picture, RED), 0);
    }
}

#[test]
fn a_scaled_letter_has_its_dots_in_squares() {
    let draw = |scale| {
        let mut picture = Picture::filled(8 * scale, 16 * scale, WHITE);
        picture.text("R", 0, 0, TextStyle { scale, ..TextStyle::default() });
        picture
    };
    let (small, large) = (draw(1), draw(3));
    assert!((0..24).all(|x| (0..48).all(|y| large.pixel(x, y) == small.pixel(x / 3, y / 3))));
}

#[test]
fn text_that_does_not_fit_is_clipped() {
    let mut picture = Picture::filled(10, 10, WHITE);
    picture.text("a long line", 3, 3, TextStyle::default());
    picture.text("outside", u32::MAX, u32::MAX - 3, TextStyle::default());
    assert!(count(&picture, INK) > 0);
}
