"""Reads a trained twin with NumPy and safetensors alone, and compares what it reads with what the program wrote.

Usage: numpy_model.py RUN, the folder of a run whose twin is the paper's network. Prints the largest difference over the largest reading.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from safetensors.numpy import load_file

run = Path(sys.argv[1])
weights = load_file(run / "training/held-out/weights.safetensors")
normal = json.loads((run / "training/held-out/twin.json").read_text())["start"]["normalization"]
presses = {press["name"]: press for press in json.loads((run / "pairs/paired.json").read_text())}
evaluation = json.loads((run / "evaluation/evaluation.json").read_text())["evaluation"]
error_function = np.vectorize(math.erf)


def read(features):
    """Readings of a press, kPa, from the stress feature, kPa/mm; `[n_frames, n_taxels]`."""
    stress = np.array(features["stress_kpa_per_mm"])
    rows = (stress - normal["stress_mean_kpa_per_mm"]) / normal["stress_deviation_kpa_per_mm"]
    n_layers = sum(name.endswith(".weight") for name in weights)
    for layer in range(n_layers):
        rows = rows @ weights[f"layer{layer}.weight"] + weights[f"layer{layer}.bias"]
        if layer + 1 < n_layers:
            rows = 0.5 * rows * (1.0 + error_function(rows / math.sqrt(2.0)))
    readings = rows * normal["reading_kpa"]
    zero = features["zero_frames"]
    if zero["end"] > zero["start"]:
        readings = readings - readings[zero["start"] : zero["end"]].mean(axis=0)
    return readings


worst, largest = 0.0, 0.0
for press in evaluation["presses"]:
    predicted = np.array(press["predicted_kpa"])
    worst = max(worst, np.abs(read(presses[press["name"]]["features"]) - predicted).max())
    largest = max(largest, np.abs(predicted).max())
assert largest > 0.1, largest
print(worst / largest)
