//! What is told of a channel, and how one is found.

use crate::failure::Failure;
use crate::source::input::Input;
use crate::words::{count, counted};
use leafless::{Channel, Octree};
use serde::Serialize;
use std::collections::BTreeMap;

/// A channel in a few words. Nothing of its arrays is read.
#[derive(Serialize)]
pub struct ChannelInfo {
    name: String,
    #[serde(rename = "type")]
    scalar: &'static str,
    components: usize,
    depth: u8,
    /// Values that are stored.
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

    /// The same for people, on one line.
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

/// The channel of a solid that the user names; without a name, the only one.
pub fn find<'o>(octree: &'o Octree, input: &Input, name: Option<&str>) -> Result<&'o Channel, Failure> {
    let known: Vec<&str> = octree.channels().iter().map(Channel::name).collect();
    let list = known.join(", ");
    match (name, octree.channels()) {
        (_, []) => Err(Failure::of(input, "has no channel; `leafless attribute` makes one")),
        (None, [only]) => Ok(only),
        (None, _) => {
            Err(Failure::Usage(format!("{input} has several channels: name one of them with --name: {list}")))
        }
        (Some(name), _) => octree
            .channel(name)
            .ok_or_else(|| Failure::of(input, format!("has no channel \"{name}\". It has {list}"))),
    }
}
