//! Reports of channels.

use crate::words::{count, counted};
use leafless::attribute::Channel;
use serde::Serialize;
use std::collections::BTreeMap;

/// A short description of a channel. The arrays of the channel are not read.
#[derive(Serialize)]
pub struct ChannelInfo {
    name: String,
    #[serde(rename = "type")]
    scalar: &'static str,
    components: usize,
    depth: u8,
    /// Number of stored values.
    values: u64,
    bytes: u64,
    metadata: BTreeMap<String, String>,
}

impl ChannelInfo {
    pub fn new(channel: &Channel) -> ChannelInfo {
        let facts = channel.metadata().iter().filter(|(key, _)| *key != "name");
        ChannelInfo {
            name: channel.name().into(),
            scalar: channel.value_type().scalar().name(),
            components: channel.value_type().components(),
            depth: channel.frame().depth(),
            values: channel.value_count(),
            bytes: channel.bytes(),
            metadata: facts.map(|(key, value)| (key.to_owned(), value.to_owned())).collect(),
        }
    }

    /// Returns the report for people, in one line.
    pub fn text(&self) -> String {
        let ChannelInfo { scalar, components, depth, bytes, .. } = self;
        let fact = |key: &str| self.metadata.get(key).map(|value| value.escape_debug().to_string());
        let meaning = fact("meaning").map_or_else(String::new, |meaning| format!(", {meaning}"));
        let unit = fact("unit").map_or_else(String::new, |unit| format!(" in {unit}"));
        format!(
            "{}{meaning}{unit}: {components} x {scalar}, depth {depth}, {}, {} bytes",
            self.name.escape_debug(),
            counted(self.values, "value", "values"),
            count(*bytes),
        )
    }
}
