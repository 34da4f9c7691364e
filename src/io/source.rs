//! The bytes of a file or pipe, unpacked. Compression is recognised by the first bytes, so that it works in a pipe.

use std::cell::Cell;
use std::fs::File;
use std::io::{Cursor, ErrorKind, Read};
use std::path::Path;

use super::fault::Fault;
use super::format::{Compression, FileName};
use crate::error::{Error, Result};

/// What a compressed file may unpack to without a memory limit: this, plus [`MOST_EXPANSION`] times its size. Mesh
/// files shrink to a half or a tenth, grids of text to a fiftieth; a bomb of zeros to a thousandth and less.
const FREE_EXPANSION: u64 = 64 << 20;
/// See [`FREE_EXPANSION`].
const MOST_EXPANSION: u64 = 200;

/// All bytes of the file, or of standard input for `-`, unpacked.
pub(super) fn read_all(path: &Path, name: &FileName, limit: Option<u64>) -> Result<Vec<u8>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    if name.is_pipe {
        return unpack(std::io::stdin().lock(), 0, name, limit);
    }
    let file = File::open(path).map_err(failed)?;
    let about = file.metadata().map_err(failed)?;
    if about.is_dir() {
        return Err(failed(ErrorKind::IsADirectory.into()));
    }
    unpack(file, about.len(), name, limit)
}

/// Reads `input`, of about `size` bytes, to its end.
fn unpack(mut input: impl Read, size: u64, name: &FileName, limit: Option<u64>) -> Result<Vec<u8>> {
    let mut start = Vec::with_capacity(4);
    input.by_ref().take(4).read_to_end(&mut start).map_err(|e| read_failed(name, e))?;
    let found = Compression::of_magic(&start);
    if let Some(said) = name.compression
        && found != Some(said)
    {
        return Err(not_compressed(name, said, found));
    }
    let input = Cursor::new(start).chain(input);
    match found {
        None => drain(input, size, || limit.unwrap_or(u64::MAX)).map_err(|stop| stop.plain(name)),
        Some(kind) => {
            let taken = Cell::new(0);
            let counted = Counted { input, taken: &taken };
            let most = || limit.unwrap_or_else(|| FREE_EXPANSION + MOST_EXPANSION * taken.get());
            let unpacked = match kind {
                Compression::Gzip => drain(flate2::read::MultiGzDecoder::new(counted), size, most),
                Compression::Zstd => drain(zstd_decoder(counted, name)?, size, most),
            };
            unpacked.map_err(|stop| stop.packed(name, kind, taken.get()))
        }
    }
}

#[cfg(feature = "zstd")]
fn zstd_decoder<'a>(input: impl Read + 'a, name: &FileName) -> Result<impl Read + 'a> {
    zstd::stream::read::Decoder::new(input).map_err(|e| read_failed(name, e))
}

#[cfg(not(feature = "zstd"))]
fn zstd_decoder<R: Read>(_input: R, name: &FileName) -> Result<std::io::Empty> {
    Err(Error::Unavailable {
        message: format!("{}: built without the `zstd` feature; unpack it first with `zstd -d`", name.shown),
    })
}

/// Counts the bytes that pass.
struct Counted<'a, R> {
    input: R,
    taken: &'a Cell<u64>,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n = self.input.read(buffer)?;
        self.taken.set(self.taken.get() + n as u64);
        Ok(n)
    }
}

/// Why [`drain`] ended before the end.
#[derive(Debug)]
enum Stop {
    /// Reading or unpacking went wrong after so many bytes.
    Io(std::io::Error, u64),
    /// The bytes are more than this.
    Limit(u64),
}

impl Stop {
    fn plain(self, name: &FileName) -> Error {
        match self {
            Self::Io(source, _) => read_failed(name, source),
            Self::Limit(limit) => Error::Limit {
                message: format!("{}: larger than the memory limit of {limit} bytes; raise --memory-limit", name.shown),
            },
        }
    }

    fn packed(self, name: &FileName, kind: Compression, taken: u64) -> Error {
        let kind = kind.name();
        match self {
            // The system's errors carry its number; the decoders' own do not.
            Self::Io(source, _) if source.raw_os_error().is_some() => read_failed(name, source),
            Self::Io(source, unpacked) if source.kind() == ErrorKind::UnexpectedEof => Fault::new(format!(
                "the .{kind} data ends early (byte {taken}, {unpacked} bytes unpacked); is it truncated?"
            ))
            .named(&name.shown),
            Self::Io(source, unpacked) => Fault::new(format!(
                "the .{kind} data is damaged after {unpacked} unpacked bytes ({source}); fetch the file again"
            ))
            .named(&name.shown),
            Self::Limit(limit) => Error::Limit {
                message: format!(
                    "{}: {taken} bytes of .{kind} unpack to more than {limit} bytes; set --memory-limit to allow more",
                    name.shown
                ),
            },
        }
    }
}

