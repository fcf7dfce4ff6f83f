//! The header of a `.bit` file.

use super::Fault;
use std::ops::Range;

/// Every `.bit` file begins with these bytes.
const PREAMBLE: [u8; 13] = [0, 9, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0, 0, 1];

/// What the file says of itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// Field a: the design, mostly the name of a netlist.
    pub design: String,
    /// Field b: device and package.
    pub part: String,
    /// Field c: date of the build.
    pub date: String,
    /// Field d: time of the build.
    pub time: String,
}

impl Header {
    /// The header of a file with a bitstream of this many bytes, up to the bitstream.
    #[must_use]
    pub fn encode(&self, bytes: usize) -> Vec<u8> {
        let mut out = PREAMBLE.to_vec();
        for (field, text) in [(b'a', &self.design), (b'b', &self.part), (b'c', &self.date), (b'd', &self.time)] {
            // Longer text has no place in the format's 16 bits of length.
            let text = &text.as_bytes()[..text.len().min(usize::from(u16::MAX) - 1)];
            out.push(field);
            out.extend((text.len() as u16 + 1).to_be_bytes());
            out.extend(text);
            out.push(0);
        }
        out.push(b'e');
        out.extend((bytes as u32).to_be_bytes());
        out
    }
}

/// Whether this is meant to be a `.bit` file, damaged or not.
pub(super) fn begins(file: &[u8]) -> bool {
    PREAMBLE.iter().zip(file).filter(|(a, b)| a == b).count() >= PREAMBLE.len() / 2
}

/// The header, and where in the file the bitstream is.
pub(super) fn parse(file: &[u8]) -> Result<(Header, Range<usize>), Fault> {
    let mut reader = Reader { file, at: 0 };
    if reader.take(PREAMBLE.len(), "the preamble")? != PREAMBLE {
        return Err(Fault::Field { field: '-', offset: 0, why: "(the preamble) is damaged" });
    }
    let mut header = Header::default();
    let mut seen = Vec::new();
    let stream = loop {
        let offset = reader.at;
        if offset == file.len() {
            return Err(Fault::Missing { field: 'e', meaning: "the bitstream" });
        }
        let field = char::from(reader.take(1, "a field")?[0]);
        let fault = |why| Fault::Field { field: if field.is_ascii_graphic() { field } else { '?' }, offset, why };
        if seen.contains(&field) {
            return Err(fault("comes twice"));
        }
        seen.push(field);
        match field {
            'a' => header.design = reader.text(fault)?,
            'b' => header.part = reader.text(fault)?,
            'c' => header.date = reader.text(fault)?,
            'd' => header.time = reader.text(fault)?,
            'e' => {
                let length = reader.take(4, "the length of field 'e'")?;
                let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
                let start = reader.at;
                reader.take(length, "the bitstream")?;
                break start..start + length;
            }
            _ => return Err(fault("is unknown")),
        }
    };
    if !seen.contains(&'b') {
        return Err(Fault::Missing { field: 'b', meaning: "device and package" });
    }
    match file.len() - stream.end {
        0 => Ok((header, stream)),
        count => Err(Fault::Trailing { count, offset: stream.end }),
    }
}

struct Reader<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Fault> {
        let offset = self.at;
        let end = offset.checked_add(count).filter(|end| *end <= self.file.len());
        let Some(end) = end else {
            return Err(Fault::Truncated { what: what.to_owned(), offset, length: self.file.len() });
        };
        self.at = end;
        Ok(&self.file[offset..end])
    }

    /// 16 bits of length, then text that ends with a zero byte.
    fn text(&mut self, fault: impl Fn(&'static str) -> Fault) -> Result<String, Fault> {
        let length = self.take(2, "the length of a field")?;
        let bytes = self.take(usize::from(u16::from_be_bytes([length[0], length[1]])), "a field")?;
        let Some((0, text)) = bytes.split_last() else { return Err(fault("does not end with a zero byte")) };
        if text.iter().any(|byte| !(b' '..=b'~').contains(byte)) {
            return Err(fault("is no printable text"));
        }
        Ok(text.iter().copied().map(char::from).collect())
    }
}
