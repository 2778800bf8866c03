from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, Final, Literal, SupportsIndex, TypeAlias, final

import numpy as np
import numpy.typing as npt
import pandas
import polars
from matplotlib.axes import Axes

from twintac._progress import Progress

__all__ = [
    "Body",
    "Contact",
    "Coupling",
    "Dataset",
    "FastBatch",
    "FastGel",
    "FastReader",
    "FloorMap",
    "Followed",
    "Friction",
    "Gel",
    "GelState",
    "Imperfection",
    "Inverse",
    "Pose",
    "Prediction",
    "Press",
    "PressPath",
    "Pressed",
    "PressureMap",
    "Reader",
    "Reading",
    "ReadingTable",
    "Recording",
    "Run",
    "Sensor",
    "SensorBatch",
    "SensorState",
    "Shape",
    "Tasks",
    "Tracker",
    "Twin",
    "TwinAtPlace",
    "TwinState",
    "__version__",
    "_restored",
    "command",
]

_Path: TypeAlias = str | PathLike[str]
_Provenance: TypeAlias = Literal["real", "emulated", "simulated"]
_Simulated: TypeAlias = Literal["simulated"]
_Float: TypeAlias = npt.NDArray[np.float64]
_Single: TypeAlias = npt.NDArray[np.float32]
_Bool: TypeAlias = npt.NDArray[np.bool_]
_Floats: TypeAlias = npt.ArrayLike
_Integers: TypeAlias = npt.ArrayLike
_Number: TypeAlias = float | np.floating[Any] | np.integer[Any]
_Count: TypeAlias = SupportsIndex

__version__: Final[str]

@final
class Sensor:
    """A sensor as its description says: gel, taxels, and the indenters that it can be pressed with.

    `Sensor.phystac()` and `Sensor.phystac_tip()` are built in; `Sensor.load` reads the description of any other.
    """
    @staticmethod
    def phystac() -> Sensor:
        """PhysTac: eight barometers under a flat gel of 34 × 18 × 8.5 mm."""
    @staticmethod
    def phystac_tip() -> Sensor:
        """PhysTac's fingertip: eight barometers under a dome, 19.2 mm high."""
    @staticmethod
    def load(path: _Path) -> Sensor:
        """Reads a description (TOML).

        Raises `Error` with file, line and field if the description is wrong, and with the file if it cannot be read.
        """
    @property
    def name(self) -> str:
        """Its name, as the description has it."""
    @property
    def taxels(self) -> list[str]:
        """Names of its taxels, in the order of every row of readings."""
    @property
    def taxel_positions_mm(self) -> _Float:
        """Centres of the taxels' ports in the gel's frame, mm; `[n_taxels, 3]`."""
    @property
    def bounds_mm(self) -> _Float:
        """Lowest and highest corner of the box that holds the gel, in the gel's frame, mm; `[2, 3]`."""
    @property
    def indenters(self) -> list[str]:
        """Names of the indenters that it can be pressed with: those that `Press` takes."""
    @property
    def rate_hz(self) -> float:
        """Frames that it gives in a second, Hz."""
    def describe(self) -> str:
        """All that the description says, with units, as a text for people."""

@final
class Press:
    """A straight press: down to a depth, a hold, and back up.

    - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
    - `at_mm`: place of the indenter's origin in the gel's plane, mm; the middle of the gel unless given.
    - `depth_mm`: depth below first touch, mm, above 0.
    - `spin_rad`: turn of the indenter about the axis of the press, radians.
    - `speed_mm_per_s`: speed down and up, mm/s, 0.001 or more.
    - `hold_s`: time at full depth, s, an hour at most.

    Raises `Error`, whose `field` is the argument that cannot be. Whether the sensor has the indenter is seen when it presses.
    """
    def __new__(
        cls,
        indenter: str,
        *,
        at_mm: _Floats = (0.0, 0.0),
        depth_mm: float = 1.0,
        spin_rad: float = 0.0,
        speed_mm_per_s: float = 2.0,
        hold_s: float = 0.0,
    ) -> Press: ...
    @property
    def indenter(self) -> str:
        """Name of one of the sensor's indenters."""
    @property
    def at_mm(self) -> tuple[float, float]:
        """Place of the indenter's origin in the gel's plane, x and y, mm."""
    @property
    def depth_mm(self) -> float:
        """Depth below first touch, mm."""
    @property
    def spin_rad(self) -> float:
        """Turn of the indenter about the axis of the press, radians."""
    @property
    def speed_mm_per_s(self) -> float:
        """Speed down and up, mm/s."""
    @property
    def hold_s(self) -> float:
        """Time at full depth, s."""
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Gel:
    """The gel of a sensor, ready to be pressed: a finite-element model with the material of the description.

    `settings` are those of the simulation that differ from the usual ones for single presses: `{"edges_per_height": 4.0}`. More edges take longer and
    err less. Raises `Error`, whose `field` is the setting that cannot be.
    """
    def __new__(cls, sensor: Sensor, settings: dict[str, Any] | None = None) -> Gel: ...
    def press(self, press: Press) -> Pressed:
        """Presses the gel down to the depth of the press, which takes about a second. A gel whose material relaxes does so at the speed of the press. Ctrl-C ends the wait.

        Raises `Error` for an indenter that the sensor does not have, a place beside the gel, and a depth at which the solver finds no equilibrium.
        """
    def touch(self, indenter: str, above: Pose) -> Pose:
        """Where an indenter, lowered from a pose in the gel's frame whose height is ignored, first touches the undeformed gel.

        Raises `Error` for an indenter that the sensor does not have, and a place beside the gel.
        """
    def state(self, indenter: str, poses: Sequence[Pose], *, deadline_ms: float | None = None) -> GelState:
        """The gel before an indenter presses it, to be taken from pose to pose as they come. `poses`, in the gel's frame, are those between which it will go, at least one: the mesh
        is fine along the straight ways between them, and for the deepest of them. Takes about a second; Ctrl-C ends the wait.

        With `deadline_ms`, 1 to 60000, each frame is answered within so many milliseconds of wall time with what is found by then: `GelState.converged` says whether its forces
        are balanced, `GelState.residual` how nearly. Frames with a `force_n` take the time that they need. Such readings are not reproducible.

        Raises `Error` for an indenter that the sensor does not have, a first pose beside the gel, and a deadline out of its range.
        """
    def follow(self, path: PressPath, *, progress: Progress = None) -> Followed:
        """Takes an indenter along a path, frame by frame; each takes from some milliseconds to seconds. Ctrl-C ends it before its next frame. A path that cannot be followed
        to its end is no error: `Followed.failure` says why the frames end early.

        Raises `Error` for an indenter that the sensor does not have, a first pose beside the gel, and a point outside the gel or with the name of a taxel.
        """

