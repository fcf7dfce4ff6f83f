//! Common Data Representation: how ROS 2 lays out a message, every number aligned to its size.

/// Reads a message from its start.
pub(super) struct Cdr<'a> {
    data: &'a [u8],
    at: usize,
    big: bool,
}

/// Entries of a sequence that are believed: more than any message of ours has.
const MOST: u32 = 1 << 20;

impl<'a> Cdr<'a> {
    /// After the four bytes that say how it is encoded.
    pub(super) fn new(message: &'a [u8]) -> Option<Self> {
        let (head, data) = message.split_first_chunk::<4>()?;
        // 0: big-endian, 1: little-endian; parameter lists and XCDR2 are none of ROS 2's.
        (head[0] == 0 && head[1] < 2).then_some(Self { data, at: 0, big: head[1] == 0 })
    }

    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let at = self.at.next_multiple_of(N);
        let bytes: [u8; N] = self.data.get(at..at + N)?.try_into().ok()?;
        self.at = at + N;
        Some(bytes)
    }

    pub(super) fn double(&mut self) -> Option<f64> {
        let b = self.bytes::<8>()?;
        Some(if self.big { f64::from_be_bytes(b) } else { f64::from_le_bytes(b) })
    }

    pub(super) fn doubles<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut out = [0.0; N];
        for slot in &mut out {
            *slot = self.double()?;
        }
        Some(out)
    }

    pub(super) fn float(&mut self) -> Option<f64> {
        let b = self.bytes::<4>()?;
        Some(f64::from(if self.big { f32::from_be_bytes(b) } else { f32::from_le_bytes(b) }))
    }

    pub(super) fn word(&mut self) -> Option<u32> {
        let b = self.bytes::<4>()?;
        Some(if self.big { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) })
    }

    /// Number of entries of a sequence.
    pub(super) fn length(&mut self) -> Option<u32> {
        self.word().filter(|n| *n <= MOST)
    }

    pub(super) fn text(&mut self) -> Option<String> {
        let length = self.word()? as usize;
        let bytes = self.data.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        // Its length counts a zero at the end.
        Some(String::from_utf8_lossy(bytes.strip_suffix(&[0]).unwrap_or(bytes)).into_owned())
    }

    pub(super) fn skip_doubles(&mut self, number: usize) -> Option<()> {
        (0..number).try_for_each(|_| self.double().map(drop))
    }

    /// `std_msgs/Header`: its stamp, s, and frame.
    pub(super) fn header(&mut self) -> Option<(f64, String)> {
        let (seconds, nanoseconds) = (self.word()? as i32, self.word()?);
        Some((f64::from(seconds) + 1e-9 * f64::from(nanoseconds), self.text()?))
    }
}
