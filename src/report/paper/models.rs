use super::{EqualError, PaperModel, PaperPicture, Table1Row, Table2Row};

/// Every model of the tables, in the order of table 1; the locomotive is in table 2 only.
pub const MODELS: [PaperModel; 10] = [
    PaperModel { table1: first(0.958, [6, 7]), ..plain("Bunny", 69_451) },
    PaperModel { table1: first(0.890, [4, 58]), figures: &[2], ..plain("Teapot", 28_744) },
    PaperModel {
        table1: first(0.804, [24, 38]),
        table2: second(0.804, [24, 38], [2, 31], 2.44),
        figures: &[2, 4],
        ..plain("Dragon", 871_414)
    },
    PaperModel {
        table1: first(0.764, [30, 14]),
        table2: second(0.764, [30, 14], [3, 6], 2.12),
        figures: &[2, 3, 4, 8],
        pictures: &[PaperPicture { figure: 8, triangles: 20_000 }],
        notes: &["the count is 1,087,416; the file in circulation has 1,087,716"],
        ..plain("Buddha", 1_087_416)
    },
    PaperModel { table1: first(0.728, [4, 35]), figures: &[2], ..plain("Locking Tori", 9_708) },
    PaperModel { table1: first(0.724, [4, 33]), figures: &[2], ..plain("Foot Bone", 8_790) },
    PaperModel {
        table1: first(0.466, [58, 19]),
        table2: second(0.446, [58, 19], [6, 36], 10.22),
        figures: &[4, 6],
        pictures: &[PaperPicture { figure: 6, triangles: 15_000 }],
        notes: &["V(M) is 0.466 in table 1 and 0.446 in table 2"],
        ..plain("Blade", 1_688_933)
    },
    PaperModel {
        table1: first(0.444, [37, 44]),
        table2: second(0.444, [37, 44], [4, 18], 11.51),
        figures: &[4, 7],
        pictures: &[PaperPicture { figure: 7, triangles: 10_000 }],
        notes: &[
            "figure 7 has 10,000 triangles; the authors' slides say 15,000",
            "the skull of figure 7 was smoothed first (Taubin)",
        ],
        ..plain("Skull", 1_169_608)
    },
    PaperModel {
        table1: first(0.264, [10, 56]),
        table2: second(0.264, [10, 56], [0, 24], 51.77),
        figures: &[3, 4, 5],
        pictures: &[PaperPicture { figure: 5, triangles: 15_000 }],
        equal_error: Some(EqualError { visibility: 12_000, quadric: 27_000 }),
        notes: &[
            "51.77 % is the mean of seven levels in table 2 and the improvement at 15,000 triangles in the text",
            "figure 5 has 15,000 triangles; the authors' slides say 10,000",
        ],
        ..plain("Motor", 140_113)
    },
    PaperModel { table2: second(0.538, [11, 14], [0, 32], 7.41), figures: &[4], ..plain("Locomotive", 183_450) },
];

/// A model with nothing printed about it but its size.
const fn plain(name: &'static str, triangles: usize) -> PaperModel {
    PaperModel {
        name,
        triangles,
        table1: None,
        table2: None,
        figures: &[],
        pictures: &[],
        equal_error: None,
        notes: &[],
    }
}

/// A row of table 1; the time in minutes and seconds, as printed.
const fn first(visibility: f64, time: [u32; 2]) -> Option<Table1Row> {
    Some(Table1Row { visibility, measure_seconds: seconds(time) })
}

/// A row of table 2; times in minutes and seconds, as printed.
const fn second(visibility: f64, measure: [u32; 2], simplify: [u32; 2], less_error: f64) -> Option<Table2Row> {
    Some(Table2Row { visibility, measure_seconds: seconds(measure), simplify_seconds: seconds(simplify), less_error })
}

const fn seconds([minutes, seconds]: [u32; 2]) -> u32 {
    60 * minutes + seconds
}