@final
class GelState:
    """A gel that one indenter presses, frame by frame: pushed, slid and turned as poses come. What `Gel.state` returns. It keeps how it is deformed, what its material
    remembers, and where friction holds it.
    """
    @property
    def provenance(self) -> _Simulated:
        """What every number is: simulated."""
    def step(self, since_previous_s: float, gel_from_indenter: Pose, *, force_n: float | None = None) -> _Float:
        """One more frame, `since_previous_s` after the last: the indenter goes straight to a pose in the gel's frame (`gel_from_indenter`). With `force_n`, N, above 0, it then
        goes down or up, by at most the gel's height, until it presses straight down with that force. The first frame takes no notice of the time.

        Returns the hydrostatic pressure in the gel over each taxel's port, kPa; `[n_taxels]`. Small steps take milliseconds on a gel of few nodes
        (`Gel(sensor, {"max_path_nodes": 4000})`), long ones on a fine gel seconds. Ctrl-C ends the wait; the step is made all the same.

        Raises `Error` if the solver finds no equilibrium: the gel is then as it was before, and smaller steps may do; for a time below 0, and for a force that is not
        above 0, is not met, or is more than the sensor stands (`limits.force_n` of its description).
        """
    @property
    def gel_from_indenter(self) -> Pose | None:
        """Where the indenter is, in the gel's frame; `None` before the first frame."""
    @property
    def depth_mm(self) -> float | None:
        """How far the indenter is below where, at the place and turn of the first of the poses that `Gel.state` was given, it first touches the gel, mm; `None` before the
        first frame.
        """
    @property
    def converged(self) -> bool | None:
        """Whether the forces at the last frame are balanced: they are, unless `Gel.state` was given a `deadline_ms` that came first. `None` before the first frame."""
    @property
    def residual(self) -> float | None:
        """What part of the load is unbalanced at the last frame; `None` before the first."""
    @property
    def force_n(self) -> _Float:
        """Force of the indenter on the gel at the last frame, in the gel's frame, N; `[3]`. A press straight down has a negative z. Zero before the first frame."""
    @property
    def torque_n_mm(self) -> _Float:
        """Torque of the indenter on the gel about the indenter's origin at the last frame, in the gel's frame, N mm; `[3]`. Zero before the first frame."""
    def rest(self) -> None:
        """Takes the indenter away: the gel is as it was before the first frame, and remembers nothing."""

@final
class PressPath:
    """A path of an indenter over and into a gel, through poses or to forces: down, aside, tilted, and up again. Between its poses the indenter moves evenly.

    - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
    - `time_s`: when it is at each pose, s, increasing; `[n_poses]`.
    - `gel_from_indenter`: its poses in the gel's frame: place of its origin, mm, and quaternion (x, y, z, w), `[n_poses, 7]`; or the place alone, `[n_poses, 3]`.
    - `zero`: where heights are counted from: the `"board"`, or `"touch"`, where the indenter first touches at the place and turn of the first pose.
    - `rate_hz`: frames in a second between the poses, Hz; without it, the poses themselves are the frames.
    - `force_n`: the force straight down, N, above 0, with which the indenter presses at each pose: it goes down or up from there until it does. NaN where it stays
      at the pose; `[n_poses]`.

    Raises `Error`, whose `field` is what cannot be.
    """
    def __new__(
        cls,
        indenter: str,
        time_s: _Floats,
        gel_from_indenter: _Floats,
        *,
        zero: Literal["board", "touch"] = "board",
        rate_hz: float | None = None,
        force_n: _Floats | None = None,
    ) -> PressPath: ...
    @staticmethod
    def load(path: _Path) -> PressPath:
        """Reads a path (TOML), as `twintac simulate --path` does. It may also have points in the gel at which the pressure is read, and another direction of forces.

        Raises `Error` with file, line and field if it is wrong, and with the file if it cannot be read.
        """
    @property
    def indenter(self) -> str:
        """Name of the indenter."""
    @property
    def time_s(self) -> _Float:
        """Time of each frame, s; `[n_frames]`."""

@final
class Followed:
    """What a gel does along a path: what `Gel.follow` returns. Every array has a row for each frame, up to the last good one."""
    @property
    def provenance(self) -> _Simulated:
        """What every number here is: simulated."""
    @property
    def failure(self) -> str | None:
        """Why the frames end before the path does; `None` if they do not."""
    @property
    def time_s(self) -> _Float:
        """Time, s; `[n_frames]`."""
    @property
    def position_mm(self) -> _Float:
        """The indenter's origin in the gel's frame, mm; `[n_frames, 3]`."""
    @property
    def depth_mm(self) -> _Float:
        """How far the indenter is below where, at the place and turn of the first pose, it first touches the gel, mm; `[n_frames]`."""
    @property
    def force_n(self) -> _Float:
        """Force of the indenter on the gel, in the gel's frame, N; `[n_frames, 3]`. A press straight down has a negative z."""
    @property
    def torque_n_mm(self) -> _Float:
        """Torque of the indenter on the gel about the indenter's origin, in the gel's frame, N mm; `[n_frames, 3]`."""
    @property
    def readings_kpa(self) -> _Float:
        """Hydrostatic pressure in the gel over each taxel's port, kPa; `[n_frames, n_taxels]`."""
    @property
    def points_kpa(self) -> dict[str, _Float]:
        """Hydrostatic pressure at each point of the path's file, by name, kPa; `[n_frames]` each."""
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings, force and place over time.

        With Matplotlib; its three axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for another number of axes.
        """
    def __len__(self) -> int: ...

@final
class Pressed:
    """A simulated press, from first touch to full depth: what `Gel.press` returns. Each frame is deeper than the one before."""
    @property
    def provenance(self) -> _Simulated:
        """What every number here is: simulated."""
    @property
    def depth_mm(self) -> _Float:
        """Depth below first touch, mm; `[n_frames]`. The first frame is the untouched gel."""
    @property
    def force_n(self) -> _Float:
        """Force of the indenter into the gel, N; `[n_frames]`."""
    @property
    def readings_kpa(self) -> _Float:
        """Hydrostatic pressure in the gel over each taxel's port, kPa; `[n_frames, n_taxels]`. A barometer there would read this if it followed
        the gel without gain, delay and creep; what a real one makes of it, a trained `Twin` tells.
        """
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings and force over depth.

        With Matplotlib; its two axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for another number of axes.
        """

@final
class PressureMap:
    """A continuous map over the gel of what a few taxels read: 96 columns and 64 rows, interpolated between the taxels. A notebook shows its picture.

    - `readings_kpa`: readings of the sensor above its unloaded baseline, kPa; `[n_taxels]`. A taxel whose reading is NaN or masked is left out: the map is that of the other
      taxels, and NaN everywhere if there is none.
    - `provenance`: where they come from: `"real"`, `"emulated"` or `"simulated"`.

    Raises `Error` for another number of readings than the sensor has taxels, and for one that is infinite.
    """
    def __new__(cls, sensor: Sensor, readings_kpa: _Floats, provenance: _Provenance) -> PressureMap: ...
    @property
    def provenance(self) -> _Provenance:
        """Where the readings come from: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def pressure_kpa(self) -> _Float:
        """Pressure above the baseline, kPa; `[n_rows, n_columns]`, the row of smallest y first. The grid spans the box that holds the gel (`Sensor.bounds_mm`)."""
    @property
    def missing(self) -> list[str]:
        """Names of the taxels without a reading: the map was made without them."""
    def _repr_svg_(self) -> str:
        """The picture that a notebook shows: the text of an SVG file."""
    def save(self, path: _Path) -> None:
        """Draws the map, with the taxels that have a reading marked, into a file: `.svg` or `.png`.

        Raises `Error` for a name with another ending, and for a file that cannot be written.
        """
    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the map in the gel's plane, with a scale in kPa.

        With Matplotlib; its axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it.
        """

