//! The markup of a page. `maud` escapes every value; only what stands in `PreEscaped` goes through as it is, and that is
//! this project's own style and scripts.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::DVec3;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

use super::{Content, Fact, Figure, Figures, Image, Legend, Page, Section, Table, Viewer};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
const THREE: &str = include_str!("vendor/three.js");

/// Colours of the legend's bar; between them the browser mixes.
const LEGEND_STEPS: u32 = 32;

/// Numbers below the legend's bar.
const LEGEND_TICKS: [&str; 5] = ["0", "0.25", "0.5", "0.75", "1"];

pub(super) fn document(page: &Page) -> Markup {
    let shows_models = page.sections.iter().any(|s| matches!(s.content, Content::Viewer(_)));
    let scripts = if shows_models { &[THREE, SCRIPT][..] } else { &[SCRIPT] };
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy(scripts));
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content="Outsight";
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    div {
                        h1 { (page.title) }
                        @if !page.subtitle.is_empty() { p { (page.subtitle) } }
                    }
                    (theme_switch())
                }
                @if page.sections.iter().any(|section| section.within) { (contents(&page.sections)) }
                main { @for (number, section) in page.sections.iter().enumerate() { (section_markup(number, section)) } }
                footer { p { "Made by Outsight " (env!("CARGO_PKG_VERSION")) ". This file is complete: it loads nothing." } }
                @for script in scripts { script { (PreEscaped(script)) } }
            }
        }
    }
}

/// Nothing from anywhere, no script but those whose hashes stand here.
fn policy(scripts: &[&str]) -> String {
    let hash = |script: &&str| format!(" 'sha256-{}'", BASE64_STANDARD.encode(Sha256::digest(script)));
    let hashes: String = scripts.iter().map(hash).collect();
    format!(
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src{hashes}; base-uri 'none'; form-action 'none'"
    )
}

fn theme_switch() -> Markup {
    html! {
        fieldset class="switch themes" {
            legend { "Colours of the page" }
            @for (value, label) in [("", "Auto"), ("light", "Light"), ("dark", "Dark")] {
                label { input type="radio" name="theme" value=(value) checked[value.is_empty()]; span { (label) } }
            }
        }
    }
}

/// Links to all sections but those that are parts of others.
fn contents(sections: &[Section]) -> Markup {
    html! {
        nav aria-label="Contents" {
            ul {
                @for (number, section) in sections.iter().enumerate().filter(|(_, section)| !section.within) {
                    li { a href={ "#section-" (number) } { (section.heading) } }
                }
            }
        }
    }
}

fn section_markup(number: usize, section: &Section) -> Markup {
    let id = format!("section-{number}");
    html! {
        section aria-labelledby=(id) {
            @if section.within { h3 id=(id) { (section.heading) } } @else { h2 id=(id) { (section.heading) } }
            @if !section.text.is_empty() { p class="lead" { (section.text) } }
            @match &section.content {
                Content::Summary(facts) => { (summary(facts)) }
                Content::Table(table) => { (table_markup(table)) }
                Content::Figures(figures) => { (figures_markup(figures)) }
                Content::Viewer(shown) => { (viewer(number, shown)) }
                Content::Notes(notes) => { ul { @for note in notes { li { (note) } } } }
                Content::Commands(lines) => { pre { @for line in lines { code { (line) } "\n" } } }
            }
        }
    }
}

fn summary(facts: &[Fact]) -> Markup {
    html! {
        dl class="facts" {
            @for fact in facts {
                div {
                    dt { (fact.name) }
                    dd { (fact.value) @if !fact.note.is_empty() { small { (fact.note) } } }
                }
            }
        }
    }
}

