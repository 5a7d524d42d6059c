//! The rows that one profile or a few ask of all kinds alike.

use super::profile::Profile;
use crate::hard_cases::voxel_faces;

/// The truth of the bounds that a profile claims.
#[derive(Clone, Debug)]
pub(super) enum Setting {
    /// The bounds hold.
    Lawful,
    /// σ_t exceeds the majorant.
    Above,
    /// σ_t is negative somewhere, and the bounds in cells know it.
    Below,
    /// A value that is none.
    Broken,
}

/// A profile with its name.
type Named = (String, Profile, Setting);

/// One row.
#[derive(Clone)]
pub(super) struct Row {
    pub(super) number: u32,
    /// The difficulty, in words.
    pub(super) what: &'static str,
    /// The exact answer.
    pub(super) exact: &'static str,
    /// The profiles.
    pub(super) settings: Vec<Named>,
    /// The greatest N on each.
    pub(super) samples: u64,
}

/// N where a bias of some hundredths is to be seen, and where any answer but the right one is far off.
const FEW: u64 = 2_000;
const SOME: u64 = 20_000;

/// A profile for each of these numbers.
fn each<const N: usize>(numbers: [f64; N], profile: impl Fn(f64) -> Named) -> Vec<Named> {
    numbers.map(profile).to_vec()
}

/// The rows that are made kind by kind, by number.
pub(super) fn rows() -> Vec<Row> {
    let lawful = |name: String, profile| (name, profile, Setting::Lawful);
    let thickness = |tau: f64| {
        // Dense profiles in a majorant that is tight, so that look-ups are few.
        let majorant = if tau > 10.0 { tau } else { 1.25 * tau };
        lawful(format!("optical thickness {tau:e}"), Profile::constant(tau, 1.0, (0.0, majorant)))
    };
    let faults = [("NaN", f64::NAN), ("inf", f64::INFINITY), ("-inf", f64::NEG_INFINITY)];
    let mut broken: Vec<Named> = faults
        .into_iter()
        .map(|(name, value)| (name.to_owned(), Profile::faulty(value), Setting::Broken))
        .collect();
    broken.push(("1.5 above its majorant 1".to_owned(), Profile::faulty(1.5), Setting::Above));
    vec![
        Row {
            number: 1,
            what: "sigma_t = 0 on a ray of length 1e300, all rates 0",
            exact: "1 (nothing attenuates)",
            settings: vec![lawful("1e300".to_owned(), Profile::constant(0.0, 1e300, (0.0, 0.0)))],
            samples: FEW,
        },
        Row {
            number: 2,
            what: "nothing on the ray, majorants of optical thickness 88, 745 and 2000",
            exact: "1 (nothing attenuates)",
            settings: each([88.0, 745.0, 2000.0], |depth| {
                lawful(format!("majorant {depth}"), Profile::constant(0.0, 2.0, (0.0, 0.5 * depth)))
            }),
            samples: FEW,
        },
        Row {
            number: 3,
            what: "a majorant of 0.5 below sigma_t 1, length 2",
            exact: "0.1353 = exp(-2), or a refusal",
            settings: vec![("0.5".to_owned(), Profile::constant(1.0, 2.0, (0.0, 0.5)), Setting::Above)],
            samples: SOME,
        },
        Row {
            number: 4,
            what: "extinction 1 then -0.5, length 1 each",
            exact: "0.6065 = exp(-0.5), or a refusal",
            settings: vec![(
                "both signs".to_owned(),
                Profile::steps(&[0.0, 1.0, 2.0], &[1.0, -0.5]),
                Setting::Below,
            )],
            samples: SOME,
        },
        Row {
            number: 5,
            what: "extinction -0.5, length 2, a majorant of 1",
            exact: "2.718 = exp(1), or a refusal",
            settings: vec![("-0.5".to_owned(), Profile::constant(-0.5, 2.0, (-1.0, 1.0)), Setting::Below)],
            samples: SOME,
        },
        Row {
            number: 7,
            what: "a null probability of 1e-8 or a rounding, or 0",
            exact: "exp(-1)",
            settings: each([0.0, 1e-8, f64::EPSILON], |delta| {
                lawful(format!("{delta:e}"), Profile::constant(1.0, 1.0, (0.0, 1.0 + delta)))
            }),
            samples: FEW,
        },
        Row {
            number: 8,
            what: "optical thicknesses from 1e-12 to 1e6",
            exact: "exp(-tau)",
            settings: each([1e-12, 1e-3, 1.0, 50.0, 700.0, 800.0, 1e6], thickness),
            samples: FEW,
        },
        Row {
            number: 9,
            what: "sigma_t = 1e6 on 1e-6 of the ray",
            exact: "exp(-1)",
            settings: vec![lawful(
                "a spike".to_owned(),
                Profile::steps(&[0.0, 0.5, 0.500_001, 1.0], &[0.0, 1e6, 0.0]),
            )],
            samples: FEW,
        },
        Row {
            number: 10,
            what: "rays through faces, edges and corners of voxels",
            exact: "exp(-length * value in the middle): the values are affine",
            settings: voxel_faces::profiles()
                .into_iter()
                .map(|(name, profile)| lawful(name, profile))
                .collect(),
            samples: FEW,
        },
        Row {
            number: 11,
            what: "a feature of 1e-3 at 1e6",
            exact: "exp(-1000 (edge difference))",
            settings: vec![lawful(
                "far".to_owned(),
                Profile::steps(&[0.0, 1e6, 1e6 + 1e-3, 1e6 + 1.0], &[0.0, 1e3, 0.0]),
            )],
            samples: FEW,
        },
        Row {
            number: 12,
            what: "segments of length 0, 4, 16 and 20",
            exact: "exp(-0.5 * length)",
            settings: each([0.0, 4.0, 16.0, 20.0], |length| {
                lawful(format!("length {length}"), Profile::constant(0.5, length, (0.0, 0.6)))
            }),
            samples: FEW,
        },
        Row {
            number: 15,
            what: "a medium that returns NaN, inf, or more than its majorant",
            exact: "an error with the point",
            settings: broken,
            samples: SOME,
        },
        Row {
            number: 20,
            what: "1e6 collisions of weights next to 1 in one walk",
            exact: "exp(-500)",
            settings: vec![lawful("500 in 1e6".to_owned(), Profile::constant(500.0, 1.0, (0.0, 1e6)))],
            samples: FEW,
        },
        Row {
            number: 21,
            what: "heavy tails: a majorant of 1/J below sigma_t 1, J = 5, 20 and 100",
            exact: "exp(-1), or \"not testable at this N\"",
            settings: each([5.0, 20.0, 100.0], |j| {
                (format!("J = {j}"), Profile::constant(1.0, 1.0, (0.0, 1.0 / j)), Setting::Above)
            }),
            samples: SOME,
        },
    ]
}
