use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::mesh::TriMesh;
use crate::visibility::{MeasureOptions, Visibility};

/// First bytes of a kept measurement.
const MAGIC: &[u8; 8] = b"OUTSEEN2";

/// SHA-256.
type Hash = [u8; 32];

/// What a measurement was made of: a mesh, and the options that may change its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeasurementKey {
    mesh: Hash,
    options: Hash,
}

impl MeasurementKey {
    /// The key of looking at `mesh` among `occluders` under `options` with this version of Outsight.
    #[must_use]
    pub fn of(mesh: &TriMesh, occluders: &[TriMesh], options: &MeasureOptions) -> Self {
        // How much memory there is changes no number, nor does the seed of nothing. Every other option goes in, those of later versions too.
        let mut options = MeasureOptions { memory_limit: None, ..options.clone() };
        if !options.is_random() {
            options.rays.seed = 0;
        }
        let words = format!("Outsight {}, {options:?}", env!("CARGO_PKG_VERSION"));
        let surroundings = occluders.iter().flat_map(hash_of).collect();
        Self { mesh: hash_of(mesh), options: Sha256::digest([words.into_bytes(), surroundings].concat()).into() }
    }

    /// 64 hexadecimal digits that stand for both.
    #[must_use]
    pub fn name(&self) -> String {
        let both: Hash = Sha256::digest([self.mesh, self.options].concat()).into();
        both.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

fn hash_of(mesh: &TriMesh) -> Hash {
    let mut hash = Sha256::new();
    hash.update((mesh.vertex_count() as u64).to_le_bytes());
    for p in mesh.positions() {
        hash.update(bytemuck::bytes_of(&p.to_array().map(f64::to_le_bytes)));
    }
    for triangle in mesh.triangles() {
        hash.update(bytemuck::bytes_of(&triangle.map(u32::to_le_bytes)));
    }
    hash.finalize().into()
}

/// Why bytes are not the measurement that was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum KeptFault {
    /// They are something else.
    #[error("this is no measurement that Outsight keeps")]
    Foreign,
    /// Another mesh was looked at.
    #[error("this measurement is of another mesh")]
    OtherMesh,
    /// The mesh was looked at in another way, or among other occluders.
    #[error("this measurement was made with other options, other occluders or by another version of Outsight")]
    OtherOptions,
    /// Bytes are missing, or not as they were written.
    #[error("this measurement is damaged or truncated")]
    Damaged,
}

/// A measurement to be kept from run to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptMeasurement {
    /// What was seen.
    pub visibility: Visibility,
    /// The marks of [`super::Hidden::Delete`], if someone asked for them.
    pub hidden: Option<Vec<bool>>,
}

impl KeptMeasurement {
    /// How many bytes [`Self::check_head`] looks at.
    pub const HEAD: usize = MAGIC.len() + 2 * size_of::<Hash>();

    /// Magic, key, numbers, and a checksum of all that.
    #[must_use]
    pub fn to_bytes(&self, key: &MeasurementKey) -> Vec<u8> {
        let head = [MAGIC.as_slice(), &key.mesh, &key.options].concat();
        let mut bytes = postcard::to_extend(self, head).expect("numbers and lists of known length can be written");
        let checksum = Sha256::digest(&bytes);
        bytes.extend_from_slice(&checksum);
        bytes
    }

