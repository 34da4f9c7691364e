#![allow(clippy::unwrap_used)]

use super::*;

/// Three triangles, 70 cameras: rows of two words, and of 72 bytes.
fn diagram(fractions: bool) -> Diagram {
    let cameras = (0..70).map(|v| [v as f32, 0.5, -1.0, 0.25]).collect();
    let words = vec![0b101, 1 << 5, 0, 0, u64::MAX, 0b11_1111];
    let bytes = || (0..210).map(|i| if i < 70 { 7 } else { i as u8 }).collect();
    Diagram { cameras, triangles: 3, words, fractions: fractions.then(bytes) }
}

fn bytes_of(diagram: &Diagram, name: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_vdg(&path, diagram, false).unwrap();
    assert_eq!(read_vdg(&path, None).unwrap(), *diagram, "read back");
    std::fs::read(&path).unwrap()
}

#[test]
fn bytes_stand_where_the_format_says() {
    let bytes = bytes_of(&diagram(true), "a.vdg");
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!((&bytes[..4], number(4), number(8)), (&b"VDG1"[..], 3, 70));
    assert_eq!(f32::from_bits(number(12 + 16 * 69)), 69.0, "x of the last camera");
    assert_eq!(f32::from_bits(number(12 + 16 * 69 + 12)), 0.25, "its solid angle");
    let flags = 12 + 16 * 70;
    assert_eq!(number(flags), 3);
    let rows = flags + 4;
    let sees = |t: usize, v: usize| bytes[rows + 16 * t + v / 8] >> (v % 8) & 1 == 1;
    let of_0: Vec<usize> = (0..128).filter(|&v| sees(0, v)).collect();
    assert_eq!(of_0, [0, 2, 69]);
    assert_eq!((0..128).filter(|&v| sees(1, v)).count(), 0);
    assert_eq!((0..128).filter(|&v| sees(2, v)).count(), 70);
    let shares = rows + 16 * 3;
    assert_eq!(bytes[shares..shares + 73], [[7; 70].as_slice(), &[0, 0], &[70]].concat());
    assert_eq!(bytes.len(), shares + 72 * 3);
}

#[test]
fn diagrams_without_fractions_and_packed_ones_come_back() {
    assert_eq!(bytes_of(&diagram(false), "a.vdg").len(), 16 + 16 * 70 + 16 * 3);
    assert!(bytes_of(&diagram(true), "a.vdg.gz").starts_with(&[0x1f, 0x8b]));
    #[cfg(feature = "zstd")]
    assert!(bytes_of(&diagram(true), "a.vdg.zst").starts_with(&[0x28, 0xb5, 0x2f, 0xfd]));
}

#[test]
fn every_truncation_and_every_extra_byte_is_an_error() {
    let mut bytes = bytes_of(&diagram(true), "a.vdg");
    for end in 0..bytes.len() {
        assert!(parse(&bytes[..end]).is_err(), "{end}");
    }
    bytes.push(0);
    assert!(parse(&bytes).is_err(), "one byte more");
}

#[test]
fn a_header_that_promises_the_world_allocates_nothing() {
    let mut bytes = bytes_of(&diagram(false), "a.vdg");
    bytes[4..8].copy_from_slice(&u32::MAX.to_le_bytes());
    let message = parse(&bytes).unwrap_err().named("a.vdg").to_string();
    assert_eq!(
        message,
        "a.vdg: its bits need 68719476720 bytes from byte 1136, the file ends at 1184; is it truncated?"
    );
    bytes[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(parse(&bytes).is_err());
    let other = parse(b"ply\n").unwrap_err().named("a.ply").to_string();
    assert!(other.contains("no visibility diagram"), "{other}");
}

#[test]
fn numpy_arrays_have_a_byte_per_pair() {
    let folder = tempfile::tempdir().unwrap();
    for (fractions, kind) in [(false, "|b1"), (true, "|u1")] {
        let path = folder.path().join("a.npy");
        write_diagram_npy(&path, &diagram(fractions), true).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let head = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (3, 70), }}");
        assert!(bytes[10..].starts_with(head.as_bytes()));
        let data = &bytes[128..];
        assert_eq!(data.len(), 210);
        let wanted = if fractions { [7; 4] } else { [1, 0, 1, 0] };
        assert_eq!(data[..4], wanted);
        assert_eq!(data[69], if fractions { 7 } else { 1 });
    }
}

#[test]
fn rows_of_another_size_are_refused() {
    let short = Diagram { triangles: 4, ..diagram(false) };
    assert!(matches!(write_vdg(Path::new("never.vdg"), &short, false), Err(Error::ShapeMismatch { .. })));
}
