"""Trains a twin on presses from a CSV file, and computes another press with it.

For your data, write a sensor description and an import description.
"""

from pathlib import Path

from twintac import Press, Run, Sensor, Twin

DATA = Path(__file__).parents[2] / "crates/app/twintac/examples/data"
COARSE = {  # and short; leave the settings out for a good twin
    "simulate": {"edges_per_height": 4.0, "edges_per_contact_radius": 4.0},
    "train": {"epochs": 40},
}

run = Run.start("runs/from-csv", Sensor.phystac(), "presses.csv", settings=COARSE)
run.import_csv(DATA / "import.toml", DATA / "presses.csv")
metrics = run.finish()
error_percent = metrics["twin"]["nearest_in_contact_percent"]
print(f"the twin errs by {error_percent:.1f} % on presses that it never saw, see {run.report_path}")

twin = Twin.load(run.model_folder)
predicted = twin.predict(Press("sphere-25", depth_mm=0.8, hold_s=0.5))
print(f"at full depth {predicted.readings_kpa.max(axis=0).round(2)} kPa, {predicted.provenance}")