fn table_markup(table: &Table) -> Markup {
    html! {
        div class="scroll" tabindex="0" role="region" aria-label="Table" {
            table {
                thead { tr { @for head in &table.heads { th scope="col" { (head) } } } }
                tbody {
                    @for (number, row) in table.rows.iter().enumerate() {
                        tr {
                            @for (column, cell) in row.iter().enumerate() {
                                @if column == 0 { th scope="row" { (breakable(cell)) } }
                                @else if table.best.contains(&[number, column]) { td { strong { (cell) } } }
                                @else { td { (cell) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A name that may be broken into lines behind each `_`.
fn breakable(name: &str) -> Markup {
    html! { @for (number, part) in name.split_inclusive('_').enumerate() { @if number > 0 { wbr; } (part) } }
}

/// Pictures keep their columns, since they are read along them; phones show pairs, and across both what has no partner.
fn figures_markup(shown: &Figures) -> Markup {
    let plots = shown.figures.iter().all(|figure| matches!(figure.image, Image::Svg(_)));
    let alone = |number: usize| !shown.columns.is_multiple_of(2) && number.is_multiple_of(shown.columns);
    let across =
        |number: usize, figure: &Figure| (alone(number) || matches!(figure.image, Image::Svg(_))).then_some("across");
    html! {
        div class=(if plots { "figures plots" } else { "figures" }) style={ "--columns:" (shown.columns) } {
            @for (number, figure) in shown.figures.iter().enumerate() {
                figure class=[across(number, figure)] {
                    @match &figure.image {
                        Image::Png(bytes) => { img alt=(figure.caption) src=(data("image/png", bytes)); }
                        Image::Jpeg(bytes) => { img alt=(figure.caption) src=(data("image/jpeg", bytes)); }
                        Image::Svg(text) => {
                            img alt=(figure.caption) src=(data("image/svg+xml", text.as_bytes()));
                        }
                    }
                    figcaption { (figure.caption) }
                }
            }
        }
        @if let Some(legend) = &shown.legend { (legend_markup(legend)) }
    }
}

fn data(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", BASE64_STANDARD.encode(bytes))
}

/// Axes that can be up.
const AXES: [(&str, [f64; 3]); 3] = [("X", [1.0, 0.0, 0.0]), ("Y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0])];

/// A direction as the script reads it.
fn numbers([x, y, z]: [f64; 3]) -> String {
    format!("{x} {y} {z}")
}

/// The axes, and first the direction that was given where it is none of them.
fn up_switch(number: usize, given: [f64; 3]) -> Markup {
    let given = DVec3::from_array(given).normalize().to_array();
    let other = AXES.iter().all(|(_, axis)| *axis != given).then_some(("As given", given));
    html! {
        div class="named" {
            span aria-hidden="true" { "Up" }
            fieldset class="switch" {
                legend { "Up" }
                @for (name, up) in other.into_iter().chain(AXES) {
                    label {
                        input type="radio" name={ "up-" (number) } value=(numbers(up)) checked[up == given];
                        span { (name) }
                    }
                }
            }
        }
    }
}

fn viewer(number: usize, shown: &Viewer) -> Markup {
    html! {
        div class="viewer" data-up=(numbers(shown.up)) data-toward=(numbers(shown.toward)) {
            div class="tools" {
                @if shown.models.len() > 1 {
                    fieldset class="switch" {
                        legend { "Show" }
                        label { input type="radio" name={ "show-" (number) } value="" checked; span { "Side by side" } }
                        @for (index, model) in shown.models.iter().enumerate() {
                            label { input type="radio" name={ "show-" (number) } value=(index); span { (model.name) } }
                        }
                    }
                }
                (up_switch(number, shown.up))
                @if shown.legend.is_some() { label class="check" { input type="checkbox" name="heat" checked; "Visibility" } }
                label class="check" { input type="checkbox" name="edges"; "Edges" }
                button type="button" name="reset" { "Reset view" }
            }
            div class="panes" {
                @for model in &shown.models {
                    figure class="pane" {
                        canvas tabindex="0" role="img" aria-busy="true" aria-label={ "3-D view of " (model.name) ", " (model.caption) ". Arrow keys turn it." } {}
                        p class="trouble" hidden {}
                        figcaption { strong { (model.name) } " " span { (model.caption) } }
                        script type="application/octet-stream" { (PreEscaped(model.model.as_text())) }
                    }
                }
            }
            @if let Some(legend) = &shown.legend { (legend_markup(legend)) }
            p class="hint" {
                span class="mouse" {
                    "Drag to turn; right-drag moves. With a view in focus: " kbd { "←" } kbd { "↑" } kbd { "→" } kbd { "↓" } " turn, "
                    kbd { "+" } kbd { "−" } " or the wheel zoom, " kbd { "Home" } " resets."
                }
                span class="touch" { "One finger turns a view, two move and zoom it; beside the views the page scrolls." }
                @if shown.models.len() > 1 { " Views turn together." }
            }
            noscript { p class="trouble" { "The models need JavaScript; the pictures below do not." } }
        }
    }
}

fn legend_markup(legend: &Legend) -> Markup {
    let colour = |step: u32| {
        let [r, g, b] = legend.map.colour(f64::from(step) / f64::from(LEGEND_STEPS));
        format!(",rgb({r},{g},{b})")
    };
    let colours: String = (0..=LEGEND_STEPS).map(colour).collect();
    html! {
        div class="key" {
            p { strong { (legend.title) } }
            div class="bar" style={ "background:linear-gradient(to right" (colours) ")" } {}
            div class="ticks" aria-hidden="true" { @for tick in LEGEND_TICKS { span { (tick) } } }
            p class="ends" { span { "0: " (legend.low) } span { "1: " (legend.high) } }
        }
    }
}