    /// Says whether the first bytes of a file belong to what `key` stands for.
    ///
    /// # Errors
    /// [`KeptFault`], but for damage behind the head.
    pub fn check_head(bytes: &[u8], key: &MeasurementKey) -> Result<(), KeptFault> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(KeptFault::Foreign)?;
        let (mesh, rest) = rest.split_at_checked(size_of::<Hash>()).ok_or(KeptFault::Damaged)?;
        let (options, _) = rest.split_at_checked(size_of::<Hash>()).ok_or(KeptFault::Damaged)?;
        match (mesh == key.mesh, options == key.options) {
            (false, _) => Err(KeptFault::OtherMesh),
            (_, false) => Err(KeptFault::OtherOptions),
            _ => Ok(()),
        }
    }

    /// Reads what [`Self::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`KeptFault`].
    pub fn from_bytes(bytes: &[u8], key: &MeasurementKey) -> Result<Self, KeptFault> {
        Self::check_head(bytes, key)?;
        let (body, checksum) = bytes.split_last_chunk::<32>().ok_or(KeptFault::Damaged)?;
        if Sha256::digest(body).as_slice() != checksum {
            return Err(KeptFault::Damaged);
        }
        let body = body.get(Self::HEAD..).ok_or(KeptFault::Damaged)?;
        postcard::from_bytes(body).map_err(|_| KeptFault::Damaged)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::camera::Cameras;
    use crate::mesh::shapes;
    use crate::progress::Silent;
    use crate::visibility::{Estimator, RayOptions, Sides, measure};

    fn options() -> MeasureOptions {
        MeasureOptions { cameras: Cameras::octahedral(18), resolution: Some(32), ..MeasureOptions::default() }
    }

    fn kept(mesh: &TriMesh) -> KeptMeasurement {
        let visibility = measure(mesh, &options(), &Silent).unwrap();
        KeptMeasurement { hidden: Some(vec![false, true, false, false]), visibility }
    }

    #[test]
    fn a_measurement_comes_back_bit_by_bit() {
        let mesh = shapes::tetrahedron();
        let (kept, key) = (kept(&mesh), MeasurementKey::of(&mesh, &[], &options()));
        assert_eq!(KeptMeasurement::from_bytes(&kept.to_bytes(&key), &key), Ok(kept));
    }

    #[test]
    fn every_truncation_and_every_changed_byte_is_found() {
        let mesh = shapes::tetrahedron();
        let key = MeasurementKey::of(&mesh, &[], &options());
        let bytes = kept(&mesh).to_bytes(&key);
        for end in 0..bytes.len() {
            assert!(KeptMeasurement::from_bytes(&bytes[..end], &key).is_err(), "{end}");
        }
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1;
            assert!(KeptMeasurement::from_bytes(&changed, &key).is_err(), "{at}");
        }
    }

    #[test]
    fn another_mesh_and_other_options_are_told_apart() {
        let mesh = shapes::tetrahedron();
        let key = MeasurementKey::of(&mesh, &[], &options());
        let bytes = kept(&mesh).to_bytes(&key);
        let fault = |key: &MeasurementKey| KeptMeasurement::from_bytes(&bytes, key).unwrap_err();
        let (mut corners, triangles) = mesh.clone().into_parts();
        corners[3].z = corners[3].z.next_up();
        let moved = TriMesh::new(corners, triangles).unwrap();
        assert_eq!(fault(&MeasurementKey::of(&moved, &[], &options())), KeptFault::OtherMesh);
        let one_sided = MeasureOptions { sides: Sides::One, ..options() };
        assert_eq!(fault(&MeasurementKey::of(&mesh, &[], &one_sided)), KeptFault::OtherOptions);
        assert_eq!(fault(&MeasurementKey::of(&mesh, std::slice::from_ref(&mesh), &options())), KeptFault::OtherOptions);
        let frugal = MeasureOptions { memory_limit: Some(1 << 40), ..options() };
        assert_eq!(MeasurementKey::of(&mesh, &[], &frugal), key, "memory changes no number");
        let seeded = |estimator, points| {
            let key = |seed| {
                let rays = RayOptions { seed, points, ..RayOptions::default() };
                MeasurementKey::of(&mesh, &[], &MeasureOptions { estimator, rays, ..options() })
            };
            key(1) != key(2)
        };
        assert!(seeded(Estimator::Hemisphere, 1) && seeded(Estimator::Surface, 5));
        let seedless =
            [(Estimator::Coverage, 1), (Estimator::ItemBuffer, 1), (Estimator::Surface, 1), (Estimator::Surface, 4)];
        assert!(!seedless.into_iter().any(|(estimator, points)| seeded(estimator, points)));
        assert_eq!(KeptMeasurement::from_bytes(b"ply\n", &key), Err(KeptFault::Foreign));
    }
}
