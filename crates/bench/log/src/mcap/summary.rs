//! The end of a file, where readers find its content without reading all of it.

use super::record::{Records, op};
use super::{Chunk, MAGIC};

/// What is remembered while a file is written: about 400 bytes per chunk.
#[derive(Debug)]
pub(crate) struct Summary {
    /// Number of messages of each channel.
    counts: Vec<u64>,
    schemas: u16,
    chunks: u32,
    /// Times of the first and the last message, ns.
    span_ns: Option<(u64, u64)>,
    chunk_indexes: Records,
    metadata_indexes: Records,
    metadata: u32,
}

impl Summary {
    pub(crate) fn new(channels: usize, schemas: usize) -> Self {
        Self {
            counts: vec![0; channels],
            schemas: u16::try_from(schemas).unwrap_or(u16::MAX),
            chunks: 0,
            span_ns: None,
            chunk_indexes: Records::default(),
            metadata_indexes: Records::default(),
            metadata: 0,
        }
    }

    /// Number of messages in finished chunks.
    pub(crate) fn messages(&self) -> u64 {
        self.counts.iter().sum()
    }

    pub(crate) fn add_metadata(&mut self, name: &str, offset: u64, length: u64) {
        self.metadata += 1;
        self.metadata_indexes.put(op::METADATA_INDEX, |r| {
            r.u64(offset);
            r.u64(length);
            r.string(name);
        });
    }

    /// Finishes a chunk into `out`, which begins at `offset` of the file.
    pub(crate) fn add_chunk(&mut self, chunk: &mut Chunk, offset: u64, out: &mut Records) {
        for (count, more) in self.counts.iter_mut().zip(chunk.counts()) {
            *count += more;
        }
        if let Some((earliest, latest)) = chunk.span_ns() {
            let (first, last) = self.span_ns.unwrap_or((earliest, latest));
            self.span_ns = Some((first.min(earliest), last.max(latest)));
        }
        self.chunks += 1;
        chunk.finish(offset, out, &mut self.chunk_indexes);
    }

    /// All bytes after the last chunk, which ends at `offset`. `checksum` is the checksum of the
    /// file so far; `declarations` repeat its schemas and channels.
    pub(crate) fn close(&self, offset: u64, checksum: u32, declarations: &[(u8, Records)]) -> Vec<u8> {
        let mut out = Records::default();
        out.put(op::DATA_END, |r| r.u32(checksum));
        let start = out.bytes.len();
        let position = |out: &Records| offset + out.bytes.len() as u64;
        let mut groups = Vec::new();
        let statistics = self.statistics();
        let rest = [
            (op::STATISTICS, &statistics),
            (op::CHUNK_INDEX, &self.chunk_indexes),
            (op::METADATA_INDEX, &self.metadata_indexes),
        ];
        for (kind, records) in declarations
            .iter()
            .map(|(kind, records)| (*kind, records))
            .chain(rest)
        {
            if !records.bytes.is_empty() {
                groups.push((kind, position(&out), records.bytes.len() as u64));
                out.bytes.extend(&records.bytes);
            }
        }
        let offsets_at = position(&out);
        for (kind, at, length) in groups {
            out.put(op::SUMMARY_OFFSET, |r| {
                r.bytes.push(kind);
                r.u64(at);
                r.u64(length);
            });
        }
        out.put(op::FOOTER, |r| {
            r.u64(offset + start as u64);
            r.u64(offsets_at);
            r.u32(0);
        });
        // The checksum covers the first fields of the footer itself.
        let end = out.bytes.len() - 4;
        let checksum = crc32fast::hash(&out.bytes[start..end]);
        out.bytes[end..].copy_from_slice(&checksum.to_le_bytes());
        out.bytes.extend(MAGIC);
        out.bytes
    }

    fn statistics(&self) -> Records {
        let mut out = Records::default();
        let (first_ns, last_ns) = self.span_ns.unwrap_or_default();
        out.put(op::STATISTICS, |r| {
            r.u64(self.messages());
            r.u16(self.schemas);
            r.u32(self.counts.len() as u32); // at most 2^16
            r.u32(0); // attachments
            r.u32(self.metadata);
            r.u32(self.chunks);
            r.u64(first_ns);
            r.u64(last_ns);
            r.sized(|r| {
                for (channel, count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                    r.u16(super::number(channel));
                    r.u64(*count);
                }
            });
        });
        out
    }
}