@final
class Reader:
    """Reads a sensor frame by frame: on an I²C bus of Linux (`Reader.open`), over a serial port (`Reader.serial`), from datagrams (`Reader.udp`), out of a log
    (`Reader.replay`), or an emulated one (`Reader.emulated`).

    It reads on a thread of its own, from when it is made until `close` or the end of a `with` block. Iterating gives a `Reading` for each frame, as they come; up to 256
    frames wait for whom is late, more are missed. Other threads run meanwhile, and Ctrl-C ends the wait for a frame.
    """
    @staticmethod
    def open(bus: _Path, sensor: Sensor, *, counts_per_pa: _Count | None = None) -> Reader:
        """Reads the sensor on a bus such as `/dev/i2c-1`, which nothing may touch meanwhile: the first frames make the tare. `counts_per_pa` is the scale of its barometers,
        confirmed by who knows the parts; the description's unless given. Takes half a second; Ctrl-C ends the wait.

        Raises `Error` for a bus that cannot be opened, and a sensor that does not answer, does not read free air, or whose scale nobody has confirmed.
        """
    @staticmethod
    def serial(port: str, line: _Path, sensor: Sensor) -> Reader:
        """Reads the frames that a microcontroller writes to a serial port such as `/dev/ttyACM0` or `COM3`. `line` is a file (TOML) that says how frames stand on the
        line. Nothing may touch the sensor meanwhile: the first frames make the tare.

        Raises `Error` for a port that cannot be opened, a description that is wrong or of another number of taxels, and a line on which no frame comes for 3 s; the
        message says what came instead.
        """
    @staticmethod
    def udp(address: str, line: _Path, sensor: Sensor) -> Reader:
        """Reads frames that come as datagrams (UDP) to an address of this computer, such as `"0.0.0.0:9000"`. `line` is a file (TOML) that says how frames stand in them.

        Raises `Error` as `serial` does.
        """
    @staticmethod
    def replay(log: _Path, sensor: Sensor) -> Reader:
        """Plays the frames of a log (MCAP) at their own pace; they are what the log says: `"real"` or `"emulated"`. After the last one `read` raises `Error`.

        Raises `Error` for a log that cannot be read, has no frames, or is of other taxels than the sensor's.
        """
    @staticmethod
    def emulated(sensor: Sensor) -> Reader:
        """Reads an emulated sensor in real time: registers on an emulated bus, pressed by a ball that wanders about. Takes half a second; Ctrl-C ends the wait.

        Raises `Error` for a sensor whose description does not say how its taxels are wired.
        """
    @property
    def provenance(self) -> Literal["real", "emulated"]:
        """Where the readings come from: `"real"` or `"emulated"`."""
    @property
    def taxels(self) -> list[str]:
        """Names of the taxels, in the order of every reading."""
    @property
    def notes(self) -> list[str]:
        """What was odd when the sensor was switched on, a sentence each."""
    def remarks(self) -> list[str]:
        """What was on the wire so far besides frames, and how often: torn lines, missing frames. Empty if all was well, and of a reader that is closed."""
    def compensate(self, temperature: _Path) -> None:
        """Takes off readings what temperature does to the zeros, as a file says (TOML) that `twintac characterize` made. Nothing may touch the sensor meanwhile: the next
        frames make a new tare.

        Raises `Error` for a file that is wrong, or of another sensor, and for a reader that is closed.
        """
    def warmer_k(self) -> float | None:
        """How much warmer than at the tare the chip is that changed most, K; below zero if it is colder; `None` without temperatures, and of a reader that is closed. Zeros
        move with it.
        """
    def read(self) -> Reading:
        """The next frame.

        Raises `Error` for a sensor that has failed for 2 s on end or was silent for 3 s, and for a reader that is closed.
        """
    def close(self) -> None:
        """Ends the reading, within a second also where the bus hangs. What is closed is not read again; closing it once more does nothing."""
    def __iter__(self) -> Reader: ...
    def __next__(self) -> Reading: ...
    def __enter__(self) -> Reader:
        """The reader itself."""
    def __exit__(self, *_error: object) -> None:
        """Ends the reading."""

@final
class Reading:
    """A frame of a sensor: what `Reader.read` returns."""
    @property
    def provenance(self) -> Literal["real", "emulated"]:
        """Where the readings come from: `"real"` or `"emulated"`."""
    @property
    def sequence(self) -> int:
        """Its number, from 0, of all frames that were asked of the sensor: numbers that are missing were missed, or the bus gave none. The first ones made the tare."""
    @property
    def time_s(self) -> float:
        """When the taxels were triggered, s since the sensor was switched on."""
    @property
    def readings_kpa(self) -> _Float:
        """Readings above what the taxels read untouched, kPa, `[n_taxels]`; NaN of a taxel that gives no usable one."""
    @property
    def is_valid(self) -> _Bool:
        """Whether each taxel's reading can be used; `[n_taxels]`."""
    @property
    def faults(self) -> list[str | None]:
        """Why a taxel's reading cannot be used, in a word or two, `[n_taxels]`; `None` of a taxel that works."""
    @property
    def temperatures_c(self) -> _Float:
        """Temperatures of the barometers, °C, `[n_taxels]`; NaN of one that gives none."""

@final
class Recording:
    """Recorded presses of one sensor: of a real one, of an emulated one, or simulated. `len()` is the number of presses."""
    @staticmethod
    def load(path: _Path) -> Recording:
        """Reads a Parquet file, as runs and `save` write it. Ctrl-C ends the wait.

        Raises `Error` with the file if it is no recording, is damaged, or cannot be read.
        """
    @staticmethod
    def import_csv(description: _Path, *paths: _Path) -> Recording:
        """Reads CSV files of any laboratory. The description (TOML, see the folder `imports`) says which column is what, in which unit. Ctrl-C ends the wait.

        Raises `Error` with file, line and field: of the description, or of the cell that cannot be read.
        """
    @staticmethod
    def guess_import(path: _Path) -> str:
        """A first description of a CSV file's columns, for `import_csv`: the text of a TOML file with a comment on each guess.

        Raises `Error` with the file if it cannot be read or has no rows of numbers.
        """
    @property
    def imported(self) -> list[dict[str, Any]]:
        """What `import_csv` found in each file and left out of it, a dict for each: `file`, `rows_read`, `rows_dropped`, `rows_incomplete`, `missing_readings`,
        `clipped_readings`, `outliers`, `presses`, `presses_dropped`, `shared_frames`, `unread_columns`, `warnings`. Empty for recordings from elsewhere.
        """
    @property
    def sensor(self) -> str:
        """Name of the sensor, as its description has it."""
    @property
    def provenance(self) -> _Provenance:
        """Where the numbers come from: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def taxels(self) -> list[str]:
        """Names of the taxels, in the order of every row of readings."""
    @property
    def presses(self) -> list[str]:
        """Names of the presses, in the order in which they were made."""
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """A NumPy array for each column of the Parquet file, with a value for each frame:

        - `press_index`, `press`, `mounting`, `indenter`, `control`, `provenance`: of the press, the same in all its frames;
        - `time_s`: time, s;
        - `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`: pose of the indenter in the gel's frame, mm, and a quaternion;
        - `force_n`: force into the gel, N; NaN where it is not known;
        - `<taxel>_kpa`, `<taxel>_raw`, `<taxel>_valid`: what the taxel reads, kPa; the same as it was recorded; whether it is usable. A reading that did not come is NaN.
        """
    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a `pandas.DataFrame`."""
    def to_polars(self) -> polars.DataFrame:
        """The columns as a `polars.DataFrame`, through Arrow: what `polars.DataFrame(recording)` does."""
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The columns for whatever reads Arrow by its PyCapsule interface: `polars.DataFrame(recording)`, `pyarrow.table(recording)`, `pandas.DataFrame.from_arrow(recording)`, or DuckDB.
        Types are those of `columns`, texts are strings, and a force that is not known and a reading that did not come are null. No other schema is given, whatever `requested_schema` is.
        """
    def save(self, path: _Path) -> None:
        """Writes a Parquet file, whole or not at all.

        Raises `Error` with the file if it cannot be written.
        """
    def save_lerobot(self, folder: _Path, *, how_made: str = "") -> dict[str, int]:
        """Writes a LeRobot data set, version 3.0, into a folder that is not there yet: presses are episodes, indenters are tasks. `how_made` is put into its data card.
        Returns the numbers of episodes, frames and tasks, frames a second (`fps`), and the rate that they were resampled from, Hz (`resampled_from_hz`; `None` if they came evenly).

        Raises `Error` for a folder that is there, or cannot be written.
        """
    def characterize(self, sensor: Sensor, folder: _Path | None = None) -> dict[str, Any]:
        """What the sensor does, as far as the presses tell: sensitivity, noise, hysteresis and more, as `twintac characterize --json` says it.
        With a folder, the report and the data sheet are written into it. Figures that the presses do not show have the reason in their place. Ctrl-C ends the wait.

        Raises `Error` for a sensor whose taxels are not those of the recording.
        """
    def plot(self, press: _Count = 0, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws one press, counted from 0, over time: readings that are usable, force and height of the indenter.

        With Matplotlib; its three axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for a press that is not there or another number of axes.
        """
    def __len__(self) -> int: ...

