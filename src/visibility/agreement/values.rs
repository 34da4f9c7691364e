use serde::Serialize;

use crate::visibility::agreement::Compared;
use crate::visibility::agreement::table::Pairs;

/// How far V of two measurements differs over a surface; differences are A − B.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueDifference {
    /// Area-weighted mean of |V_A − V_B|.
    pub mean_abs: f64,
    /// Area-weighted mean of V_A − V_B.
    pub bias: f64,
    /// The smallest d such that triangles with |V_A − V_B| ≤ d hold 99 % of the area.
    pub p99: f64,
    /// |V_A(M) − V_B(M)|, one-sided, contacts included.
    pub of_mesh: f64,
    /// The triangles that add most to the mean, at most 20, the worst first. By |V_A − V_B| alone the list would show the
    /// smallest triangles, where one pixel is worth more than their whole area.
    pub worst: Vec<WorstTriangle>,
    /// V_A − V_B of every triangle.
    pub per_triangle: Vec<f64>,
}

/// A triangle on which two measurements differ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WorstTriangle {
    /// Its number.
    pub triangle: usize,
    /// V that A found on the compared sides, contacts included.
    pub a: f64,
    /// V that B found there.
    pub b: f64,
    /// Its share of the mesh's area.
    pub area_share: f64,
}

/// Length of the list of worst triangles.
const WORST: usize = 20;

/// Share of the area that the percentile holds.
const PERCENTILE: f64 = 0.99;

impl Pairs<'_> {
    pub fn value_difference(&self) -> ValueDifference {
        let per_triangle: Vec<f64> = (0..self.compared.len()).map(|t| self.difference(t)).collect();
        ValueDifference {
            mean_abs: self.shapes.area_mean(|t| per_triangle[t].abs()),
            bias: self.shapes.area_mean(|t| per_triangle[t]),
            p99: percentile(&per_triangle, &self.shapes.areas, PERCENTILE),
            of_mesh: (self.a.visibility.of_mesh() - self.b.visibility.of_mesh()).abs(),
            worst: worst(&per_triangle, &self.shapes.areas).map(|t| self.worst_triangle(t)).collect(),
            per_triangle,
        }
    }

    fn difference(&self, t: usize) -> f64 {
        if self.shapes.areas[t] == 0.0 {
            return 0.0;
        }
        let tied = self.differing.tied(t, self.shapes, self.comparing.cameras);
        on(self.compared[t], self.a.visibility.front()[t], self.a.visibility.back()[t])
            - on(self.compared[t], self.b.visibility.front()[t], self.b.visibility.back()[t])
            - on(self.compared[t], tied[0], tied[1])
    }

    fn worst_triangle(&self, t: usize) -> WorstTriangle {
        let [a, b] = [self.a, self.b].map(|m| on(self.compared[t], m.visibility.front()[t], m.visibility.back()[t]));
        let area: f64 = self.shapes.areas.iter().sum();
        WorstTriangle { triangle: t, a, b, area_share: self.shapes.areas[t] / area }
    }
}

/// The sum over the compared sides.
fn on(compared: Compared, front: f64, back: f64) -> f64 {
    let side = |counts: bool, value: f64| if counts { value } else { 0.0 };
    side(compared.front, front) + side(compared.back, back)
}

/// The smallest d such that triangles with |difference| ≤ d hold `share` of the area.
pub(super) fn percentile(differences: &[f64], areas: &[f64], share: f64) -> f64 {
    let mut order: Vec<usize> = (0..differences.len()).collect();
    order.sort_by(|&i, &j| differences[i].abs().total_cmp(&differences[j].abs()));
    let enough = share * order.iter().map(|&t| areas[t]).sum::<f64>();
    let mut held = 0.0;
    let reached = order.iter().find(|&&t| {
        held += areas[t];
        held >= enough
    });
    reached.or(order.last()).map_or(0.0, |&t| differences[t].abs())
}

/// The triangles with the largest area · |difference|, the largest first, equal ones by number.
pub(super) fn worst(differences: &[f64], areas: &[f64]) -> impl Iterator<Item = usize> {
    let share = |t: usize| areas[t] * differences[t].abs();
    let mut order: Vec<usize> = (0..differences.len()).filter(|&t| share(t) > 0.0).collect();
    order.sort_by(|&i, &j| share(j).total_cmp(&share(i)));
    order.into_iter().take(WORST)
}
