use outsight::visibility::agreement::{Causes, Contacts, Limits};

use super::*;

/// A pair that breaks one of its limits, or none, or has none.
fn pair(pass: Option<bool>) -> PairReport {
    let kappa_limit = pass.map(|kept| if kept { 0.9 } else { 0.999 });
    PairReport {
        a: "coverage@raster".to_owned(),
        b: "coverage@embree".to_owned(),
        agreement: Some(0.99),
        agreement_weighted: Some(0.999),
        kappa: Some(0.98),
        n11: Some(1000),
        n10: Some(3),
        n01: Some(2),
        n00: Some(4000),
        mean_abs_dv: 1e-4,
        bias: -1e-5,
        p99: 2e-3,
        dvm: 1e-5,
        pass,
        differing: Some(5.0 / 1005.0),
        visibility: [0.5, 0.5],
        limits: Limits { kappa: kappa_limit, ..Limits::default() },
        causes: Some(Causes { sliver: 4, sub_pixel: 1, ..Causes::default() }),
        contacts: Contacts::default(),
        worst: Vec::new(),
        pictures: Vec::new(),
    }
}

#[test]
fn one_broken_limit_makes_the_answer_no() {
    assert!(verdict(&[pair(Some(true)), pair(None)]).is_ok());
    assert!(matches!(verdict(&[pair(Some(true)), pair(Some(false))]), Err(Failure::ConditionFalse)));
}

#[test]
fn a_broken_limit_stands_beside_its_statistic() {
    let text = pair_text(&pair(Some(false)));
    assert!(text.starts_with("coverage@raster and coverage@embree: DISAGREE\n"), "{text}");
    let kappa = text.lines().find(|line| line.starts_with("kappa")).unwrap_or_default();
    assert!(kappa.contains("0.98") && kappa.contains("≥ 0.999") && kappa.ends_with("NO"), "{kappa}");
    assert!(text.contains("causes: sliver 4, sub-pixel 1\n"), "{text}");
    assert!(pair_text(&pair(None)).contains("no limits are known"));
}
