use serde::Serialize;

use super::PaperModel;
use crate::report::table::thousands;

/// What a model is to the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "stand", content = "paper")]
pub enum Stand {
    /// The paper's own, as far as its name and its number of triangles tell.
    Original(&'static PaperModel),
    /// Another model in the place of one of the paper's.
    StandIn(&'static PaperModel),
    /// The paper has nothing like it.
    None,
}

/// Largest difference between the numbers of triangles of the same model, as a share of the paper's: the Buddha in
/// circulation has 0.03 % more triangles than the paper prints.
const SAME_COUNT: f64 = 1e-3;

/// What a count cannot say.
const FILE: &str = "taken for the paper's own, of which no more is printed";

impl Stand {
    /// What a model of `triangles` triangles is that goes by the name of `model`.
    #[must_use]
    pub fn of(model: Option<&'static PaperModel>, triangles: usize) -> Self {
        let Some(model) = model else { return Self::None };
        let difference = triangles.abs_diff(model.triangles) as f64;
        if difference <= SAME_COUNT * model.triangles as f64 { Self::Original(model) } else { Self::StandIn(model) }
    }

    /// The paper's model that it is or stands for.
    #[must_use]
    pub fn model(self) -> Option<&'static PaperModel> {
        match self {
            Self::Original(model) | Self::StandIn(model) => Some(model),
            Self::None => None,
        }
    }

    /// One sentence on what the paper's numbers beside this model's are worth; `triangles` is how many it has.
    #[must_use]
    pub fn sentence(self, triangles: usize) -> String {
        let ours = thousands(triangles as u64);
        match self {
            Self::Original(model) if triangles == model.triangles => {
                format!("has the name and the count of the paper's {}: {ours} triangles; {FILE}", model.name)
            }
            Self::Original(model) => {
                let printed = thousands(model.triangles as u64);
                format!(
                    "has the name and nearly the count of the paper's {}: {ours} triangles, {printed} printed; {FILE}",
                    model.name
                )
            }
            Self::StandIn(model) => {
                let printed = thousands(model.triangles as u64);
                let meaning = "another model, so only the tendency compares";
                let counts = if triangles == model.triangles {
                    format!("{ours} triangles, as many as printed")
                } else {
                    format!("{ours} triangles in place of {printed}")
                };
                format!("stand-in for {}: {counts}; {meaning}", model.name)
            }
            Self::None => "no model of the paper".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn of(name: &str, triangles: usize) -> Stand {
        Stand::of(PaperModel::named(name), triangles)
    }

    #[test]
    fn name_and_count_make_an_original() {
        assert_eq!(of("bunny", 69_451), Stand::Original(PaperModel::named("bunny").unwrap()));
        // The Buddha that everybody has, 300 triangles more than printed.
        assert!(matches!(of("buddha", 1_087_716), Stand::Original(_)));
        assert!(matches!(of("motor", 140_253), Stand::Original(_)), "0.0999 % more");
    }

    #[test]
    fn another_count_makes_a_stand_in_and_another_name_nothing() {
        assert!(matches!(of("motor", 140_254), Stand::StandIn(_)), "0.1006 % more");
        assert!(matches!(of("motor", 139_972), Stand::StandIn(_)), "0.1006 % less");
        assert_eq!(of("cow", 69_451), Stand::None);
    }

    #[test]
    fn the_sentence_names_both_counts() {
        let sentence = of("motor", 110_336).sentence(110_336);
        let expected = "stand-in for Motor: 110,336 triangles in place of 140,113; another model, so only the tendency \
                        compares";
        assert_eq!(sentence, expected);
        let stand_in = Stand::StandIn(PaperModel::named("bunny").unwrap());
        assert!(stand_in.sentence(69_451).starts_with("stand-in for Bunny: 69,451 triangles, as many as printed;"));
        assert!(of("buddha", 1_087_716).sentence(1_087_716).contains("1,087,716 triangles, 1,087,416 printed"));
        assert!(
            of("bunny", 69_451)
                .sentence(69_451)
                .contains("the name and the count of the paper's Bunny: 69,451 triangles")
        );
    }
}
