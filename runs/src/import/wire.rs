//! Protobuf messages field by field, for schemas that are known by number.

use prost::encoding::{DecodeContext, WireType, decode_key, decode_varint, skip_field};

/// A field's value on the wire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wire<'a> {
    Varint(u64),
    Double(f64),
    Float(f32),
    Bytes(&'a [u8]),
}

impl Wire<'_> {
    pub(super) fn real(self) -> f64 {
        match self {
            Self::Varint(x) => x as f64,
            Self::Double(x) => x,
            Self::Float(x) => f64::from(x),
            Self::Bytes(_) => f64::NAN,
        }
    }
}

/// All fields of a message, in their order.
pub(super) fn fields(mut data: &[u8]) -> Result<Vec<(u32, Wire<'_>)>, String> {
    let mut out = Vec::new();
    let cut = || "a message is cut off".to_owned();
    while !data.is_empty() {
        let (number, wire) = decode_key(&mut data).map_err(|e| e.to_string())?;
        let value = match wire {
            WireType::Varint => Wire::Varint(decode_varint(&mut data).map_err(|e| e.to_string())?),
            WireType::SixtyFourBit => {
                let (bytes, rest) = data.split_first_chunk::<8>().ok_or_else(cut)?;
                data = rest;
                Wire::Double(f64::from_le_bytes(*bytes))
            }
            WireType::ThirtyTwoBit => {
                let (bytes, rest) = data.split_first_chunk::<4>().ok_or_else(cut)?;
                data = rest;
                Wire::Float(f32::from_le_bytes(*bytes))
            }
            WireType::LengthDelimited => {
                let length = decode_varint(&mut data).map_err(|e| e.to_string())?;
                let length = usize::try_from(length).map_err(|e| e.to_string())?;
                let (bytes, rest) = data.split_at_checked(length).ok_or_else(cut)?;
                data = rest;
                Wire::Bytes(bytes)
            }
            _ => {
                skip_field(wire, number, &mut data, DecodeContext::default()).map_err(|e| e.to_string())?;
                continue;
            }
        };
        out.push((number, value));
    }
    Ok(out)
}
