#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;

const SIZE: [u32; 2] = [80, 60];

fn image(level: f32) -> Vec<f32> {
    vec![level; 80 * 60]
}

fn column<'a>(heading: &str, images: Images<'a>) -> Column<'a> {
    Column { heading: heading.to_owned(), caption: mesh_caption(5517, Some(11.94)), images }
}

fn count(picture: &Picture, colour: [u8; 3]) -> usize {
    picture.as_rgb().chunks(3).filter(|p| *p == colour).count()
}

#[test]
fn every_image_is_on_the_sheet_whole() {
    let (reference, test) = (image(100.0), image(132.0));
    let sheet = ContactSheet {
        title: "engine".to_owned(),
        image_size: SIZE,
        columns: vec![
            column("reference", Images::Shaded(vec![&reference; 2])),
            column("test", Images::Shaded(vec![&test; 2])),
            column("difference", Images::Difference(vec![[&reference, &test]; 2])),
        ],
        row_captions: vec!["view 1".to_owned(), "view 2".to_owned()],
        ..ContactSheet::default()
    };
    let picture = sheet.draw().unwrap();
    assert_eq!(count(&picture, [100; 3]), 2 * 80 * 60);
    assert_eq!(count(&picture, [132; 3]), 2 * 80 * 60);
    // 32 of 64 levels is half way from white to red; the key shows that colour in at least one column.
    let half = mix(WHITE, RED, 0.5);
    assert!(count(&picture, half) >= 2 * 80 * 60);
}

#[test]
fn reds_grow_with_the_difference_in_either_direction() {
    let sheet = ContactSheet::default();
    assert_eq!(sheet.red(0.0), WHITE);
    assert_eq!(sheet.red(64.0), RED);
    assert_eq!(sheet.red(255.0), RED);
    let levels = [[10.0_f32, 30.0], [30.0, 10.0]].map(|[a, b]| {
        let (a, b) = (vec![a; 4], vec![b; 4]);
        let sheet = ContactSheet { image_size: [2, 2], ..ContactSheet::default() };
        sheet.image(&Images::Difference(vec![[&a, &b]]), 0).unwrap()
    });
    assert_eq!(levels[0], levels[1]);
    assert_eq!(levels[0].pixel(0, 0), Some(mix(WHITE, RED, 20.0 / 64.0)));
}

#[test]
fn the_background_is_white_or_black_as_asked() {
    let grey = [0.0, 0.3, 90.0, 0.0];
    let draw = |background| {
        let sheet = ContactSheet { image_size: [2, 2], background, ..ContactSheet::default() };
        let picture = sheet.image(&Images::Shaded(vec![&grey]), 0).unwrap();
        picture.as_rgb().iter().step_by(3).copied().collect::<Vec<_>>()
    };
    assert_eq!(draw(Background::White), [255, 0, 90, 255]);
    assert_eq!(draw(Background::Black), [0, 0, 90, 0]);
}

#[test]
fn the_margin_stays_white() {
    let (a, b) = (image(10.0), image(250.0));
    let long = "a long heading that cannot fit above so small an image";
    let sheet = ContactSheet {
        title: long.to_owned(),
        subtitle: long.repeat(3),
        image_size: SIZE,
        columns: vec![column(long, Images::Shaded(vec![&a])), column(long, Images::Difference(vec![[&a, &b]]))],
        ..ContactSheet::default()
    };
    let picture = sheet.draw().unwrap();
    let (width, height) = (picture.width(), picture.height());
    let is_margin = |x: u32, y: u32| x < 16 || y < 16 || x >= width - 16 || y >= height - 16;
    for y in 0..height {
        for x in (0..width).filter(|&x| is_margin(x, y)) {
            assert_eq!(picture.pixel(x, y), Some(WHITE), "({x}, {y}) of {width} x {height}");
        }
    }
}

#[test]
fn lines_break_between_words_and_long_words_are_cut() {
    let lines = broken_into_lines("one two three\nfour incomprehensibilities\ni\u{a0}am here", QUIET, 8 * 9);
    assert_eq!(lines, ["one two", "three", "four", "incompreh", "i\u{a0}am here"]);
    assert!(broken_into_lines("", QUIET, 80).is_empty());
}

#[test]
fn captions_have_thousands_separators_and_one_decimal() {
    assert_eq!(mesh_caption(110_338, None), "110,338 triangles");
    assert_eq!(mesh_caption(5517, Some(11.94)), "5,517 triangles · image\u{a0}RMSE\u{a0}11.9");
}

#[test]
fn wrong_shapes_and_scales_are_errors() {
    let (good, short) = (image(1.0), vec![1.0; 7]);
    let draw = |images: Vec<Images>, row_captions: Vec<String>, full_red| {
        let columns = images.into_iter().map(|i| column("x", i)).collect();
        ContactSheet { image_size: SIZE, columns, row_captions, full_red, ..ContactSheet::default() }.draw()
    };
    let one = || Images::Shaded(vec![&good]);
    assert!(draw(vec![one()], vec![], 1.0).is_ok());
    assert!(draw(vec![], vec![], 1.0).is_ok());
    for (images, captions) in [
        (vec![Images::Shaded(vec![&short])], vec![]),
        (vec![Images::Difference(vec![[&good, &short]])], vec![]),
        (vec![one(), Images::Shaded(vec![&good, &good])], vec![]),
        (vec![one()], vec!["a".to_owned(), "b".to_owned()]),
    ] {
        assert!(matches!(draw(images, captions, 1.0), Err(Error::ShapeMismatch { .. })));
    }
    for full_red in [0.0, -1.0, f32::NAN] {
        assert!(matches!(draw(vec![one()], vec![], full_red), Err(Error::Option { .. })));
    }
}
