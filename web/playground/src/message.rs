//! Messages between the page and this library: a JSON object, and bytes behind it.

use anyhow::{Context, Result};
use serde::{Serialize, de::DeserializeOwned};

/// Bytes of the number before the object: the length of its text.
const LENGTH: usize = 4;

/// A message in bytes.
///
/// # Errors
/// When the object has no JSON text, or its text has more than 4 GiB.
pub fn packed(object: &impl Serialize, bytes: &[u8]) -> Result<Vec<u8>> {
    let text = serde_json::to_vec(object)?;
    let length = u32::try_from(text.len()).context("the text of a message is too long")?;
    Ok([&length.to_le_bytes(), &text[..], bytes].concat())
}

/// The object of a message, and the bytes behind it.
///
/// # Errors
/// When the message is damaged, or its object is of another kind.
pub fn unpacked<T: DeserializeOwned>(message: &[u8]) -> Result<(T, &[u8])> {
    let (length, rest) = message.split_first_chunk::<LENGTH>().context("a message has no length")?;
    let (text, bytes) = rest.split_at_checked(u32::from_le_bytes(*length) as usize).context("a message is shorter than it says")?;
    Ok((serde_json::from_slice(text).context("a message is not understood")?, bytes))
}

/// The answer to a request that has failed.
#[derive(Serialize)]
struct Failed<'a> {
    error: &'a str,
}

/// A message that says in the field `error` why a request has failed.
#[must_use]
pub fn failed(error: &str) -> Vec<u8> {
    packed(&Failed { error }, &[]).unwrap_or_default()
}
