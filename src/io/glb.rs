//! Binary glTF 2.0, written: one mesh, one material, colours if there are any.
//!
//! Source: Khronos Group, glTF 2.0 Specification, 2021: §3.6 accessors, §3.7.2 meshes, §4 the container.

use std::collections::HashMap;
use std::io::{self, Write};

use glam::DVec3;
use serde_json::{Value, json};

use super::encode::SMALLEST_IN_F32;
use crate::error::{Error, Result};
use crate::geom::Aabb;
use crate::mesh::TriMesh;

/// A mesh as glTF stores it: 32-bit coordinates around a centre, colours at vertices.
///
/// Colours belong to triangles here and to vertices there, so that a vertex is split where its triangles differ in
/// colour, and nowhere else: averaging would blur the step from a hidden surface to a seen one. Vertices that no
/// triangle uses are left out. Axes are the mesh's own; glTF calls the second one up.
#[derive(Debug, Clone)]
pub struct Glb {
    /// Relative to `centre`.
    positions: Vec<[f32; 3]>,
    /// Linear red, green, blue, and 65535: sixteen bits keep all 256 levels of sRGB apart.
    colours: Option<Vec<[u16; 4]>>,
    triangles: Vec<[u32; 3]>,
    /// What the node's translation adds: 0 where 32 bits hold every coordinate as it is.
    centre: DVec3,
}

/// Positions, colours or indices: their kinds of number and their place in the file.
struct Block {
    bytes: Vec<u8>,
    target: u32,
    accessor: Value,
}

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

impl Glb {
    /// Lays out a mesh; `colours` has an sRGB colour per triangle.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] for colours of another mesh.
    pub fn of(mesh: &TriMesh, colours: Option<&[[u8; 3]]>) -> Result<Self> {
        let expected = mesh.triangle_count();
        if let Some(got) = colours.map(<[_]>::len).filter(|&got| got != expected) {
            return Err(Error::ShapeMismatch { what: "colours", got, expected });
        }
        let mut copies = HashMap::with_capacity(mesh.vertex_count());
        let mut origins: Vec<(u32, [u8; 3])> = Vec::with_capacity(mesh.vertex_count());
        let mut copy_of = |vertex: u32, triangle: usize| {
            let key = (vertex, colours.map_or([0; 3], |colours| colours[triangle]));
            *copies.entry(key).or_insert_with(|| {
                origins.push(key);
                origins.len() as u32 - 1
            })
        };
        let numbered = mesh.triangles().iter().enumerate();
        let triangles = numbered.map(|(t, corners)| corners.map(|vertex| copy_of(vertex, t))).collect();
        let points = || origins.iter().map(|&(vertex, _)| mesh.positions()[vertex as usize]);
        let centre = centre_of(points);
        let levels: Vec<u16> = (0..=255).map(linear).collect();
        let colour = |&(_, [r, g, b]): &(u32, [u8; 3])| {
            [levels[usize::from(r)], levels[usize::from(g)], levels[usize::from(b)], u16::MAX]
        };
        Ok(Self {
            positions: points().map(|p| (p - centre).as_vec3().to_array()).collect(),
            colours: colours.map(|_| origins.iter().map(colour).collect()),
            triangles,
            centre,
        })
    }

    /// Whether 32 bits hold what is written, and not everything falls onto the centre.
    pub(super) fn fits(&self) -> bool {
        let reach = self.positions.iter().flatten().fold(0.0_f32, |reach, c| reach.max(c.abs()));
        // Of an infinite centre and of infinite coordinates the difference may be no number, which no maximum shows.
        let is_finite = self.positions.iter().flatten().all(|c| c.is_finite()) && self.centre.is_finite();
        is_finite && f64::from(reach) >= SMALLEST_IN_F32
    }

    /// Writes the file.
    ///
    /// # Errors
    /// What `output` says; also for a file of 4 GiB and more, which the format cannot hold.
    pub fn write(&self, output: &mut dyn Write) -> io::Result<()> {
        let blocks: Vec<Block> =
            [Some(self.positions()), self.colours(), Some(self.indices())].into_iter().flatten().collect();
        let mut text = serde_json::to_vec(&self.description(&blocks))?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let length: usize = blocks.iter().map(|block| block.bytes.len()).sum();
        let [whole, text_length, binary_length] = [28 + text.len() + length, text.len(), length].map(u32::try_from);
        let too_long = |_| io::Error::other("GLB holds less than 4 GiB; write .ply");
        output.write_all(b"glTF\x02\0\0\0")?;
        output.write_all(&whole.map_err(too_long)?.to_le_bytes())?;
        output.write_all(&text_length.map_err(too_long)?.to_le_bytes())?;
        output.write_all(b"JSON")?;
        output.write_all(&text)?;
        output.write_all(&binary_length.map_err(too_long)?.to_le_bytes())?;
        output.write_all(b"BIN\0")?;
        blocks.iter().try_for_each(|block| output.write_all(&block.bytes))
    }

