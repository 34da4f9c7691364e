//! Rows of numbers, in each encoding.

use super::super::fault::Fault;
use super::super::text::{self, Words, show};
use super::header::{Element, Header, Scalar};

/// Why a row could not be read.
#[derive(Debug)]
pub(super) enum Trouble {
    /// The file ends within it.
    End,
    /// A number in it is wrong.
    Wrong(Fault),
}

impl From<Fault> for Trouble {
    fn from(fault: Fault) -> Self {
        Self::Wrong(fault)
    }
}

/// The numbers behind a header, one after the other.
pub(super) trait Rows {
    /// The next number.
    fn float(&mut self, kind: Scalar) -> Result<f64, Trouble>;

    /// The next number, of an integer type.
    fn integer(&mut self, kind: Scalar) -> Result<i64, Trouble>;

    /// Steps over `count` numbers.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Trouble>;

    /// The row ends here.
    fn end_row(&mut self) -> Result<(), Trouble>;

    /// How many rows of the element fit into the rest of the file at most, however many are promised.
    fn most_rows(&self, element: &Element) -> usize;

    /// Whether a row held more than the header names, which was stepped over.
    fn has_surplus(&self) -> bool {
        false
    }

    /// Whether nothing but padding is left.
    fn is_at_end(&self) -> bool;

    /// A fault at the last number.
    fn fault(&self, message: String) -> Fault;

    /// The fault of a file that ends early.
    fn truncated(&self, promise: &str, rows: usize) -> Fault;
}

/// Numbers as words. A row begins in a line of its own and may go on over several.
///
/// VCGLIB writes colours of corners as a list that its header gives as single numbers, so the end of a line may hold
/// more than was promised. A row of several lines may not: there, a number is missing further up.
#[derive(Debug)]
pub(super) struct AsciiRows<'a> {
    words: Words<'a>,
    file_bytes: usize,
    /// Line in which the current row began, once it has.
    row_line: Option<usize>,
    has_surplus: bool,
}

impl<'a> AsciiRows<'a> {
    pub(super) fn new(file: &'a [u8], header: &Header) -> Self {
        let words = Words::new(&file[header.bytes..], header.lines + 1);
        Self { words, file_bytes: file.len(), row_line: None, has_surplus: false }
    }

    fn word(&mut self) -> Result<&'a [u8], Trouble> {
        let word = self.words.next().ok_or(Trouble::End)?;
        self.row_line.get_or_insert(self.words.line());
        Ok(word)
    }
}

impl Rows for AsciiRows<'_> {
    fn float(&mut self, _kind: Scalar) -> Result<f64, Trouble> {
        let word = self.word()?;
        Ok(text::coordinate(word, self.words.line())?)
    }

    fn integer(&mut self, _kind: Scalar) -> Result<i64, Trouble> {
        let word = self.word()?;
        text::integer(word).ok_or_else(|| self.fault(format!("expected a whole number, found {}", show(word))).into())
    }

    fn skip(&mut self, _kind: Scalar, count: u64) -> Result<(), Trouble> {
        (0..count).try_for_each(|_| self.word().map(drop))
    }

    fn end_row(&mut self) -> Result<(), Trouble> {
        let began = self.row_line.take().unwrap_or(self.words.line());
        let Some(word) = self.words.next_in_line() else { return Ok(()) };
        if began < self.words.line() {
            return Err(self.fault(format!("the row that began in line {began} ends before {}", show(word))).into());
        }
        self.words.rest_of_line();
        self.has_surplus = true;
        Ok(())
    }

    fn has_surplus(&self) -> bool {
        self.has_surplus
    }

    fn most_rows(&self, element: &Element) -> usize {
        // A number takes a digit and a blank; the file's last one may lack the blank.
        self.words.rest().len() / (2 * element.properties.len()).max(1) + 1
    }

    fn is_at_end(&self) -> bool {
        self.words.rest().trim_ascii().is_empty()
    }

    fn fault(&self, message: String) -> Fault {
        Fault::at(self.words.line(), message)
    }

    fn truncated(&self, promise: &str, rows: usize) -> Fault {
        truncated(promise, rows, self.file_bytes)
    }
}

fn truncated(promise: &str, rows: usize, file_bytes: usize) -> Fault {
    Fault::new(format!(
        "the header promises {promise}, the file ends after {rows} (byte {file_bytes}); is it truncated?"
    ))
}

/// Binary numbers.
#[derive(Debug)]
pub(super) struct BinaryRows<'a, const BIG: bool> {
    rest: &'a [u8],
    file_bytes: usize,
}

impl<'a, const BIG: bool> BinaryRows<'a, BIG> {
    pub(super) fn new(file: &'a [u8], header: &Header) -> Self {
        Self { rest: &file[header.bytes..], file_bytes: file.len() }
    }

    /// The next `N` bytes, the lowest first.
    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Trouble> {
        let (&number, rest) = self.rest.split_first_chunk::<N>().ok_or(Trouble::End)?;
        self.rest = rest;
        let mut number = number;
        if BIG {
            number.reverse();
        }
        Ok(number)
    }
}

impl<const BIG: bool> Rows for BinaryRows<'_, BIG> {
    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f64, Trouble> {
        match kind {
            Scalar::F32 => Ok(f64::from(f32::from_le_bytes(self.take()?))),
            Scalar::F64 => Ok(f64::from_le_bytes(self.take()?)),
            // An integer type of PLY has at most 32 bits, so nothing is rounded.
            integer => Ok(self.integer(integer)? as f64),
        }
    }

    #[inline]
    fn integer(&mut self, kind: Scalar) -> Result<i64, Trouble> {
        Ok(match kind {
            Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
            Scalar::F32 | Scalar::F64 => {
                return Err(self.fault("a number that counts has a type with fractions".to_owned()).into());
            }
        })
    }

    #[inline]
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Trouble> {
        let bytes = usize::try_from(count).ok().and_then(|n| n.checked_mul(kind.size())).ok_or(Trouble::End)?;
        self.rest = self.rest.get(bytes..).ok_or(Trouble::End)?;
        Ok(())
    }

    #[inline]
    fn end_row(&mut self) -> Result<(), Trouble> {
        Ok(())
    }

    fn most_rows(&self, element: &Element) -> usize {
        self.rest.len() / element.least_row_bytes().max(1)
    }

    fn is_at_end(&self) -> bool {
        self.rest.trim_ascii().is_empty()
    }

    fn fault(&self, message: String) -> Fault {
        Fault::new(format!("{message} (before byte {})", self.file_bytes - self.rest.len()))
    }

    fn truncated(&self, promise: &str, rows: usize) -> Fault {
        truncated(promise, rows, self.file_bytes)
    }
}
