//! A surrogate as one file: safetensors, with everything that is not a tensor as JSON in the
//! header.

use std::collections::HashMap;
use std::sync::Arc;

use safetensors::SafeTensors;
use safetensors::tensor::{Dtype, TensorView};
use serde::{Deserialize, Serialize};
use twintac_learn::{Linear, Matrix};

use crate::FastGel;
use crate::contact::N_CHANNELS;
use crate::layout::Layout;
use crate::network::{LocalNetwork, Perceptron};
use crate::networks::Networks;
use crate::out_of_distribution::{Coverage, N_TRAITS, Nearest, OodScore};
use crate::surface::SurfaceGrid;
use crate::trained_on::{Port, TrainedOn};

/// Name of the header's entry.
const ENTRY: &str = "twintac-fast";

/// Version of the file's layout.
const VERSION: u32 = 6;

/// Why bytes are not a readable surrogate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("this is not a readable surrogate of the gel: {0}")]
pub struct FastFileError(String);

impl FastFileError {
    fn new(problem: impl std::fmt::Display) -> Self {
        Self(problem.to_string())
    }
}

/// What the header of every version has.
#[derive(Deserialize)]
struct Version {
    version: u32,
}

/// Everything that is not a tensor. Names in the file are those of its version, also of tensors.
#[derive(Serialize, Deserialize)]
struct Header {
    version: u32,
    sensor: String,
    gel: TrainedOn,
    ports: Vec<Port>,
    /// Locations at which the surrogate is evaluated.
    ports_mm: Vec<glam::DVec2>,
    layout: Layout,
    center_mm: glam::DVec3,
    /// Distance to the nearest training contact that counts as an OOD score of 1.
    #[serde(rename = "novelty_unit")]
    ood_unit: f32,
    #[serde(rename = "error_of_one_lesson")]
    error_of_one_press: f32,
}

/// PhysTac's surrogate, made by `twintac fast train --sensor sensors/phystac.toml
/// --training-presses 2000 --test-presses 70 --slides 24`.
const PHYSTAC: &[u8] = include_bytes!("../built_in/phystac.safetensors");

/// The fingertip's surrogate, made by `twintac fast train --sensor sensors/phystac-tip.toml
/// --training-presses 800 --test-presses 50 --slides 8 --steps 8000`.
const PHYSTAC_TIP: &[u8] = include_bytes!("../built_in/phystac-tip.safetensors");

impl FastGel {
    /// The built-in surrogate of PhysTac's gel.
    ///
    /// # Errors
    /// None, unless this crate was compiled with another file in its place.
    pub fn phystac() -> Result<Self, FastFileError> {
        Self::from_bytes(PHYSTAC)
    }

    /// The built-in surrogate of the gel of PhysTac's domed fingertip.
    ///
    /// # Errors
    /// None, unless this crate was compiled with another file in its place.
    pub fn phystac_tip() -> Result<Self, FastFileError> {
        Self::from_bytes(PHYSTAC_TIP)
    }

