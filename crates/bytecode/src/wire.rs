//! How the instruction table's types stand in a payload: instructions as their eight bytes, types
//! as one byte. Knows nothing of the rest of a module.

/// A code sequence as one run of bytes.
pub(crate) mod code {
    use obverse_isa::{INSTR_BYTES, Instr};
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(code: &[Instr], to: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = code.iter().flat_map(Instr::encode).collect();
        bytes.serialize(to)
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Vec<Instr>, D::Error> {
        let bytes = Vec::<u8>::deserialize(from)?;
        let (words, rest) = bytes.as_chunks::<INSTR_BYTES>();
        if !rest.is_empty() {
            return Err(D::Error::custom(format!(
                "the code is {} bytes, which is no multiple of {INSTR_BYTES}",
                bytes.len()
            )));
        }
        words
            .iter()
            .enumerate()
            .map(|(index, &word)| {
                Instr::decode(word)
                    .map_err(|error| D::Error::custom(format!("instruction {index}: {error}")))
            })
            .collect()
    }
}

/// A type as one byte.
pub(crate) mod value_type {
    use obverse_isa::Type;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(of_type: &Type, to: S) -> Result<S::Ok, S::Error> {
        (*of_type as u8).serialize(to)
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Type, D::Error> {
        let code = u8::deserialize(from)?;
        Type::ALL
            .get(usize::from(code))
            .copied()
            .ok_or_else(|| D::Error::custom(format!("no type has the code {code}")))
    }
}
