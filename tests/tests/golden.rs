//! The first estimates of each estimator from a fixed seed. They change only if an algorithm or the generator does, and
//! then every report does.

use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_media::{Constant, PiecewiseLinear, Vacuum};
use fairflight_sources::Seeded;
use fairflight_transmittance::{
    Explorers, LineIntegral, Offset, RayMarching, Tracking, TransmittanceEstimator, Woodcock,
};

fn field() -> PiecewiseLinear {
    PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.25, 1.0, 0.5]).unwrap()
}

fn first<E: TransmittanceEstimator<PiecewiseLinear>>(estimator: &E) -> [f64; 6] {
    let (field, mut source) = (field(), Seeded::new(7));
    std::array::from_fn(|_| estimator.estimate(&field, &mut source))
}

fn sampling(sigma: f64) -> Constant {
    Constant::new(sigma, 3.0).unwrap()
}

fn single(version: Version, albedo: f64, sigma_samp: f64) -> [f64; 6] {
    let model = SingleParticle { version, albedo: Albedo::new(albedo).unwrap() };
    first(&Tracking::new(model, Vacuum::new(3.0), sampling(sigma_samp)))
}

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// Bit for bit: the decimals are the shortest that name the number.
#[test]
fn the_first_estimates_are_fixed() {
    let explorers = Explorers::through(&field(), 3).unwrap();
    let found = [
        ("woodcock", first(&Woodcock)),
        ("ratio tracking", first(&Tracking::new(double_particle(), Vacuum::new(3.0), sampling(1.0)))),
        ("below the extinction", first(&Tracking::new(double_particle(), Vacuum::new(3.0), sampling(0.6)))),
        ("residual", first(&Tracking::new(double_particle(), sampling(0.6), sampling(1.0)))),
        ("explorers", first(&Tracking::new(double_particle(), explorers, sampling(1.0)))),
        ("terminating", single(Version::Terminating, 0.5, 1.25)),
        ("non-terminating", single(Version::NonTerminating, 0.5, 1.5)),
        ("adaptive", single(Version::Adaptive, 0.5, 0.8)),
        ("line integral", first(&LineIntegral::new(4).unwrap())),
        ("ray marching", first(&RayMarching::new(3, Offset::Jittered).unwrap())),
    ];
    for ((name, found), expected) in found.into_iter().zip(GOLDEN) {
        println!("    {found:?}, // {name}");
        assert_eq!(found, expected, "{name}");
    }
}

/// Golden values, in the order of the test.
const GOLDEN: [[f64; 6]; 10] = [
    [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], // woodcock
    [
        0.013616348601800205,
        0.021006547433693824,
        0.0002411449072368313,
        0.05905359897059942,
        0.04761262159085584,
        0.0004726160662963199,
    ], // ratio tracking
    [
        -0.001144331036074006,
        1.0,
        -0.6480522884263786,
        -0.2504957040126714,
        -0.0016798824514770666,
        -0.007160644885253652,
    ], // below the extinction
    [
        0.1588565446669445,
        0.11188187878414697,
        0.19332819914700455,
        0.12497168817674284,
        0.11455366112868344,
        0.20883201494663273,
    ], // residual
    [
        0.1381156321679182,
        0.12131376194416117,
        0.12165751757975503,
        0.15335496684492847,
        0.15335496684492847,
        0.07816733313750998,
    ], // explorers
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], // terminating
    [0.6318021050157497, 0.0, 0.0, 0.0, 0.0, 0.0], // non-terminating
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], // adaptive
    [
        0.049787068367863944,
        0.049787068367863944,
        0.049787068367863944,
        0.28734030127589794,
        0.049787068367863944,
        0.049787068367863944,
    ], // line integral
    [
        0.1334751302017631,
        0.12963545452491335,
        0.11311005093900754,
        0.12162625075573842,
        0.10636115211233235,
        0.1204613984380678,
    ], // ray marching
];
