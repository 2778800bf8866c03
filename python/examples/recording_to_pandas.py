"""Reads presses from a CSV file, and finds the largest reading of each press with pandas."""

from pathlib import Path

from twintac import Recording

DATA = Path(__file__).parents[2] / "crates/app/twintac/examples/data"

recording = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")
frames = recording.to_pandas()
readings = [f"{taxel}_kpa" for taxel in recording.taxels]
print(frames.groupby("press")[readings].max().round(2))
print(f"{len(recording)} presses, {recording.provenance}")
