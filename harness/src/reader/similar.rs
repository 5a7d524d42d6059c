//! The name that was meant, where another one stands.

/// Names from papers and other programs, and what they are here.
const KNOWN_ELSEWHERE: [(&str, &str); 14] = [
    ("ratio_tracking", "double_particle without control"),
    ("residual_ratio_tracking", "double_particle with a control"),
    ("residual_tracking", "double_particle with a control"),
    ("delta_tracking", "woodcock"),
    ("track_length", "woodcock"),
    ("null_collision", "woodcock"),
    ("closed_form", "regular"),
    ("regular_tracking", "regular"),
    ("uniform", "homogeneous"),
    ("lambert", "diffuse"),
    ("glass", "dielectric"),
    ("volpath", "path_tracer"),
    ("path", "path_tracer"),
    ("majorant_sigma_t", "majorant"),
];

/// " (did you mean …?)" where one of `names` is as good as the word, or another name of it is known; else nothing.
#[must_use]
pub fn meant<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let known = KNOWN_ELSEWHERE
        .iter()
        .find(|(name, here)| *name == word && names.iter().any(|name| here.split(' ').next() == Some(name)));
    known
        .map(|&(_, here)| here)
        .or_else(|| nearest(word, names.iter().copied()))
        .map_or_else(String::new, |name| format!(" (did you mean {name}?)"))
}

/// One of `names` that may be the word with a slip of the keyboard.
pub(super) fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Likeness from which on a word is taken for another: that of one slip in a short word, two in a long one.
    const ALIKE: f64 = 0.75;
    let likeness = |name: &str| strsim::normalized_damerau_levenshtein(word, name);
    let best = names.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) >= ALIKE).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_meant() {
        let keys = ["kind", "sigma_samp", "control"];
        assert_eq!(meant("sigma_sampl", keys.into_iter()), " (did you mean sigma_samp?)");
        assert_eq!(meant("contorl", keys.into_iter()), " (did you mean control?)");
        assert_eq!(meant("teeth", keys.into_iter()), "");
        let kinds = ["woodcock", "double_particle"];
        assert_eq!(
            meant("ratio_tracking", kinds.into_iter()),
            " (did you mean double_particle without control?)"
        );
        // What is known elsewhere is told only where it may stand.
        assert_eq!(meant("ratio_tracking", ["sphere"].into_iter()), "");
    }
}
