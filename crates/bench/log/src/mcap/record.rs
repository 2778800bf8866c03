//! Records that are appended to a buffer.

use std::collections::BTreeMap;

/// Kinds of records.
pub(crate) mod op {
    pub(crate) const HEADER: u8 = 0x01;
    pub(crate) const FOOTER: u8 = 0x02;
    pub(crate) const SCHEMA: u8 = 0x03;
    pub(crate) const CHANNEL: u8 = 0x04;
    pub(crate) const MESSAGE: u8 = 0x05;
    pub(crate) const CHUNK: u8 = 0x06;
    pub(crate) const MESSAGE_INDEX: u8 = 0x07;
    pub(crate) const CHUNK_INDEX: u8 = 0x08;
    pub(crate) const ATTACHMENT: u8 = 0x09;
    pub(crate) const STATISTICS: u8 = 0x0B;
    pub(crate) const METADATA: u8 = 0x0C;
    pub(crate) const METADATA_INDEX: u8 = 0x0D;
    pub(crate) const SUMMARY_OFFSET: u8 = 0x0E;
    pub(crate) const DATA_END: u8 = 0x0F;
}

/// A sequence of records.
#[derive(Clone, Debug, Default)]
pub(crate) struct Records {
    pub(crate) bytes: Vec<u8>,
}

impl Records {
    /// Appends a record. Its length is filled in after its content is written.
    pub(crate) fn put(&mut self, kind: u8, content: impl FnOnce(&mut Self)) {
        self.bytes.push(kind);
        let length_at = self.bytes.len();
        self.u64(0);
        content(self);
        let length = (self.bytes.len() - length_at - 8) as u64;
        self.bytes[length_at..length_at + 8].copy_from_slice(&length.to_le_bytes());
    }

    pub(crate) fn header(&mut self, profile: &str, library: &str) {
        self.put(op::HEADER, |r| {
            r.string(profile);
            r.string(library);
        });
    }

    pub(crate) fn schema(&mut self, id: u16, name: &str, encoding: &str, text: &str) {
        self.put(op::SCHEMA, |r| {
            r.u16(id);
            r.string(name);
            r.string(encoding);
            r.string(text);
        });
    }

    pub(crate) fn channel(
        &mut self,
        id: u16,
        schema: u16,
        topic: &str,
        encoding: &str,
        metadata: &BTreeMap<String, String>,
    ) {
        self.put(op::CHANNEL, |r| {
            r.u16(id);
            r.u16(schema);
            r.string(topic);
            r.string(encoding);
            r.map(metadata);
        });
    }

    pub(crate) fn metadata(&mut self, name: &str, metadata: &BTreeMap<String, String>) {
        self.put(op::METADATA, |r| {
            r.string(name);
            r.map(metadata);
        });
    }

    pub(crate) fn u16(&mut self, number: u16) {
        self.bytes.extend(number.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, number: u32) {
        self.bytes.extend(number.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, number: u64) {
        self.bytes.extend(number.to_le_bytes());
    }

    pub(crate) fn string(&mut self, text: &str) {
        self.sized(|r| r.bytes.extend(text.as_bytes()));
    }

    fn map(&mut self, map: &BTreeMap<String, String>) {
        self.sized(|r| {
            for (key, value) in map {
                r.string(key);
                r.string(value);
            }
        });
    }

    /// Four bytes of length, then content of this length.
    pub(crate) fn sized(&mut self, content: impl FnOnce(&mut Self)) {
        let length_at = self.bytes.len();
        self.u32(0);
        content(self);
        // No text or index here is near 4 GB. A longer one would be refused by readers.
        let length = u32::try_from(self.bytes.len() - length_at - 4).unwrap_or(u32::MAX);
        self.bytes[length_at..length_at + 4].copy_from_slice(&length.to_le_bytes());
    }
}
