"""Barometric touch sensors and their digital twin.

Press a simulated gel, learn from recordings what a sensor's barometers make of the gel's pressure, and ask the trained twin what it would
read. Lengths are in mm, forces in N, pressures in kPa, times in s, angles in radians. The gel's frame has z up and z = 0 at the board;
presses go along -z. Numbers say where they come from: `"real"`, `"emulated"` or `"simulated"`.
"""

from twintac._error import Error
from twintac._progress import Progress
from twintac._twintac import (
    Body,
    Contact,
    Coupling,
    Dataset,
    FastBatch,
    FastGel,
    FastReader,
    Friction,
    Gel,
    Imperfection,
    Inverse,
    Pose,
    Prediction,
    Press,
    Pressed,
    PressureMap,
    Recording,
    Run,
    Sensor,
    SensorBatch,
    Shape,
    Tasks,
    Tracker,
    Twin,
    TwinAtPlace,
    TwinState,
)

__all__ = [
    "Body",
    "Contact",
    "Coupling",
    "Dataset",
    "Error",
    "FastBatch",
    "FastGel",
    "FastReader",
    "Friction",
    "Gel",
    "Imperfection",
    "Inverse",
    "Pose",
    "Prediction",
    "Press",
    "Pressed",
    "PressureMap",
    "Progress",
    "Recording",
    "Run",
    "Sensor",
    "SensorBatch",
    "Shape",
    "Tasks",
    "Tracker",
    "Twin",
    "TwinAtPlace",
    "TwinState",
]
