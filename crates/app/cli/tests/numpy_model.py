"""Evaluates a trained twin with NumPy and safetensors alone, and compares the readings with those
that the program wrote.

Usage: numpy_model.py RUN, the folder of a run whose twin is the paper's network or a twin with port
pressures. Prints the largest difference, divided by the largest reading.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from safetensors.numpy import load_file

run = Path(sys.argv[1])
weights = {
    name: array.astype(float)
    for name, array in load_file(run / "training/held-out/weights.safetensors").items()
}
twin = json.loads((run / "training/held-out/twin.json").read_text())
start = twin["start"]
normal = start["normalization"]
presses = {press["name"]: press for press in json.loads((run / "pairs/paired.json").read_text())}
evaluation = json.loads((run / "evaluation/evaluation.json").read_text())["evaluation"]
error_function = np.vectorize(math.erf)


def perceptron(rows):
    """A perceptron with GELU between the layers, and no activation after the last one."""
    n_layers = sum(name.endswith(".weight") for name in weights)
    for layer in range(n_layers):
        rows = rows @ weights[f"layer{layer}.weight"] + weights[f"layer{layer}.bias"]
        if layer + 1 < n_layers:
            rows = 0.5 * rows * (1.0 + error_function(rows / math.sqrt(2.0)))
    return rows


def paper(features):
    """Readings of the paper's network, kPa, from the stress feature, kPa/mm;
    `[n_frames, n_taxels]`.
    """
    stress = np.array(features["stress_kpa_per_mm"])
    rows = (stress - normal["stress_mean_kpa_per_mm"]) / normal["stress_deviation_kpa_per_mm"]
    return perceptron(rows) * normal["reading_kpa"]


def ports(features):
    """Readings, kPa, from the pressure at each port, kPa; `[n_frames, n_taxels]`."""
    rows = np.array(features["pressure_kpa"]) / normal["pressure_rms_kpa"]
    gain = np.array(start["gains"]["gain"]) * normal["pressure_rms_kpa"] / normal["reading_kpa"]
    elastic = rows * gain * np.exp(weights["gain_change"])
    if "layer0.weight" in weights:
        size = np.sqrt((elastic**2).sum(axis=1, keepdims=True) + 1e-8)
        elastic = elastic + size * start["correction_limit"] * np.tanh(perceptron(rows))
    elastic = elastic * normal["reading_kpa"]

    # The static nonlinearity of the port: the reading grows faster (s > 0) or slower (s < 0) than
    # in proportion to the pressure; in tension it is proportional.
    s = np.array(start["gains"]["stiffening_per_kpa"])
    pushed = np.maximum(elastic, 0.0)
    law = np.where(s >= 0, pushed * (1 + s * pushed), pushed / (1 - np.minimum(s, 0.0) * pushed))
    relaxed = law + np.minimum(elastic, 0.0)

    # Viscoelastic relaxation: overstresses that follow each change and decay, each with its share
    # in the reading.
    share = np.maximum(np.array(start["gains"]["memory"]).T, 1e-3)
    share = np.log1p(np.exp(np.log(np.expm1(share)) + weights["memory_change"]))
    readings = relaxed.copy()
    time_s = np.array(features["time_s"])
    for constant_s, of_taxels in zip(start["gains"]["time_constants_s"], share):
        overstress = np.zeros(relaxed.shape[1])
        for frame in range(1, len(time_s)):
            ratio = (time_s[frame] - time_s[frame - 1]) / constant_s
            change = relaxed[frame] - relaxed[frame - 1]
            overstress = np.exp(-ratio) * overstress - np.expm1(-ratio) / ratio * change
            readings[frame] += of_taxels * overstress
    return readings


def read(features):
    """Readings above those of the non-contact frames, kPa; `[n_frames, n_taxels]`."""
    assert features["since_previous_s"] is None, "the gel rested before each press"
    readings = paper(features) if twin["variant"] == "paper" else ports(features)
    zero = features["zero_frames"]
    if zero["end"] > zero["start"]:
        readings = readings - readings[zero["start"] : zero["end"]].mean(axis=0)
    return readings


learned = [name for name, array in weights.items() if np.any(array)]
assert "layer2.weight" in learned, "the perceptron has learned nothing: the comparison would say nothing of it"

worst, largest = 0.0, 0.0
for press in evaluation["presses"]:
    predicted = np.array(press["predicted_kpa"])
    worst = max(worst, np.abs(read(presses[press["name"]]["features"]) - predicted).max())
    largest = max(largest, np.abs(predicted).max())
assert largest > 0.1, largest
print(worst / largest)