@final
class Dataset:
    """Many simulated presses, made in shards by as many processes and machines as there are. A press depends on the seed and on its own name alone: however the data set
    is divided, its shards merge to the same bytes.

    Presses are those of a protocol (TOML), or `n_presses` at random with the `indenters` named (all, if none is), 1000 unless it is said. The gel is solved, or a fast one:
    PhysTac's (`fast=True`) or that of a file. Readings are the pressures at the ports, or those of the twin in a folder. `imperfection` (TOML, with `fast`) gives each press an
    imperfect sensor of its own. `settings` (TOML) may have a table `[simulate]`. Without a `sensor` (TOML), that of the twin is taken, or PhysTac.

    Raises `Error` with file, line and field if a file is wrong, and for arguments that do not go together.
    """
    def __new__(
        cls,
        *,
        sensor: _Path | None = None,
        protocol: _Path | None = None,
        indenters: Sequence[str] = ...,
        n_presses: _Count | None = None,
        seed: _Count = 1,
        fast: bool | _Path = ...,
        twin: _Path | None = None,
        imperfection: _Path | None = None,
        settings: _Path | None = None,
    ) -> Dataset: ...
    @property
    def n_presses(self) -> int:
        """How many presses it has."""
    @property
    def identity(self) -> str:
        """What it is made from: the text of `dataset.toml`. Data sets of the same text are the same."""
    def make(self, folder: _Path, shard: _Count = 1, of: _Count = 1, *, progress: Progress = None) -> dict[str, Any]:
        """Makes shard `shard` of `of`, counted from 1, in a folder, unless it is complete there. It appears whole or not at all. Returns its manifest, and the paths `parquet` and
        `manifest_file`. Ctrl-C ends it before its next press.

        Raises `Error` for a folder that holds another data set or another division, and for a shard that is not from 1 to `of`.
        """
    @staticmethod
    def check(folder: _Path, *, progress: Progress = None) -> dict[str, Any]:
        """Checks that all shards of a folder are there and as they were made. Returns counts of shards, presses and frames, and the presses that were left out.

        Raises `Error` that names the shard that is missing or differs.
        """
    @staticmethod
    def merge(folder: _Path, file: _Path | None = None, *, progress: Progress = None) -> dict[str, Any]:
        """Does what `check` does, and writes all presses as one recording: `presses.parquet` in the folder, or another file. Returns what `check` returns.

        Raises `Error` as `check` does, and for a file that cannot be written.
        """

@final
class Twin:
    """A trained twin: what the barometers of one sensor would read while its gel is pressed.

    `predict` reads a whole press, `at` one place frame by frame, `states` many sensors together, from pressures at their ports.
    """
    @staticmethod
    def load(folder: _Path) -> Twin:
        """Loads a twin from the folder that a run leaves it in: `<run>/model` (`Run.model_folder`). A pickle keeps where the folder is, and finds the same twin there or raises `Error`.

        Raises `Error` for a folder that holds no twin, or a damaged one.
        """
    @property
    def sensor(self) -> Sensor:
        """The sensor whose twin it is."""
    @property
    def trained_on(self) -> _Provenance:
        """Where the recordings come from that it was trained with: `"real"`, `"emulated"` or `"simulated"`. What it predicts is simulated."""
    def predict(self, press: Press) -> Prediction:
        """What the barometers would read along a press, as many frames a second as the sensor gives. Bench and gel are as they were found at training. Takes a few
        seconds; Ctrl-C ends the wait.

        Raises `Error` for an indenter that the sensor does not have, and for a place that cannot be pressed.
        """
    def predict_along(self, path: PressPath, *, progress: Progress = None) -> Prediction:
        """What the barometers would read along a path: the gel is solved frame by frame, sliding and tilting included; each frame takes from some milliseconds to seconds. Points of
        the path are not read. Ctrl-C ends it before its next frame. `Prediction.failure` says why a path ends before it should.

        Raises `Error` for an indenter that the sensor does not have, and for a path that misses the gel.
        """
    def at(self, press: Press) -> TwinAtPlace:
        """The twin at the place of a press and down to its depth, to be stepped with depths as they come. Takes a second; Ctrl-C ends the wait. A step then takes a
        microsecond.

        Raises `Error` as `predict` does.
        """
    def states(self, n_sensors: _Count = 1) -> TwinState:
        """Twins of so many sensors, to be stepped together with pressures at their ports: for programs that solve the gel themselves.

        Raises `Error` for no sensor, and for more than make ten million readings.
        """