/// Reads to the end, or until there are more bytes than `most` says at that time.
fn drain(mut input: impl Read, size: u64, most: impl Fn() -> u64) -> std::result::Result<Vec<u8>, Stop> {
    const CHUNK: usize = 1 << 18;
    let mut bytes = Vec::new();
    if size > most() {
        return Err(Stop::Limit(most()));
    }
    // The size is what the system says a file has, never what its content promises; too little is no harm.
    let room = usize::try_from(size).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(room).map_err(|_| Stop::Io(ErrorKind::OutOfMemory.into(), 0))?;
    loop {
        let before = bytes.len() as u64;
        let got = input.by_ref().take(CHUNK as u64).read_to_end(&mut bytes).map_err(|e| Stop::Io(e, before))?;
        if bytes.len() as u64 > most() {
            return Err(Stop::Limit(most()));
        }
        if got < CHUNK {
            return Ok(bytes);
        }
    }
}

fn read_failed(name: &FileName, source: std::io::Error) -> Error {
    Error::Read { path: name.shown.clone().into(), source }
}

fn not_compressed(name: &FileName, said: Compression, found: Option<Compression>) -> Error {
    let looks = match found {
        Some(other) => format!("like .{}", other.name()),
        None => "not compressed".to_owned(),
    };
    let said = said.name();
    Fault::new(format!("the extension says .{said}, but the content looks {looks}; rename it")).named(&name.shown)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::io::Write;

    use super::*;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        packer.write_all(bytes).unwrap();
        packer.finish().unwrap()
    }

    fn read_gzip(packed: &[u8], limit: Option<u64>) -> Result<Vec<u8>> {
        unpack(packed, packed.len() as u64, &FileName::of(Path::new("a.ply.gz")), limit)
    }

    #[test]
    fn packed_bytes_come_back_also_from_several_members() {
        let packed = [gzip(b"one "), gzip(b"two")].concat();
        assert_eq!(read_gzip(&packed, None).unwrap(), b"one two");
        assert_eq!(unpack(&packed[..], 0, &FileName::of(Path::new("-")), None).unwrap(), b"one two");
    }

    #[test]
    fn bomb_stops_at_its_share() {
        let zeros = vec![0; (FREE_EXPANSION + (64 << 20)) as usize];
        let bomb = gzip(&zeros);
        let error = read_gzip(&bomb, None).unwrap_err();
        assert!(matches!(error, Error::Limit { .. }), "{error}");
        assert_eq!(read_gzip(&bomb, Some(1 << 30)).unwrap().len(), zeros.len());
    }

    #[test]
    fn memory_limit_bounds_plain_and_packed_input() {
        let packed = gzip(&[7; 1000]);
        assert!(matches!(read_gzip(&packed, Some(999)), Err(Error::Limit { .. })));
        assert!(read_gzip(&packed, Some(1000)).is_ok());
        let plain = FileName::of(Path::new("a.ply"));
        assert!(matches!(unpack(&[7; 1000][..], 0, &plain, Some(999)), Err(Error::Limit { .. })));
    }

    #[test]
    fn every_truncation_of_packed_data_is_an_error() {
        let packed = gzip(b"some bytes that are not worth packing");
        for end in 0..packed.len() {
            let error = read_gzip(&packed[..end], None).unwrap_err();
            assert!(matches!(error, Error::Parse { .. }), "{end}: {error}");
        }
    }

    #[cfg(feature = "zstd")]
    #[test]
    fn zstd_is_unpacked_and_its_every_truncation_and_damage_is_an_error() {
        let mut packed = zstd::stream::encode_all(&b"some bytes that are not worth packing"[..], 3).unwrap();
        let name = FileName::of(Path::new("a.ply.zst"));
        let read = |packed: &[u8]| unpack(packed, packed.len() as u64, &name, None);
        assert_eq!(read(&packed).unwrap(), b"some bytes that are not worth packing");
        for end in 0..packed.len() {
            let error = read(&packed[..end]).unwrap_err();
            assert!(matches!(error, Error::Parse { .. }), "{end}: {error}");
        }
        packed[4] ^= 0xff;
        let error = read(&packed).unwrap_err();
        assert!(matches!(error, Error::Parse { .. }), "{error}");
    }

    #[test]
    fn name_that_promises_compression_must_keep_it() {
        let error = read_gzip(b"ply\n", None).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a.ply.gz: the extension says .gz, but the content looks not compressed; rename it"
        );
    }
}
