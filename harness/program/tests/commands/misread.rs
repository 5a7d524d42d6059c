//! Files that are not what a command takes, named as what they are.

use crate::common::{fixture, harness};

#[test]
fn what_is_no_experiment_is_named_as_what_it_is() {
    let scene = include_str!("../../../scenes/eq21-environment.json");
    let experiment = r#"{ "profile": {}, "estimator": {}, "samples": 1, "seed": 1 }"#;
    let volume = fixture("cloud.vdb");
    let twice = r#"{ "samples": 1, "samples": 2 }"#;
    for (arguments, input, words) in [
        (vec!["estimate", "-"], scene, "this is a scene, no experiment: `harness render` takes it"),
        (
            vec!["render", "-", "--out", "x.png"],
            experiment,
            "this is an experiment, no scene: `harness estimate`",
        ),
        (vec!["estimate", &volume], "", "an OpenVDB file, not JSON"),
        (vec!["estimate", "-"], twice, "the key `samples` stands twice"),
        (vec!["estimate", "-"], "{} trailing", "more text after the end of the JSON"),
        (vec!["estimate", "-"], " ", "it is empty"),
        (
            vec!["estimate", "-"],
            r#"{ "profil": {}, "estimator": {}, "samples": 1, "seed": 1 }"#,
            "profile: this key is missing, but there is profil (did you mean profile?)",
        ),
        (
            vec!["estimate", "-"],
            r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1 }, "samples": 1, "seed": 1,
                 "estimator": { "kind": "double_particle", "sigma_sampl": 1 } }"#,
            "estimator.sigma_samp: this key is missing, but there is sigma_sampl (did you mean sigma_samp?)",
        ),
        (
            vec!["estimate", "-"],
            r#"{ "kind": "homogeneous" }"#,
            "this is a part such as a medium, no experiment",
        ),
        (vec!["render", "-", "--out", "x.png"], r#"{ "provenance": {} }"#, "this is a result, no scene"),
        (vec!["advise", "-"], experiment, "this is an experiment, no medium: `harness estimate` takes it"),
    ] {
        let outcome = harness(&arguments, input);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(outcome.stderr.contains(words), "{}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    }
}
