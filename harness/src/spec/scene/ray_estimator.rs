//! An estimator of transmittance for whatever ray a scene asks for.

use crate::Failure;
use crate::spec::{BeyondSpec, ControlSpec, EstimatorSpec, Node, SamplingSpec};

/// An estimator that is prepared for each ray anew.
#[derive(Clone, Debug, PartialEq)]
pub enum RayEstimatorSpec {
    /// The closed form of the optical thickness, where the medium has one.
    Regular,
    /// An estimator of an experiment whose parameters do not depend on the ray.
    Sampled(EstimatorSpec),
}

impl RayEstimatorSpec {
    /// Reads an estimator.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind, or a parameter is a function of the distance along one ray.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let spec = EstimatorSpec::read(node)?;
        if let EstimatorSpec::Beyond(beyond) = &spec {
            if *beyond == BeyondSpec::Regular {
                return Ok(Self::Regular);
            }
            if let Some(reason) = beyond.needs_one_ray() {
                return Err(object.required("kind")?.reject(reason));
            }
        }
        if let EstimatorSpec::DoubleParticle { sampling, control }
        | EstimatorSpec::SingleParticle { sampling, control, .. } = &spec
        {
            let for_one_ray = "is given along one ray, but a scene has many";
            let sigma_samp = object.required("sigma_samp")?;
            match sampling {
                SamplingSpec::PiecewiseConstant { .. } => {
                    return Err(sigma_samp.reject(format!("{for_one_ray}: a number is allowed")));
                }
                // Where nothing is sampled the control would have to be the medium itself, on every ray.
                SamplingSpec::Constant(0.0) => return Err(sigma_samp.refuse("must be a number above 0")),
                SamplingSpec::Constant(_) => {}
            }
            if matches!(control, ControlSpec::PiecewiseLinear { .. }) {
                let kind = object.required("control")?.object()?.required("kind")?;
                return Err(kind.reject(format!("{for_one_ray}: none, constant and explorers are allowed")));
            }
        }
        Ok(Self::Sampled(spec))
    }
}
