"""Reads a log with the packages `mcap` and `mcap-ros2-support`, and prints what it finds as one
line of JSON.
"""

import json
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

counts, last = {}, {}
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    metadata = {record.name: record.metadata for record in reader.iter_metadata()}
    statistics, profile = reader.get_summary().statistics, reader.get_header().profile
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        counts[channel.topic] = counts.get(channel.topic, 0) + 1
        last[channel.topic] = (schema.name, message.log_time, decoded)


def plain(value):
    """Decoded messages as dictionaries."""
    if hasattr(value, "__slots__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__ if name.islower()}
    if isinstance(value, (bytes, list, tuple)) or hasattr(value, "tolist"):
        return [plain(element) for element in value]
    return None if value != value else value  # JSON has no NaN


json.dump(
    {
        "profile": profile,
        "messages": statistics.message_count,
        "provenance": metadata["twintac"]["provenance"],
        "counts": counts,
        "last": {topic: {"schema": s, "log_time": t, "data": plain(d)} for topic, (s, t, d) in last.items()},
    },
    sys.stdout,
)