    fn positions(&self) -> Block {
        let end = |pick: fn(f32, f32) -> f32| {
            let corner = self.positions.iter().copied().reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i])));
            corner.unwrap_or_default().map(f64::from)
        };
        let accessor = json!({
            "componentType": FLOAT, "count": self.positions.len(), "type": "VEC3",
            "min": end(f32::min), "max": end(f32::max),
        });
        let bytes = self.positions.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        Block { bytes, target: ARRAY_BUFFER, accessor }
    }

    fn colours(&self) -> Option<Block> {
        let colours = self.colours.as_ref()?;
        let accessor = json!({
            "componentType": UNSIGNED_SHORT, "normalized": true, "count": colours.len(), "type": "VEC4",
        });
        let bytes = colours.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        Some(Block { bytes, target: ARRAY_BUFFER, accessor })
    }

    /// Two bytes each where they do: 65535 is not a vertex's number but the end of a strip.
    fn indices(&self) -> Block {
        let corners = self.triangles.iter().flatten();
        let narrow = self.positions.len() < usize::from(u16::MAX);
        let mut bytes: Vec<u8> = if narrow {
            corners.flat_map(|&corner| (corner as u16).to_le_bytes()).collect()
        } else {
            corners.flat_map(|corner| corner.to_le_bytes()).collect()
        };
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let accessor = json!({
            "componentType": if narrow { UNSIGNED_SHORT } else { UNSIGNED_INT },
            "count": 3 * self.triangles.len(), "type": "SCALAR",
        });
        Block { bytes, target: ELEMENT_ARRAY_BUFFER, accessor }
    }

    fn description(&self, blocks: &[Block]) -> Value {
        let mut at = 0;
        let mut views = Vec::new();
        let mut accessors = Vec::new();
        for (view, block) in blocks.iter().enumerate() {
            let length = block.bytes.len();
            views.push(json!({ "buffer": 0, "byteOffset": at, "byteLength": length, "target": block.target }));
            let mut accessor = block.accessor.clone();
            accessor["bufferView"] = view.into();
            accessors.push(accessor);
            at += length;
        }
        let mut node = json!({ "mesh": 0 });
        if self.centre != DVec3::ZERO {
            node["translation"] = json!(self.centre.to_array());
        }
        let attributes = match self.colours {
            Some(_) => json!({ "POSITION": 0, "COLOR_0": 1 }),
            None => json!({ "POSITION": 0 }),
        };
        json!({
            "asset": { "version": "2.0", "generator": "Outsight" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [node],
            "meshes": [{ "primitives": [{ "attributes": attributes, "indices": blocks.len() - 1, "material": 0 }] }],
            // No normals: viewers then shade flat, as Outsight does. Both sides show, as they are measured.
            "materials": [{ "doubleSided": true, "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 1 } }],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{ "byteLength": at }],
        })
    }
}

/// 0 where all points are 32-bit numbers already, else the middle of their box, itself rounded to 32 bits so that who
/// narrows it loses nothing.
fn centre_of<I: Iterator<Item = DVec3>>(points: impl Fn() -> I) -> DVec3 {
    if points().all(|p| p.as_vec3().as_dvec3() == p) {
        return DVec3::ZERO;
    }
    Aabb::around(points()).map_or(DVec3::ZERO, |hull| hull.centre().as_vec3().as_dvec3())
}

/// A level of sRGB as a share of light, in 65535ths. Source: IEC 61966-2-1.
fn linear(level: u8) -> u16 {
    let share = f64::from(level) / 255.0;
    let light = if share <= 0.04045 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) };
    (65535.0 * light).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IEC 61966-2-1, the way back.
    fn level(light: u16) -> u8 {
        let share = f64::from(light) / 65535.0;
        let coded = if share <= 0.003_130_8 { 12.92 * share } else { 1.055 * libm::pow(share, 1.0 / 2.4) - 0.055 };
        (255.0 * coded).round() as u8
    }

    #[test]
    fn every_level_of_srgb_comes_back() {
        assert!((0..=255).all(|l| level(linear(l)) == l));
        assert_eq!([linear(0), linear(255)], [0, 65535]);
        // Half the levels of sRGB are a fifth of the light: 0.2158605.
        assert_eq!(linear(128), 14146);
    }
}