@final
class Prediction:
    """What a twin would read along a press or a path: what `Twin.predict` and `Twin.predict_along` return. Every array has a row for each frame."""
    @property
    def provenance(self) -> _Simulated:
        """What every number here is: simulated."""
    @property
    def failure(self) -> str | None:
        """Why the frames end before the path does; `None` if they do not, and of a press."""
    @property
    def place_mm(self) -> _Float:
        """Place of the indenter's origin in the gel's plane, x and y, mm; `[n_frames, 2]`."""
    @property
    def time_s(self) -> _Float:
        """Time since the start of the press, or that of the path, s; `[n_frames]`."""
    @property
    def depth_mm(self) -> _Float:
        """Depth below first touch, mm, with the height at which the bench of the recordings touched; negative above the gel; `[n_frames]`."""
    @property
    def force_n(self) -> _Float:
        """Force of the indenter into the gel, N; `[n_frames]`."""
    @property
    def readings_kpa(self) -> _Float:
        """What the barometers would read above what they read untouched, kPa; `[n_frames, n_taxels]`."""
    @property
    def simulated(self) -> _Bool:
        """Whether the frame was simulated; `[n_frames]`. It was not where it is deeper than the gel could be pressed: the last pressures stand there."""
    @property
    def half_width_kpa(self) -> _Float | None:
        """Half the width of the 90 % interval around each reading, kPa, `[n_frames, n_taxels]`; `None` of a twin that does not know."""
    @property
    def unlikeness(self) -> _Float | None:
        """How unlike the contact is to what taught the twin, without unit, `[n_frames]`; `None` of a twin that does not know."""
    @property
    def is_unlike(self) -> _Bool | None:
        """Whether the contact is too unlike for readings and intervals to be trusted, `[n_frames]`; `None` of a twin that does not know."""
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings with their 90 % intervals, force and depth over time; grey is where they are not to be trusted: not simulated, or unlike.

        With Matplotlib; its three axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for another number of axes.
        """
    def __len__(self) -> int: ...

@final
class TwinAtPlace:
    """A twin whose sensor is pressed at one place, stepped with depths: what `Twin.at` returns."""
    @property
    def provenance(self) -> _Simulated:
        """What every reading is: simulated."""
    def step(self, since_previous_s: float, depth_mm: float) -> _Float:
        """One more frame, `since_previous_s` after the last, at a depth below first touch, mm, negative above the gel. Returns what the barometers would read above
        their zero, kPa; `[n_taxels]`.

        Raises `Error` for a time below 0 or a depth that is not finite.
        """
    @property
    def force_n(self) -> float:
        """Force of the indenter into the gel at the last frame, N."""
    @property
    def half_width_kpa(self) -> _Float | None:
        """Half the widths of the 90 % intervals around the last readings, kPa, `[n_taxels]`; `None` of a twin that does not know."""
    @property
    def unlikeness(self) -> tuple[float, bool] | None:
        """How unlike the last contact is to what taught the twin, without unit, and whether it is too unlike for readings and intervals to be trusted; `None` of a
        twin that does not know.
        """
    @property
    def max_depth_mm(self) -> float:
        """Depth below first touch at which the table ends, mm; deeper, its last pressures stand."""
    def tare(self) -> None:
        """Takes what is read now as zero, as a tare of a real sensor does."""
    def rest(self) -> None:
        """Lets the gel rest until the next frame: it forgets the presses before. The zero stays."""

@final
class TwinState:
    """Twins of many sensors, stepped together with pressures at their ports: what `Twin.states` returns. `len()` is the number of sensors."""
    @property
    def provenance(self) -> _Simulated:
        """What every reading is: simulated."""
    def step(self, since_previous_s: float, pressure_kpa: _Floats) -> _Float:
        """One more frame of every sensor, `since_previous_s` after the last: from pressures at the ports to what the barometers would read, kPa; both
        `[n_sensors, n_taxels]`.

        Raises `Error` for a time below 0, and for pressures of another shape or that are not finite.
        """
    def tare(self) -> None:
        """Takes what is read now as zero, as a tare of a real sensor does."""
    def tare_untouched(self) -> None:
        """Takes what a sensor that nothing touches reads as zero."""
    def rest(self, sensor: _Count) -> None:
        """Lets the gel of one sensor, counted from 0, rest until its next frame: it forgets the presses before. Its zero stays."""
    def __len__(self) -> int: ...

@final
class Run:
    """A folder in which recordings become a judged twin and a report. What is done is kept: the same again does only what is missing.

    `start`, `import_csv` and `finish` make one, `demo` makes one without data, `open` opens one that is there.
    """
    @staticmethod
    def start(
        folder: _Path,
        sensor: Sensor,
        source: str,
        *,
        seed: _Count = 1,
        settings: dict[str, Any] | None = None,
    ) -> Run:
        """Starts a run, or takes up the one that the folder holds with new settings. `source` says in words where the presses come from. `settings`
        has those that differ from the usual ones, with a dictionary for each stage: `{"train": {"epochs": 40}}`. The same recordings, settings and `seed` give the
        same twin.

        Raises `Error`, whose `field` is the setting that cannot be, and for a folder that cannot be written.
        """
    @staticmethod
    def open(folder: _Path) -> Run:
        """Opens a run that was started.

        Raises `Error` for a folder that is no run.
        """
    @staticmethod
    def demo(folder: _Path, *, seed: _Count = 1, progress: Progress = None) -> Run:
        """Starts the demo, and has its recordings made: PhysTac, pressed on the emulated bench. `finish` does the rest. All of it takes a minute. Ctrl-C stops it."""
    def import_csv(self, description: _Path, *paths: _Path) -> None:
        """Makes the run's recordings of CSV files of any laboratory, which the description (TOML) says how to read, as `Recording.import_csv` does.

        Raises `Error` with file, line and field: of the description, or of the cell that cannot be read.
        """
    def finish(self, *, progress: Progress = None) -> dict[str, Any]:
        """Runs all stages after the recordings: simulates, aligns, trains, judges, reports. Returns how well the twin does, as `metrics.json` has it.
        Ctrl-C stops before the next step; the same call goes on from there.

        Raises `Error` for a run that has no recordings, and for presses that no twin can be trained with.
        """
    def recording(self) -> Recording:
        """The presses, as recorded.

        Raises `Error` for a run that has none yet.
        """
    @property
    def folder(self) -> Path:
        """The run's folder."""
    @property
    def model_folder(self) -> Path:
        """The folder of the twin of all presses, which `Twin.load` reads."""
    @property
    def report_path(self) -> Path:
        """The page that says how well the twin does: `report.html` in the folder. It is there after `finish`."""

