#![allow(clippy::unwrap_used)]

use glam::DVec3;

use super::*;
use crate::io::Glb;
use crate::mesh::TriMesh;

/// What a name would need to run as a script, wherever it stands.
const HOSTILE: &str = "</script><img src=x onerror=alert(1)>\"' &amp; .ply";

fn packed() -> PackedModel {
    let triangle = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]).unwrap();
    PackedModel::of(&Glb::of(&triangle, Some(&[[1, 2, 3]])).unwrap()).unwrap()
}

/// A page with one section of each kind, `name` wherever text may stand.
fn page(name: &str) -> Page {
    let text = || name.to_owned();
    let section = |content| Section { heading: text(), text: text(), content, within: false };
    let images = [Image::Png(vec![1, 2, 3]), Image::Svg("<svg>".to_owned())];
    let figures = images.map(|image| Figure { image, caption: text() }).to_vec();
    let legend = Legend { title: text(), map: ColourMap::Cividis, low: text(), high: text() };
    let models = vec![Model { name: text(), caption: text(), model: packed() }; 2];
    let viewer = Viewer { models, legend: Some(legend.clone()), toward: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0] };
    let sections = vec![
        section(Content::Summary(vec![Fact { name: text(), value: text(), note: text() }])),
        section(Content::Table(Table {
            heads: vec![text(), text()],
            rows: vec![vec![text(), text()]],
            best: vec![[0, 1]],
        })),
        section(Content::Figures(Figures { columns: 2, figures, legend: Some(legend) })),
        section(Content::Viewer(viewer)),
        section(Content::Notes(vec![text()])),
        section(Content::Commands(vec![text()])),
    ];
    Page { title: text(), subtitle: text(), sections }
}

#[test]
fn names_are_escaped_wherever_they_stand() {
    let html = page(HOSTILE).to_html().unwrap();
    let escaped = "&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;' &amp;amp; .ply";
    assert!(!html.contains("<img src=x") && !html.contains(HOSTILE));
    // Twice in the head of the page, twice in each of six sections, and in what they show.
    assert_eq!(html.matches(escaped).count(), 2 + 1 + 2 * 6 + 3 + 4 + (4 + 3) + 2 * 5 + 3 + 1 + 1);
}

#[test]
fn the_names_of_rows_may_be_broken_between_their_words() {
    let html = page("two_words<.ply").to_html().unwrap();
    assert!(html.contains("<th scope=\"row\">two_<wbr>words&lt;.ply</th>"));
}

#[test]
fn nothing_may_be_loaded_and_no_script_but_its_own_may_run() {
    let html = page("part.ply").to_html().unwrap();
    let policy = html.split("Content-Security-Policy\" content=\"").nth(1).unwrap().split('"').next().unwrap();
    assert!(policy.starts_with("default-src 'none'; img-src data:;"), "{policy}");
    assert_eq!(policy.matches("'sha256-").count(), 2);
    assert!(!policy.contains("script-src 'unsafe") && !policy.contains("http"), "{policy}");
    let addresses = html.split(" src=\"").skip(1).map(|rest| rest.split(':').next().unwrap());
    assert!(addresses.eq(["data"; 2]));
}

#[test]
fn a_page_without_models_does_not_carry_their_viewer() {
    let mut page = page("part.ply");
    page.sections.retain(|section| !matches!(section.content, Content::Viewer(_)));
    let html = page.to_html().unwrap();
    assert!(html.len() < 40_000, "{}", html.len());
    assert!(html.contains("data:image/svg+xml;base64,PHN2Zz4="));
}

#[test]
fn a_page_past_its_limit_is_refused() {
    let mut page = page("part.ply");
    let image = Image::Png(vec![0; 3 * MAX_BYTES / 4]);
    assert_eq!(image.embedded_bytes(), MAX_BYTES);
    let figures = Figures { columns: 1, figures: vec![Figure { image, caption: String::new() }], legend: None };
    page.sections.push(Section {
        heading: String::new(),
        text: String::new(),
        content: Content::Figures(figures),
        within: false,
    });
    let error = page.to_html().unwrap_err();
    assert_eq!((error.exit_code(), error.to_string().contains("fewer meshes")), (5, true), "{error}");
}

#[test]
fn the_vendored_viewer_brings_its_licence_and_ends_no_script() {
    let three = include_str!("vendor/three.js");
    assert!(three.contains("The MIT License") && three.contains("three.js authors"));
    for script in [three, include_str!("page.js")] {
        assert!(!script.to_lowercase().contains("</script") && !script.contains("<!--"));
    }
}

#[test]
fn a_page_of_parts_begins_with_links_to_what_they_are_parts_of() {
    let mut page = page("a & b");
    assert!(!page.to_html().unwrap().contains("<nav"));
    page.sections[1].within = true;
    let html = page.to_html().unwrap();
    let contents = html.split("<nav").nth(1).unwrap().split("</nav>").next().unwrap();
    let link = |number: usize| contents.contains(&format!("<a href=\"#section-{number}\">a &amp; b</a>"));
    assert_eq!([0, 1, 2].map(link), [true, false, true]);
    assert!(html.contains("<h3 id=\"section-1\">") && html.contains("<h2 id=\"section-2\">"));
}