    /// The surrogate as the bytes of a file.
    ///
    /// # Errors
    /// None that is known.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FastFileError> {
        let header = Header {
            version: VERSION,
            sensor: self.sensor.clone(),
            gel: TrainedOn::clone(&self.gel),
            ports: self.ports.clone(),
            ports_mm: self.ports_mm.clone(),
            layout: self.layout.clone(),
            center_mm: self.center_mm,
            ood_unit: self.ood_score.nearest.unit,
            error_of_one_press: self.ood_score.coverage.error_of_one,
        };
        let header = serde_json::to_string(&header).map_err(FastFileError::new)?;
        let mut tensors = Vec::new();
        let networks = [
            ("pressure", Some(&self.networks.pressure)),
            ("wrench", Some(&self.networks.wrench)),
            ("taxels", self.networks.taxels.as_ref()),
        ];
        for (name, network) in networks {
            let Some(network) = network else { continue };
            let layers = std::iter::once(&network.point).chain(&network.rest.layers);
            for (index, Linear { weight, bias }) in layers.enumerate() {
                let tensor = |part: &str| format!("{name}.{index}.{part}");
                let shape = vec![weight.n_rows(), weight.n_columns];
                tensors.push((tensor("weight"), shape, bytes(&weight.values)));
                tensors.push((tensor("bias"), vec![bias.len()], bytes(bias)));
            }
        }
        let OodScore { nearest, coverage } = &self.ood_score;
        let mut put = |name: &str, shape: Vec<usize>, values: &[f32]| {
            tensors.push((name.to_owned(), shape, bytes(values)));
        };
        put(
            "novelty.kept",
            vec![nearest.kept.n_rows(), N_TRAITS],
            &nearest.kept.values,
        );
        put("novelty.scale", vec![N_TRAITS], &nearest.scale);
        put("novelty.lessons", vec![coverage.presses.len()], &coverage.presses);
        put(
            "novelty.deepest_mm",
            vec![coverage.deepest_mm.len()],
            &coverage.deepest_mm,
        );
        let views = tensors.iter().map(|(name, shape, bytes)| {
            let view = TensorView::new(Dtype::F32, shape.clone(), bytes).map_err(FastFileError::new)?;
            Ok((name.clone(), view))
        });
        let views = views.collect::<Result<Vec<_>, FastFileError>>()?;
        let entries = HashMap::from([(ENTRY.to_owned(), header)]);
        safetensors::serialize(views, Some(entries)).map_err(FastFileError::new)
    }

    /// Reads the bytes that [`Self::to_bytes`] made.
    ///
    /// # Errors
    /// Bytes that are something else, or of another version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FastFileError> {
        let (_, entries) = SafeTensors::read_metadata(bytes).map_err(FastFileError::new)?;
        let entries = entries.metadata().as_ref().and_then(|entries| entries.get(ENTRY));
        let header = entries.ok_or_else(|| FastFileError::new(format!("its header has no `{ENTRY}`")))?;
        let Version { version } = serde_json::from_str(header).map_err(FastFileError::new)?;
        if version != VERSION {
            let problem = format!(
                "its version is {version} where {VERSION} is expected; train it again with `twintac fast train`"
            );
            return Err(FastFileError::new(problem));
        }
        let header: Header = serde_json::from_str(header).map_err(FastFileError::new)?;
        let is_whole = |grid: &SurfaceGrid| grid.n.iter().product::<usize>() == grid.len();
        if header.layout.grids.is_empty() || !header.layout.grids.iter().all(is_whole) {
            return Err(FastFileError::new(
                "its grids have other numbers of heights than of points",
            ));
        }
        let tensors = SafeTensors::deserialize(bytes).map_err(FastFileError::new)?;
        let (n_patch, n_grid) = (header.layout.patch.offsets.len(), header.layout.grid().len());
        let n_inputs = [header.layout.patch.n_inputs(), header.layout.n_field_inputs()];
        let networks = Networks {
            pressure: network(&tensors, "pressure", [n_patch, n_inputs[0]], 1)?,
            wrench: network(&tensors, "wrench", [n_grid, n_inputs[1]], 6)?,
            taxels: tensors
                .tensor("taxels.0.weight")
                .is_ok()
                .then(|| network(&tensors, "taxels", [n_grid, n_inputs[1]], header.ports_mm.len()))
                .transpose()?,
        };
        let ood_score = OodScore {
            nearest: Nearest {
                kept: Matrix {
                    values: tensor(&tensors, "novelty.kept", &[None, Some(N_TRAITS)])?,
                    n_columns: N_TRAITS,
                },
                scale: tensor(&tensors, "novelty.scale", &[Some(N_TRAITS)])?,
                unit: header.ood_unit,
            },
            coverage: Coverage {
                presses: tensor(&tensors, "novelty.lessons", &[Some(n_grid)])?,
                deepest_mm: tensor(&tensors, "novelty.deepest_mm", &[Some(n_grid)])?,
                error_of_one: header.error_of_one_press,
            },
        };
        Ok(Self {
            ood_score,
            sensor: header.sensor,
            gel: Arc::new(header.gel),
            ports: header.ports,
            ports_mm: header.ports_mm,
            layout: header.layout,
            center_mm: header.center_mm,
            networks,
        })
    }
}

/// Reads a network, and checks that its layers fit each other, its inputs and its outputs.
fn network(
    tensors: &SafeTensors<'_>,
    name: &str,
    [n_points, n_inputs]: [usize; 2],
    n_outputs: usize,
) -> Result<LocalNetwork, FastFileError> {
    let point = layer(tensors, &format!("{name}.0"), N_CHANNELS)?;
    let mut n = n_points * point.bias.len() + n_inputs - n_points * N_CHANNELS;
    let mut layers = Vec::new();
    while tensors
        .tensor(&format!("{name}.{}.weight", layers.len() + 1))
        .is_ok()
    {
        let layer = layer(tensors, &format!("{name}.{}", layers.len() + 1), n)?;
        n = layer.bias.len();
        layers.push(layer);
    }
    if layers.is_empty() || n != n_outputs {
        return Err(FastFileError::new(format!(
            "the network `{name}` is not complete"
        )));
    }
    Ok(LocalNetwork {
        point,
        rest: Perceptron { layers },
    })
}

/// Reads a layer with this number of inputs.
fn layer(tensors: &SafeTensors<'_>, name: &str, n_inputs: usize) -> Result<Linear, FastFileError> {
    let bias = tensor(tensors, &format!("{name}.bias"), &[None])?;
    let n_columns = bias.len();
    let values = tensor(
        tensors,
        &format!("{name}.weight"),
        &[Some(n_inputs), Some(n_columns)],
    )?;
    Ok(Linear {
        weight: Matrix { values, n_columns },
        bias,
    })
}

/// The numbers of a tensor of this shape; `None` stands for any length.
fn tensor(tensors: &SafeTensors<'_>, name: &str, shape: &[Option<usize>]) -> Result<Vec<f32>, FastFileError> {
    let found = tensors.tensor(name).map_err(FastFileError::new)?;
    let fits =
        |(expected, found): (&Option<usize>, &usize)| expected.is_none_or(|expected| expected == *found);
    let is_so = found.shape().len() == shape.len() && shape.iter().zip(found.shape()).all(fits);
    if !is_so || found.dtype() != Dtype::F32 {
        return Err(FastFileError::new(format!("`{name}` does not fit the rest")));
    }
    let numbers = found.data().as_chunks::<4>().0.iter();
    let numbers: Vec<f32> = numbers.map(|bytes| f32::from_le_bytes(*bytes)).collect();
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err(FastFileError::new(format!(
            "`{name}` has numbers that are not finite"
        )));
    }
    Ok(numbers)
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
