//! Which field of a message is which column, and its value on the wire.

use prost::Message;
use prost::encoding::{DecodeContext, WireType, decode_key, decode_varint, skip_field};
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::{Label, Type};

use super::records::{Channel, Schema};
use crate::columns::Column;

/// A number of a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    Real(f64),
    Whole(i64),
}

impl Value {
    pub(crate) fn real(self) -> f64 {
        match self {
            Self::Real(x) => x,
            Self::Whole(x) => x as f64,
        }
    }

    /// A count; beyond 2^53 a floating-point number no longer says which.
    pub(super) fn count(self) -> Option<i64> {
        match self {
            Self::Whole(x) => Some(x),
            Self::Real(x) => (x.fract() == 0.0 && x.abs() <= 9.007_199_254_740_992e15).then_some(x as i64),
        }
    }
}

/// How the messages of a topic are read.
#[derive(Debug)]
pub(crate) enum Topic {
    /// Field number, type and column.
    Protobuf(Vec<(u32, Type, Column)>),
    /// Objects whose keys are columns.
    Json,
    /// Nothing that we know.
    Foreign,
}

impl Topic {
    /// Says why a topic that claims to be readable is not.
    pub(crate) fn of(channel: &Channel, schema: Option<&Schema>) -> Result<Self, String> {
        match channel.message_encoding.as_str() {
            "json" => Ok(Self::Json),
            "protobuf" => {
                let Some(schema) = schema else { return Ok(Self::Foreign) };
                let set = FileDescriptorSet::decode(&schema.data[..])
                    .map_err(|e| format!("the schema {:?} is no file descriptor set: {e}", schema.name))?;
                Ok(columns_of(&set, &schema.name).map_or(Self::Foreign, Self::Protobuf))
            }
            _ => Ok(Self::Foreign),
        }
    }

    /// Whether a topic can hold ticks, not camera poses alone.
    pub(crate) fn has_tick(columns: &[Column]) -> bool {
        columns.iter().any(|c| !matches!(c, Column::Time | Column::Camera(_) | Column::Other))
    }

    /// The numbers of a message.
    pub(crate) fn decode(&self, data: &[u8], values: &mut Vec<(Column, Value)>) -> Result<(), String> {
        values.clear();
        match self {
            Self::Foreign => Ok(()),
            Self::Json => json(data, values),
            Self::Protobuf(fields) => protobuf(fields, data, values).map_err(|e| e.to_string()),
        }
    }
}

/// Nothing where the message has none of our columns.
fn columns_of(set: &FileDescriptorSet, name: &str) -> Option<Vec<(u32, Type, Column)>> {
    let message = set.file.iter().find_map(|file| {
        let package = file.package.as_deref().filter(|p| !p.is_empty()).map_or_else(String::new, |p| format!("{p}."));
        file.message_type.iter().find(|m| m.name.as_ref().is_some_and(|m| format!("{package}{m}") == name))
    })?;
    let fields = message.field.iter().filter(|f| f.label() != Label::Repeated).filter_map(|field| {
        let column = Column::from_name(field.name());
        let number = u32::try_from(field.number()).ok()?;
        (column != Column::Other && is_number(field.r#type())).then_some((number, field.r#type(), column))
    });
    Some(fields.collect::<Vec<_>>()).filter(|fields| !fields.is_empty())
}

fn is_number(kind: Type) -> bool {
    !matches!(kind, Type::Bool | Type::String | Type::Group | Type::Message | Type::Bytes | Type::Enum)
}

fn protobuf(
    fields: &[(u32, Type, Column)],
    mut data: &[u8],
    values: &mut Vec<(Column, Value)>,
) -> Result<(), prost::DecodeError> {
    while !data.is_empty() {
        let (number, wire) = decode_key(&mut data)?;
        let known = fields.iter().find(|(n, ..)| *n == number);
        match known.and_then(|(_, kind, column)| Some((*column, wire_value(*kind, wire, &mut data)?))) {
            Some((column, value)) => values.push((column, value?)),
            None => skip_field(wire, number, &mut data, DecodeContext::default())?,
        }
    }
    Ok(())
}

/// Nothing where the wire holds another type than the schema says; the field is then skipped.
fn wire_value(kind: Type, wire: WireType, data: &mut &[u8]) -> Option<Result<Value, prost::DecodeError>> {
    match wire {
        WireType::Varint => {
            let whole: fn(u64) -> i64 = match kind {
                Type::Sint32 | Type::Sint64 => |v| ((v >> 1) as i64) ^ -((v & 1) as i64),
                Type::Int32 | Type::Int64 | Type::Uint64 => |v| v as i64,
                Type::Uint32 => |v| i64::from(v as u32),
                _ => return None,
            };
            Some(decode_varint(data).map(|v| Value::Whole(whole(v))))
        }
        WireType::SixtyFourBit => {
            let (bytes, rest) = data.split_first_chunk::<8>()?;
            let value = match kind {
                Type::Double => Value::Real(f64::from_le_bytes(*bytes)),
                Type::Fixed64 | Type::Sfixed64 => Value::Whole(i64::from_le_bytes(*bytes)),
                _ => return None,
            };
            *data = rest;
            Some(Ok(value))
        }
        WireType::ThirtyTwoBit => {
            let (bytes, rest) = data.split_first_chunk::<4>()?;
            let value = match kind {
                Type::Float => Value::Real(f64::from(f32::from_le_bytes(*bytes))),
                Type::Fixed32 => Value::Whole(i64::from(u32::from_le_bytes(*bytes))),
                Type::Sfixed32 => Value::Whole(i64::from(i32::from_le_bytes(*bytes))),
                _ => return None,
            };
            *data = rest;
            Some(Ok(value))
        }
        _ => None,
    }
}

fn json(data: &[u8], values: &mut Vec<(Column, Value)>) -> Result<(), String> {
    let object: serde_json::Map<String, serde_json::Value> =
        serde_json::from_slice(data).map_err(|e| format!("is no JSON object: {e}"))?;
    for (name, value) in &object {
        let column = Column::from_name(name);
        let value = value.as_i64().map(Value::Whole).or_else(|| value.as_f64().map(Value::Real));
        if let Some(value) = value.filter(|_| column != Column::Other) {
            values.push((column, value));
        }
    }
    Ok(())
}