@final
class Pose:
    """A rigid transform from an inner frame to an outer one, such as from an indenter's frame to the gel's.

    - `position_mm`: origin of the inner frame in the outer one, mm.
    - `quaternion`: rotation from the inner to the outer frame, `(x, y, z, w)`, of length 1; none unless given.

    Raises `Error` for numbers that are not finite, and for a quaternion of another length.
    """
    def __new__(
        cls,
        position_mm: _Floats,
        quaternion: _Floats = (0.0, 0.0, 0.0, 1.0),
    ) -> Pose: ...
    @property
    def position_mm(self) -> tuple[float, float, float]:
        """Origin of the inner frame in the outer frame, mm."""
    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """Rotation from the inner to the outer frame, `(x, y, z, w)`."""
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Shape:
    """A rigid shape that presses. `edge_radius_mm` rounds every convex edge without moving any face. Prismatic shapes have their profile in the xy
    plane and stand on z = 0.

    Each function that makes one raises `Error`, whose `field` is the length that cannot be.
    """
    @staticmethod
    def sphere(radius_mm: float) -> Shape:
        """A ball that stands on its origin: its middle is `radius_mm` above it."""
    @staticmethod
    def cylinder(radius_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """A flat-ended upright cylinder, whose rims are rounded with `edge_radius_mm`."""
    @staticmethod
    def box(size_mm: _Floats, edge_radius_mm: float) -> Shape:
        """A box of this full size along x, y and z, mm, whose edges are rounded with `edge_radius_mm`."""
    @staticmethod
    def x(length_mm: float, width_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """Two crossed bars in the shape of an X, a plus turned by 45°: each bar is `length_mm` long and `width_mm` wide."""
    @staticmethod
    def ring(
        outer_radius_mm: float, inner_radius_mm: float, height_mm: float, edge_radius_mm: float
    ) -> Shape:
        """An upright tube."""
    @staticmethod
    def triangle(side_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """An upright equilateral prism, centroid at the origin, one corner towards +x."""
    @staticmethod
    def wedge(angle_rad: float, length_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """A roof-shaped wedge that touches with its ridge, which lies along y."""
    @staticmethod
    def stl(path: _Path, *, unit: str | None = None, scale: float | None = None) -> Shape:
        """A closed triangle surface in an STL file, whose `unit` is "mm", "cm", "m" or "inch", or in which a length of 1 is `scale` mm; its lowest point is
        moved to the origin's z.

        Raises `Error` with the file if it cannot be read, its surface is not closed, or its size cannot be in that unit.
        """
    @staticmethod
    def surface(vertices_mm: _Floats, triangles: _Integers) -> Shape:
        """A closed surface of triangles: places of its corners, mm, `[n_vertices, 3]`, and the corners of each triangle, counter-clockwise seen from outside,
        `[n_triangles, 3]`. It stays where it is.

        Raises `Error` for arrays of another shape, a corner that is not there, and a surface that is not closed.
        """
    @staticmethod
    def union(parts: Sequence[tuple[Shape, Pose]]) -> Shape:
        """Several shapes held together, each where its pose in the whole says; they may overlap."""
    @property
    def bounds_mm(self) -> _Float:
        """Corners of the smallest box along the shape's axes that holds it, mm: `[2, 3]`."""
    def signed_distance_mm(self, points_mm: _Floats) -> _Float:
        """How far points of the shape's own frame are from its surface, mm, less than 0 inside: of `[n_points, 3]`, mm, `[n_points]`. Ctrl-C ends the wait.

        Raises `Error` for an array of another shape, and a point that is not finite.
        """

@final
class Body:
    """A shape whose distances are known at once: what the fast gel reads.

    Sampling a shape takes from a millisecond to a second, for a surface of many triangles.
    """
    def __new__(cls, shape: Shape) -> Body: ...

@final
class FastGel:
    """A sensor's gel without finite elements: microseconds a reading, of bodies of any shape.

    `FastGel.phystac()` and `FastGel.phystac_tip()` are built in; `twintac fast train` makes that of another sensor, which `FastGel.load` reads. It does not relax; `Friction` adds friction.
    """
    @staticmethod
    def phystac() -> FastGel:
        """The fast gel of PhysTac, which is built in."""
    @staticmethod
    def phystac_tip() -> FastGel:
        """The fast gel of PhysTac's fingertip, which is built in."""
    @staticmethod
    def load(path: _Path) -> FastGel:
        """Reads a file that `twintac fast train` has made.

        Raises `Error` with the file if it is none, or cannot be read.
        """
    def to_bytes(self) -> bytes:
        """The gel as the bytes of a file that `load` reads: `Path("gel.safetensors").write_bytes(gel.to_bytes())`."""
    @property
    def sensor(self) -> str:
        """Name of the sensor whose gel it is."""
    def check(self, sensor: Sensor) -> None:
        """Refuses a sensor whose gel it is not: whose shape, material, shell or ports are others.
        Names do not count, nor do indenters, limits and the read-out.

        Raises `Error`, which says all that differs.
        """
    @property
    def ports_mm(self) -> _Float:
        """Where the ports are in the gel's plane, mm; `[n_taxels, 2]`."""
    def with_ports(self, places_mm: _Floats) -> FastGel:
        """The same gel with its ports at other places of the floor, x and y, mm, `[n_ports, 2]`: finer than taxels are.

        Raises `Error` for an array of another shape, no place, more than a million, and a place that is not on the gel's floor.
        """
    def reader(self) -> FastReader:
        """Prepares one sensor to be read. Each thread needs a reader of its own."""
    def batch(self, bodies: Sequence[Body], n_threads: _Count | None = None) -> FastBatch:
        """Prepares many sensors to be read in one call, which these bodies touch. It uses all cores, or `n_threads`.

        Raises `Error` if there is no body, and for a number of threads that is not from 1 to 1024.
        """

@final
class FastReader:
    """A fast gel of one sensor, ready to be read: what `FastGel.reader` returns."""
    @property
    def provenance(self) -> _Simulated:
        """What every reading is: simulated."""
    def read(self, bodies: Sequence[tuple[Body, Pose]]) -> tuple[_Single, _Single]:
        """What the gel does under bodies at these poses in its frame (`gel_from_body`). Returns the pressure at each port, kPa, `[n_taxels]`; and force on the gel, N,
        and torque about the top of its middle, N mm, `[6]`.
        """
    def novelty(self, bodies: Sequence[tuple[Body, Pose]]) -> float:
        """How unlike what was taught a contact is, without unit: 0 where nothing is near the gel;
        above 1 readings and force may be wrong: its shape is new, it is deeper than lessons
        pressed, or too few pressed there.
        """

@final
class Friction:
    """Friction of one body on one sensor's gel, from one moment to the next: the gel's top is sheared with the body, until it slips. Nothing is held yet.

    `coefficient` is Coulomb's, 0 or more; anything else raises `Error`.
    """
    def __new__(cls, sensor: Sensor, coefficient: float) -> Friction: ...
    def read(self, reader: FastReader, body: Body, gel_from_body: Pose) -> tuple[_Single, _Single]:
        """One more moment of a sensor that this body alone touches: what `FastReader.read` returns, with friction.

        Raises `Error` for the reader of another gel.
        """
    def release(self) -> None:
        """Lets go of what touches: the next moment begins without friction."""

@final
class FastBatch:
    """Fast gels of many sensors of one kind, read in one call: what `FastGel.batch` returns."""
    @property
    def provenance(self) -> _Simulated:
        """What every reading is: simulated."""
    def read(
        self, gel_from_body: _Floats, body: _Integers | None = None, ends: _Integers | None = None
    ) -> tuple[_Single, _Single]:
        """What the gels do under what touches each of them. A sensor's numbers do not depend on the others.

        `gel_from_body` has a row for each touch, the first sensor's first: place in mm and quaternion (x, y, z, w), or the place alone. `body` has
        the numbers of the bodies, the first body unless given. `ends` says where each sensor's touches end; unless given, each has one.

        Returns pressures at the ports, kPa, `[n_sensors, n_taxels]`, and force on each gel, N, and torque about the top of its middle, N mm, `[n_sensors, 6]`.

        Raises `Error`, whose `field` is the array that has another shape, or numbers that cannot be.
        """

@final
class Imperfection:
    """How far sensors are from perfect: from what each sensor's own imperfections are drawn.

    Keywords are the fields of `[imperfection]` in a file; each is 0 unless given, and `Imperfection()` is a perfect sensor. A *deviation* is the standard deviation of
    a normal distribution about zero.

    - `gain_deviation`: of each taxel's gain, as part of it.
    - `growth_deviation_per_kpa`: of how much each taxel's reading grows beyond proportion for each kPa of it, 1/kPa.
    - `offset_deviation_kpa`: of each taxel's zero, kPa.
    - `drift_kpa_per_k`, `drift_deviation_kpa_per_k`: how much all taxels drift with temperature, and the deviation of each beyond that, kPa/K.
    - `temperature_deviation_k`, `temperature_time_s`: deviation of the temperature from that of the tare, K, and the time in which it forgets what it was, s.
    - `cross_talk`, `cross_talk_deviation`: part of what each other taxel feels that a taxel reads as well, beyond what the gel spreads, and its deviation from pair to pair.
    - `noise_deviation_kpa`: of each reading's noise, kPa.
    - `quantum_kpa`: distance of the values that are told apart, kPa.
    - `hysteresis`: half of the gap between loading and unloading, as part of the reading, 0 to 1.
    - `dead_chance`, `stuck_chance`, `late_chance`: chances, 0 to 1, that a taxel reads zero for ever, stays at its first value, reads a frame late.
    - `rate_hz`, `jitter`: frames that the bus delivers in a second, Hz (0: one at each step), and the deviation of the time between them, as part of it.
    - `height_deviation_mm`, `place_deviation_mm`, `turn_deviation_rad`, `tilt_deviation_rad`: of how the sensor is mounted, mm and radians.

    Raises `Error`, whose `field` is the one that cannot be.
    """
    def __new__(cls, **fields: _Number) -> Imperfection: ...
    @staticmethod
    def load(path: _Path) -> Imperfection:
        """Reads a file (TOML) with the table `[imperfection]`, as `twintac fast imperfection` makes them.

        Raises `Error` with file, line and field if it is wrong.
        """
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Coupling:
    """How bodies and gels hold each other where bodies move freely: with friction, and with the gel's loss, which lets what hits it come to rest.

    - `friction`: Coulomb's coefficient of each body on each gel, 0 or more.
    - `retardation_s`: time by which the gel's force leads its elastic one, s, as of a Kelvin-Voigt solid: `F + t dF/dt`. 0 for a gel without loss.

    Raises `Error`, whose `field` is the number that cannot be.
    """
    def __new__(cls, sensor: Sensor, *, friction: float, retardation_s: float = 0.0) -> Coupling: ...

@final
class SensorBatch:
    """Many sensors of one kind, each imperfect in its own way, stepped in one call. Their gels have rested. `len()` is the number of sensors.

    - `gel`: the fast gel of all of them.
    - `bodies`: what may touch them, at least one.
    - `imperfection`: from what each sensor's own imperfections are drawn; perfect sensors unless given.
    - `twin`: its barometers read, with gains and memory; pressures at the ports unless given.
    - `coupling`: how bodies and gels hold each other; neither friction nor loss unless given.
    - `seed`: sensor `n` is the same under the same seed, whatever the other sensors are.
    - `n_sensors`: 1 or more, and at most ten million readings: 1,250,000 sensors of eight taxels.
    - `n_threads`: as many as there are cores unless given, at most 1024; results do not depend on it.

    Raises `Error` for a twin or a coupling of another gel, if there is no body, and for a number that is out of its range.
    """
    def __new__(
        cls,
        gel: FastGel,
        bodies: Sequence[Body],
        n_sensors: _Count,
        *,
        imperfection: Imperfection | None = None,
        twin: Twin | None = None,
        coupling: Coupling | None = None,
        seed: _Count = 0,
        n_threads: _Count | None = None,
    ) -> SensorBatch: ...
    @property
    def provenance(self) -> _Simulated:
        """What every reading is: simulated."""
    def set_bodies(self, bodies: Sequence[Body]) -> None:
        """Puts other bodies in the place of those that may touch. What gels hold, they go on to hold,
        under the things' `touch_id`.

        Raises `Error` if there is no body.
        """
    def step(
        self,
        since_previous_s: float,
        gel_from_body: _Floats,
        body: _Integers | None = None,
        ends: _Integers | None = None,
        *,
        touch_id: _Integers | None = None,
    ) -> tuple[_Single, _Single]:
        """One more moment of every sensor, `since_previous_s` after the last. `gel_from_body`, `body`
        and `ends` are those of `FastBatch.read`.

        `touch_id`, an integer for each touch, says which thing it is: the same as long as it is the
        same thing, and another for each other thing on that sensor. A sensor with a `Coupling`
        remembers each thing that touches it under this number, wherever it stands in the list and
        whatever body it has, so it has to be given. What is not in the list is forgotten.

        Returns what the bus of each sensor delivered last, kPa, `[n_sensors, n_taxels]`, and force on each gel, N, and torque about the top of its middle, N mm, in the frame of
        the sensor where it is, `[n_sensors, 6]`.

        Raises `Error`, whose `field` is the argument that has another shape, or numbers that cannot
        be, and if a thing touches one sensor twice. Nothing has been done then.
        """
    def wrench_of_touches(self) -> _Single:
        """What each thing did in the last step by itself, in the order of the touches: force on the
        gel, N, and torque about the top of its middle, N mm,
        `[n_touches, 6]`, in the frame in which the sensor should be. Without a `Coupling` there are none: `[0, 6]`.
        """
    def state(self, sensor: _Count) -> SensorState:
        """What one sensor, counted from 0, is and remembers now: set back, it goes on to the same
        bits.
        """
    def set_state(self, sensor: _Count, state: SensorState) -> None:
        """Lets one sensor, counted from 0, go on from a state, of its own or of another sensor of such
        a batch.

        Raises `Error` for the state of a sensor with other taxels, or with a twin where this one
        has none.
        """
    def rest(self, sensor: _Count) -> None:
        """Lets the gel of one sensor, counted from 0, rest until its next step, with the imperfections that it has."""
    def replace(self, sensor: _Count, number: _Count) -> None:
        """Puts another sensor in the place of one, counted from 0, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
        below the number of sensors are the first ones.
        """
    def __len__(self) -> int: ...

@final
class SensorState:
    """What one sensor of a `SensorBatch` is and remembers at a moment: its imperfections and the noise
    to come, its twin's memory, and what its gel holds. What `SensorBatch.state`
    returns.
    """
    def __copy__(self) -> SensorState:
        """It never changes: a copy is itself."""
    def __deepcopy__(self, _memo: object, /) -> SensorState:
        """It never changes: a copy is itself."""

@final
class Tasks:
    """Many environments of one task, each with a sensor of its own, stepped in one call. `len()` is the number of environments. `twintac.gymnasium` has them as environments
    of Gymnasium, and says what each task observes, does and rewards.

    - `kind`: `"ExploreShape"`, `"HoldForce"` or `"FollowEdge"`.
    - `gel`: PhysTac's unless given.
    - `imperfection`: from what the imperfections of each episode's sensor are drawn; those of a sensor that works unless given.
    - `autoreset`: when an environment whose episode is over begins the next one: in the next step (`"NextStep"`), which ignores its action and has a reward of zero; in
      the same step (`"SameStep"`); or when `reset` is called (`"Disabled"`).
    - `n_environments`: 1 or more, and at most ten million readings of their sensors: 1,250,000 of eight taxels.
    - `n_threads`: as many as there are cores unless given, at most 1024; results do not depend on it.

    Raises `Error` for a task that is not there, a gel that it cannot use, and a number that is out of its range.
    """
    def __new__(
        cls,
        kind: str,
        n_environments: _Count,
        *,
        gel: FastGel | None = None,
        imperfection: Imperfection | None = None,
        autoreset: Literal["NextStep", "SameStep", "Disabled"] = "NextStep",
        n_threads: _Count | None = None,
    ) -> Tasks: ...
    @property
    def provenance(self) -> _Simulated:
        """What every number is: simulated."""
    @property
    def n_observed(self) -> int:
        """Numbers of an observation, each from -10 to 10."""
    @property
    def n_actions(self) -> int:
        """Numbers of an action, each from -1 to 1."""
    @property
    def figures(self) -> list[str]:
        """Names of what is true in an environment and not observed, with units; `[n_figures]`."""
    def seed(self, seeds: Sequence[_Count | None] | npt.NDArray[np.integer[Any]]) -> None:
        """Gives environments seeds, one for each, from the next reset on; `None` leaves an environment the one that it has.

        Raises `Error` for another number of seeds, and for a seed that is not from 0 to 2⁶⁴ - 1.
        """
    def reset(self, which: npt.ArrayLike | None = None) -> tuple[_Single, _Single]:
        """Begins the next episode of all environments, or of those where `which`, `[n_environments]`, is true. Returns observations, `[n_environments, n_observed]`, and figures,
        `[n_environments, n_figures]`; zeros of the others.
        """
    def step(
        self, actions: _Floats
    ) -> tuple[_Single, _Float, _Bool, _Bool, _Single, tuple[_Single, _Single] | None]:
        """One step of every environment. `actions` is `[n_environments, n_actions]`, each from -1 to 1.

        Returns observations, `[n_environments, n_observed]`; rewards, whether the task is over, and whether time is over, each `[n_environments]`; figures,
        `[n_environments, n_figures]`; and, of environments that began anew in the same step, what was observed before and the figures then, or `None` if there are none.

        Raises `Error` for actions of another shape, or that are not finite.
        """
    def picture(self, environment: _Count) -> npt.NDArray[np.uint8]:
        """A picture of one environment, counted from 0: what is there from above, and what its sensor reads. `[240, 600, 3]`, red, green and blue, 0 to 255."""
    def __len__(self) -> int: ...

@final
class Inverse:
    """Finds from readings what touches: place, depth, force, and which of the known shapes.

    Made like this it knows what is read by a fast gel and the shapes, by name, that may touch it, upright; `of_twin` takes a trained twin in its place, `of_tables` tables of readings.
    Keywords are settings:

    - `noise_kpa`: standard deviation of a reading's noise, kPa; 0.05 unless given.
    - `model_part`, `model_part_of_largest`: standard deviation of the model's error as part of each reading, 0.03, and as part of the frame's largest one, 0.01.
    - `force_part`: the same of the force, as part of it; 0.03.
    - `correlated_s`: time within which errors of the model count as one, s; 0.1.
    - `touch_deviations`: a contact is what reads so many deviations of the noise, at one taxel at least; 6.
    - `place_walk_mm`, `depth_walk_mm`, `spin_walk_rad`: how far a contact wanders in a second: 3 mm, 2 mm, 1 radian.
    - `shape_memory_s`: time after which what told the shape is forgotten to a part of 1/e, s; 3.
    - `n_starts`, `n_steps`: presses of each shape that are followed at once, 3, and steps towards the best of them in a frame, 1.
    - `deepest_mm`: deepest press that is thought of, mm; 5. Not deeper than the gel was taught.

    Raises `Error`, whose `field` is the setting that cannot be, for a shape that cannot be, and if there is no shape.
    """
    def __new__(cls, gel: FastGel, shapes: Mapping[str, Shape], **settings: _Number) -> Inverse: ...
    @staticmethod
    def of_tables(tables: Mapping[str, ReadingTable], **settings: _Number) -> Inverse:
        """By what is read of each shape, by name, at places and depths: measured, or simulated. Keywords are those of the class, which has the names of the settings.

        Raises `Error` for tables of different numbers of taxels, a setting that cannot be, and if there is no shape.
        """
    @staticmethod
    def of_twin(
        folder: _Path, indenters: Sequence[str] = ..., *, progress: Progress = None, **settings: _Number
    ) -> Inverse:
        """By the trained twin in a folder (`Run.model_folder`), whose memory is taken off the readings. Shapes are the named indenters of its sensor, or all of them, turned as described.
        Keywords are those of the class, which has the names of the settings; unless given, `noise_kpa` is 0.03, `model_part_of_largest` 0.02, `n_steps` 3 and
        `deepest_mm` 2.5. Taxels that the description calls doubtful are not used. The gel is solved at places all over the taxels, which takes minutes; Ctrl-C stops it.

        Raises `Error` for a folder that holds no twin, an indenter that the sensor does not have, and a setting that cannot be.
        """
    @property
    def shapes(self) -> list[str]:
        """Names of the shapes; in alphabetical order, or of a twin as its sensor's description has its indenters."""
    def start(self, provenance: _Provenance) -> Tracker:
        """Follows the contact of a sensor that nothing has touched yet. `provenance` says where its readings come from: `"real"`, `"emulated"` or `"simulated"`."""
    def floor_map(self, spacing_mm: float = 0.5) -> FloorMap:
        """Prepares maps of the pressure on the gel's floor under contacts, finer than the taxels: on a grid of this spacing, mm, in the middle of the gel. 0.5 mm makes about 2,500 points
        of PhysTac's floor.

        Raises `Error` for a spacing that is not above 0 or makes more than ten million points, and for an inverse that is not of a fast gel.
        """

@final
class ReadingTable:
    """What is read of one shape at the nodes of a grid over place and depth, for `Inverse.of_tables`. An axis of one node is not looked for. Between nodes readings are cubic.

    - `x_mm`, `y_mm`: places of the shape's origin in the gel's plane, mm, evenly apart and increasing; `[n_x]` and `[n_y]`.
    - `depth_mm`: depths below first touch, mm, evenly apart and increasing; `[n_depth]`.
    - `readings_kpa`: readings above the untouched sensor, kPa; `[n_depth, n_y, n_x, n_taxels]`.
    - `force_n`: force into the gel, N, `[n_depth, n_y, n_x]`; unknown unless given.

    Raises `Error`, whose `field` is the array that has another shape, or numbers that cannot be.
    """
    def __new__(
        cls, x_mm: _Floats, y_mm: _Floats, depth_mm: _Floats, readings_kpa: _Floats, force_n: _Floats | None = None
    ) -> ReadingTable: ...

@final
class FloorMap:
    """Reads the pressure on a gel's floor on a grid: what a contact would make there by the fast gel. What `Inverse.floor_map` returns."""
    @property
    def provenance(self) -> _Simulated:
        """What every pressure is: simulated, whatever the readings were that the contact was found from."""
    @property
    def x_mm(self) -> _Float:
        """Places of the columns in the gel's plane, mm; `[n_columns]`."""
    @property
    def y_mm(self) -> _Float:
        """Places of the rows in the gel's plane, mm; `[n_rows]`."""
    def read(self, contact: Contact) -> _Single:
        """The map under a contact that the same inverse has found, kPa; `[n_rows, n_columns]`, the row of smallest y first. Each point is the mean over a disc as large as a port.

        Raises `Error` for a contact that another inverse has found.
        """

@final
class Tracker:
    """Follows the contact of one sensor, frame by frame: what `Inverse.start` returns."""
    @property
    def provenance(self) -> _Provenance:
        """Where the readings come from: `"real"`, `"emulated"` or `"simulated"`."""
    def update(self, since_previous_s: float, readings_kpa: _Floats) -> Contact | None:
        """Takes a frame, `since_previous_s` after the one before: readings above the untouched sensor, kPa, `[n_taxels]`. Of an inverse by a twin, a NaN is a taxel without
        a usable reading: its last usable one stands. Returns what touches, or `None` if the readings are within noise.

        Raises `Error` for a time below 0, another number of readings, and readings that are not finite or beyond a million kPa.
        """

@final
class Contact:
    """What touches, with how sure that is: what `Tracker.update` returns. Deviations are standard deviations. An inverse by tables may not know the force: it is 0 then."""
    @property
    def provenance(self) -> _Provenance:
        """Where the readings come from: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def shape(self) -> str:
        """Name of the most probable shape, of which the rest is said."""
    @property
    def shape_probabilities(self) -> dict[str, float]:
        """How probable each of the known shapes is; they sum up to 1."""
    @property
    def place_mm(self) -> tuple[float, float]:
        """Place of the shape's origin in the gel's plane, x and y, mm."""
    @property
    def depth_mm(self) -> float:
        """Depth below first touch, mm."""
    @property
    def spin_rad(self) -> float:
        """Turn about the vertical, radians, up to what makes no difference to the shape; 0 for a round one."""
    @property
    def force_n(self) -> float:
        """Force into the gel, N."""
    @property
    def place_deviation_mm(self) -> tuple[float, float]:
        """Deviation of the place along x and along y, mm."""
    @property
    def depth_deviation_mm(self) -> float:
        """Deviation of the depth, mm."""
    @property
    def spin_deviation_rad(self) -> float:
        """Deviation of the spin, radians; 0 for a round shape."""
    @property
    def force_deviation_n(self) -> float:
        """Deviation of the force, N."""
    @property
    def covariance(self) -> _Float:
        """Covariance of x, y and depth, mm, and spin, radians; `[4, 4]`."""
    @property
    def misfit(self) -> float:
        """What the shape leaves of the readings, in deviations of a frame by itself: far above 1, something else touches."""

def _restored(class_: str, state: bytes) -> Any:
    """Makes a value of what a pickle has kept of it."""
def command() -> int:
    """Does what the command line (`sys.argv`) asks for, as the command `twintac` does. Returns the exit code: 0 if all went well, 2 for bad input, 3 if a bench was stopped safely."""
