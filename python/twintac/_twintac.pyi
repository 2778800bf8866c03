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
    "SensorVariation",
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
    """A sensor, as its description says: gel, taxels and indenters.

    `Sensor.phystac()` and `Sensor.phystac_tip()` are built in. `Sensor.load` reads the description
    of another sensor.
    """
    @staticmethod
    def phystac() -> Sensor:
        """PhysTac: eight barometers under a flat gel of 34 × 18 × 8.5 mm."""
    @staticmethod
    def phystac_tip() -> Sensor:
        """PhysTac's fingertip: eight barometers under a dome, 19.2 mm high."""
    @staticmethod
    def load(path: _Path) -> Sensor:
        """Reads a sensor description (TOML).

        Raises `Error` with file, line and field if the description is wrong, and with the file if
        it cannot be read.
        """
    @property
    def name(self) -> str:
        """Name of the sensor in its description."""
    @property
    def taxels(self) -> list[str]:
        """Names of the taxels, in the order of every row of readings."""
    @property
    def taxel_positions_mm(self) -> _Float:
        """Centres of the taxels' ports in the gel's frame, mm; `[n_taxels, 3]`."""
    @property
    def bounds_mm(self) -> _Float:
        """Lowest and highest corner of the box that contains the gel, in the gel's frame, mm;
        `[2, 3]`.
        """
    @property
    def indenters(self) -> list[str]:
        """Names of the indenters in the description. `Press` takes one of them."""
    @property
    def rate_hz(self) -> float:
        """Frame rate of the sensor, Hz."""
    def describe(self) -> str:
        """The whole description, with units, as a text for people."""
    def _repr_svg_(self) -> str:
        """The picture that a notebook shows: the sensor from above and in section, as the text of an
        SVG file.
        """

@final
class Press:
    """A straight press: down to a depth, a hold, and back up.

    - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
    - `at_mm`: location of the indenter's origin in the gel's frame, x and y, mm; the origin of that
      frame unless given, which need not be the middle of the gel.
    - `depth_mm`: depth below first touch, mm, above 0.
    - `yaw_rad`: yaw, the rotation of the indenter about the axis of the press, radians.
    - `speed_mm_per_s`: speed down and up, mm/s, 0.001 or more.
    - `hold_s`: time at full depth, s, at most an hour.

    Raises `Error` for a value that is not allowed; its `field` names the argument. Whether the
    sensor has the indenter is checked when the gel is pressed.
    """
    def __new__(
        cls,
        indenter: str,
        *,
        at_mm: _Floats = (0.0, 0.0),
        depth_mm: float = 1.0,
        yaw_rad: float = 0.0,
        speed_mm_per_s: float = 2.0,
        hold_s: float = 0.0,
    ) -> Press: ...
    @property
    def indenter(self) -> str:
        """Name of one of the sensor's indenters."""
    @property
    def at_mm(self) -> tuple[float, float]:
        """Location of the indenter's origin in the gel's plane, x and y, mm."""
    @property
    def depth_mm(self) -> float:
        """Depth below first touch, mm."""
    @property
    def yaw_rad(self) -> float:
        """Yaw (rotation of the indenter about the axis of the press), radians."""
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
    """The gel of a sensor: a finite-element model with the material of the description.

    - `sensor`: the sensor.
    - `settings`: settings of the simulation that differ from the default ones for single presses,
      such as `{"edges_per_height": 4.0}`. With more edges, a press takes longer and has a smaller
      error.

    Raises `Error` for a setting that is not allowed; its `field` names the setting.
    """
    def __new__(cls, sensor: Sensor, settings: dict[str, Any] | None = None) -> Gel: ...
    def press(self, press: Press) -> Pressed:
        """Presses the gel down to the depth of the press, which takes about a second. The hold and the
        way back are not simulated. If the material of the gel relaxes, it does so at the speed of
        the press. Ctrl-C ends the wait.

        - `press`: the press.

        Raises `Error` for an indenter that the sensor does not have, for a location beside the gel,
        and for a depth at which the solver finds no equilibrium.
        """
    def touch(self, indenter: str, above: Pose) -> Pose:
        """The pose at which an indenter that is lowered first touches the undeformed gel.

        - `indenter`: name of the indenter.
        - `above`: pose in the gel's frame from which it is lowered; its height is ignored.

        Raises `Error` for an indenter that the sensor does not have, and for a location beside the
        gel.
        """
    def state(self, indenter: str, poses: Sequence[Pose], *, deadline_ms: float | None = None) -> GelState:
        """Returns the gel before an indenter presses it. The indenter can then be moved from pose to
        pose as they come. The call takes about a second; Ctrl-C ends the wait.

        - `indenter`: name of the indenter.
        - `poses`: poses in the gel's frame between which the indenter will move, at least one. The
          mesh is fine along the straight lines between them, and for the deepest of them.
        - `deadline_ms`: limit of the wall time of each frame, 1 to 60000 ms. A frame is then
          returned at the limit as far as it is computed: `GelState.converged` says whether it
          is at equilibrium, `GelState.residual` how nearly, and `GelState.behind_mm` how far it is
          behind. Frames with a `force_n` ignore the limit. Readings with a limit are not
          reproducible.

        Raises `Error` for an indenter that the sensor does not have, for a first pose beside the
        gel, and for a limit out of its range.
        """
    def follow(self, path: PressPath, *, progress: Progress = None) -> Followed:
        """Moves an indenter along a path, frame by frame. A frame takes from some milliseconds to
        seconds. Ctrl-C ends the call before the next frame. If a path cannot be followed to its
        end, its frames end early, and `Followed.failure` says why; this raises no error.

        - `path`: the path.
        - `progress`: display of the progress, see `Progress`.

        Raises `Error` for an indenter that the sensor does not have, for a first pose beside the
        gel, and for a point that is outside the gel or has the name of a taxel.
        """
    def _ipython_display_(self) -> None:
        """Shows the gel in a notebook, to be pressed with sliders (`twintac.widget.GelWidget`).
        Without ipywidgets, or if the sensor has no indenter, a drawing of the sensor is shown.
        """

@final
class GelState:
    """A gel that one indenter presses, frame by frame: it is pushed, slides and rotates to poses as
    they come. `Gel.state` returns it. It keeps the deformation of the gel, the history of its
    material, and the locations where friction holds it.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def step(self, since_previous_s: float, gel_from_indenter: Pose, *, force_n: float | None = None) -> _Float:
        """Computes one more frame: the indenter moves to a pose on a straight line. Small steps take
        milliseconds on a gel of few nodes (`Gel(sensor, {"max_path_nodes": 4000})`), long steps on
        a fine gel take seconds. Ctrl-C ends the wait; the step is finished nevertheless.

        - `since_previous_s`: time since the last frame, s. The first frame ignores it.
        - `gel_from_indenter`: pose of the indenter in the gel's frame.
        - `force_n`: force straight down, N, above 0. The indenter then moves down or up from the
          pose, by at most the gel's height, until it presses with this force.

        Returns the port pressures: the hydrostatic pressure in the gel over each taxel's port, kPa;
        `[n_taxels]`.

        Raises `Error` if the solver finds no equilibrium. The gel is then as it was before, and
        smaller steps may succeed. It also raises `Error` for a time below 0, and for a force that
        is not above 0, is not reached, or is above the limit of the sensor (`limits.force_n` of its
        description).
        """
    @property
    def gel_from_indenter(self) -> Pose | None:
        """Pose of the indenter in the gel's frame; `None` before the first frame."""
    @property
    def depth_mm(self) -> float | None:
        """Depth below the height at which the indenter first touches the gel at the location and
        rotation of the first pose that `Gel.state` was given, mm; `None` before the first frame.
        """
    @property
    def converged(self) -> bool | None:
        """Whether the last frame is the equilibrium at the pose that was asked for. It always is,
        unless the `deadline_ms` of `Gel.state` came first. `None` before the first frame.
        """
    @property
    def residual(self) -> float | None:
        """Fraction of the load that is unbalanced at the last frame; `None` before the first frame."""
    @property
    def behind_mm(self) -> float | None:
        """How far the indenter at the last frame is behind the pose that was asked for, mm; 0 without
        a `deadline_ms`. The next step goes on from there. `None` before the first frame.
        """
    @property
    def force_n(self) -> _Float:
        """Force of the indenter on the gel at the last frame, in the gel's frame, N; `[3]`. Its z
        component is negative if the indenter presses straight down. Zero before the first frame.
        """
    @property
    def torque_n_mm(self) -> _Float:
        """Torque of the indenter on the gel about the indenter's origin at the last frame, in the
        gel's frame, N mm; `[3]`. Zero before the first frame.
        """
    def rest(self) -> None:
        """Removes the indenter, and resets the gel to the state before the first frame, without any
        history.
        """

@final
class PressPath:
    """A path of an indenter over and into a gel, through poses or to forces: down, sideways, tilted,
    and up again. Between the poses the indenter moves at constant speed.

    - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
    - `time_s`: times of the poses, s, increasing; `[n_poses]`.
    - `gel_from_indenter`: poses of the indenter in the gel's frame: position of its origin, mm, and
      quaternion (x, y, z, w), `[n_poses, 7]`; or the position alone, `[n_poses, 3]`.
    - `zero`: origin of heights: `"board"`, or `"touch"`, the height at which the indenter first
      touches the gel at the location and rotation of the first pose.
    - `rate_hz`: frame rate between the poses, Hz. Without it, the poses themselves are the frames.
    - `force_n`: force straight down with which the indenter presses at each pose, N, above 0;
      `[n_poses]`. The indenter moves down or up from the pose until it has this force. With NaN, it
      stays at the pose.

    Raises `Error` for a value that is not allowed; its `field` names the argument.
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
        """Reads a path from a file (TOML), as `twintac simulate --path` does. A file may also have
        points in the gel at which the pressure is read, and another direction of forces.

        Raises `Error` with file, line and field if the file is wrong, and with the file if it
        cannot be read.
        """
    @property
    def indenter(self) -> str:
        """Name of the indenter."""
    @property
    def time_s(self) -> _Float:
        """Time of each frame, s; `[n_frames]`."""

@final
class Followed:
    """The simulated gel along a path: the result of `Gel.follow`. Every array has a row for each
    frame, up to the last one that was computed.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    @property
    def failure(self) -> str | None:
        """Why the frames end before the path does; `None` if they reach its end."""
    @property
    def time_s(self) -> _Float:
        """Time, s; `[n_frames]`."""
    @property
    def position_mm(self) -> _Float:
        """Position of the indenter's origin in the gel's frame, mm; `[n_frames, 3]`."""
    @property
    def depth_mm(self) -> _Float:
        """Depth below the height at which the indenter first touches the gel at the location and
        rotation of the first pose, mm; `[n_frames]`.
        """
    @property
    def force_n(self) -> _Float:
        """Force of the indenter on the gel, in the gel's frame, N; `[n_frames, 3]`. Its z component is
        negative if the indenter presses straight down.
        """
    @property
    def torque_n_mm(self) -> _Float:
        """Torque of the indenter on the gel about the indenter's origin, in the gel's frame, N mm;
        `[n_frames, 3]`.
        """
    @property
    def readings_kpa(self) -> _Float:
        """Port pressure of each taxel: the hydrostatic pressure in the gel over the port, kPa;
        `[n_frames, n_taxels]`.
        """
    @property
    def points_kpa(self) -> dict[str, _Float]:
        """Hydrostatic pressure at each point of the path's file, by name, kPa; `[n_frames]` each."""
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings, force and position over time with Matplotlib.

        - `axes`: three axes to draw in; new ones unless given.

        Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
        Matplotlib, and `Error` for another number of axes.
        """
    def __len__(self) -> int: ...

@final
class Pressed:
    """A simulated press, from first touch to full depth: the result of `Gel.press`. Each frame is
    deeper than the one before.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    @property
    def depth_mm(self) -> _Float:
        """Depth below first touch, mm; `[n_frames]`. The first frame is the untouched gel."""
    @property
    def force_n(self) -> _Float:
        """Force of the indenter into the gel, N; `[n_frames]`."""
    @property
    def readings_kpa(self) -> _Float:
        """Port pressure of each taxel: the hydrostatic pressure in the gel over the port, kPa;
        `[n_frames, n_taxels]`. An ideal barometer without gain, delay and relaxation would read
        this. A trained `Twin` predicts what a real one reads.
        """
    def _repr_svg_(self) -> str:
        """The picture that a notebook shows: readings and force over depth, as the text of an SVG
        file.
        """
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings and force over depth with Matplotlib.

        - `axes`: two axes to draw in; new ones unless given.

        Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
        Matplotlib, and `Error` for another number of axes.
        """

@final
class PressureMap:
    """A pressure map: the readings of a few taxels, interpolated over the gel, on 96 columns and 64
    rows. A notebook shows its picture.

    - `sensor`: the sensor.
    - `readings_kpa`: readings above the unloaded baseline, kPa; `[n_taxels]`. A taxel whose reading
      is NaN or masked is left out: the map is interpolated from the other taxels. It is NaN
      everywhere if there is none.
    - `provenance`: provenance of the readings: `"real"`, `"emulated"` or `"simulated"`.

    Raises `Error` if the number of readings is not the number of taxels, and for an infinite
    reading.
    """
    def __new__(cls, sensor: Sensor, readings_kpa: _Floats, provenance: _Provenance) -> PressureMap: ...
    @property
    def provenance(self) -> _Provenance:
        """Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def pressure_kpa(self) -> _Float:
        """Pressure above the baseline, kPa; `[n_rows, n_columns]`, the row of smallest y first. The
        grid spans the box that contains the gel (`Sensor.bounds_mm`).
        """
    @property
    def missing(self) -> list[str]:
        """Names of the taxels without a reading. The map was made without them."""
    def _repr_svg_(self) -> str:
        """The picture that a notebook shows: the text of an SVG file."""
    def save(self, path: _Path) -> None:
        """Draws the map into a file, and marks the taxels that have a reading.

        - `path`: path of the file, with the ending `.svg` or `.png`.

        Raises `Error` for a name with another ending, and for a file that cannot be written.
        """
    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the map in the gel's plane with Matplotlib, with a scale in kPa.

        - `axes`: the axes to draw in; new axes unless given.

        Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
        Matplotlib.
        """

@final
class Reader:
    """Reads a sensor frame by frame: on an I²C bus of Linux (`Reader.open`), over a serial port
    (`Reader.serial`), from UDP datagrams (`Reader.udp`), from a log (`Reader.replay`), or an
    emulated sensor (`Reader.emulated`).

    The sensor is read on a thread of its own until `close` or the end of a `with` block. Iteration
    returns a `Reading` for each frame as it comes. Up to 256 frames wait for a slow caller; more
    are missed. Other Python threads run during the wait for a frame, and Ctrl-C ends it.
    """
    @staticmethod
    def open(bus: _Path, sensor: Sensor, *, counts_per_pa: _Count | None = None) -> Reader:
        """Reads a sensor on an I²C bus. The call takes half a second; Ctrl-C ends the wait. Nothing
        may touch the sensor during the call, because the first frames make the tare.

        - `bus`: path of the bus, such as `/dev/i2c-1`.
        - `sensor`: the sensor.
        - `counts_per_pa`: scale of the barometers, counts per Pa, confirmed by a person who knows
          the parts; that of the description unless given.

        Raises `Error` for a bus that cannot be opened, for a sensor that does not answer or does
        not read the pressure of free air, and for barometers whose scale nobody has confirmed.
        """
    @staticmethod
    def serial(port: str, line: _Path, sensor: Sensor) -> Reader:
        """Reads the frames that a microcontroller writes to a serial port. Nothing may touch the
        sensor during the call, because the first frames make the tare.

        - `port`: name of the port, such as `/dev/ttyACM0` or `COM3`.
        - `line`: path of the line description (TOML), which says how to read the frames.
        - `sensor`: the sensor.

        Raises `Error` for a port that cannot be opened, for a line description that is wrong or of
        another number of taxels, and for a line on which no frame comes for 3 s. The message says
        what came instead.
        """
    @staticmethod
    def udp(address: str, line: _Path, sensor: Sensor) -> Reader:
        """Reads frames from datagrams (UDP).

        - `address`: an address of this computer, such as `"0.0.0.0:9000"`.
        - `line`: path of the line description (TOML), which says how to read the frames.
        - `sensor`: the sensor.

        Raises `Error` as `serial` does.
        """
    @staticmethod
    def replay(log: _Path, sensor: Sensor) -> Reader:
        """Replays the frames of a log (MCAP) at their own pace. Their provenance is that of the log:
        `"real"` or `"emulated"`. After the last frame `read` raises `Error`.

        - `log`: path of the log.
        - `sensor`: the sensor.

        Raises `Error` for a log that cannot be read, has no frames, or is of other taxels than
        those of the sensor.
        """
    @staticmethod
    def emulated(sensor: Sensor) -> Reader:
        """Reads an emulated sensor in real time: registers on an emulated bus, while a ball that
        wanders about presses the gel. The call takes half a second; Ctrl-C ends the wait.

        - `sensor`: the sensor.

        Raises `Error` for a sensor whose description does not say how its taxels are wired.
        """
    @property
    def provenance(self) -> Literal["real", "emulated"]:
        """Provenance of the readings: `"real"` or `"emulated"`."""
    @property
    def taxels(self) -> list[str]:
        """Names of the taxels, in the order of every reading."""
    @property
    def notes(self) -> list[str]:
        """Remarks from when the sensor was switched on, one sentence each."""
    def remarks(self) -> list[str]:
        """Remarks about what came on the connection so far besides frames, with counts: incomplete
        lines, missing frames. Empty if there was nothing else, and for a reader that is closed.
        """
    def compensate(self, temperature: _Path) -> None:
        """Compensates the readings for the drift of the zeros with temperature. Nothing may touch the
        sensor during the call, because the next frames make a new tare.

        - `temperature`: path of a file (TOML) that `twintac characterize` made.

        Raises `Error` for a file that is wrong or of another sensor, and for a reader that is
        closed.
        """
    def warmer_k(self) -> float | None:
        """Temperature change since the tare of the chip that changed most, K; negative if it is
        colder; `None` without temperatures, and for a reader that is closed. Zeros drift with
        temperature.
        """
    def read(self) -> Reading:
        """Waits for the next frame and returns it.

        Raises `Error` for a sensor that has failed for 2 s without a break or was silent for 3 s,
        and for a reader that is closed.
        """
    def close(self) -> None:
        """Stops reading, within a second even if the bus hangs. A closed reader cannot read again.
        Closing it again does nothing.
        """
    def __iter__(self) -> Reader: ...
    def __next__(self) -> Reading: ...
    def __enter__(self) -> Reader:
        """Returns the reader itself."""
    def __exit__(self, *_error: object) -> None:
        """Closes the reader."""

@final
class Reading:
    """A frame of a sensor: the result of `Reader.read`."""
    @property
    def provenance(self) -> Literal["real", "emulated"]:
        """Provenance of the readings: `"real"` or `"emulated"`."""
    @property
    def sequence(self) -> int:
        """Number of the frame, from 0, among all frames that were requested from the sensor. Missing
        numbers are frames that were missed or that the bus did not deliver. The first frames made
        the tare.
        """
    @property
    def time_s(self) -> float:
        """Time at which the taxels were triggered, s since the sensor was switched on."""
    @property
    def readings_kpa(self) -> _Float:
        """Readings above those of the untouched sensor, kPa; `[n_taxels]`. NaN for a taxel without a
        usable reading.
        """
    @property
    def is_valid(self) -> _Bool:
        """Whether each taxel's reading is usable; `[n_taxels]`."""
    @property
    def faults(self) -> list[str | None]:
        """Why a taxel's reading is not usable, in a word or two; `[n_taxels]`. `None` for a taxel that
        works.
        """
    @property
    def temperatures_c(self) -> _Float:
        """Temperatures of the barometers, °C; `[n_taxels]`. NaN for one without a temperature."""

@final
class Recording:
    """Recorded presses of one sensor: a real or an emulated one, or simulated presses. `len()` is the
    number of presses.
    """
    @staticmethod
    def load(path: _Path) -> Recording:
        """Reads a Parquet file that a run or `save` wrote. Ctrl-C ends the wait.

        Raises `Error` with the file if it is not a recording, is damaged, or cannot be read.
        """
    @staticmethod
    def import_csv(description: _Path, *paths: _Path) -> Recording:
        """Reads CSV files of any laboratory. Ctrl-C ends the wait.

        - `description`: path of the import description (TOML, see the folder `imports`), which says
          what each column means, and its unit.
        - `paths`: paths of the CSV files.

        Raises `Error` with file, line and field: of the import description, or of the cell that
        cannot be read.
        """
    @staticmethod
    def guess_import(path: _Path) -> str:
        """Guesses an import description of a CSV file, for `import_csv`.

        - `path`: path of the CSV file.

        Returns the text of a TOML file, with a comment on each guess.

        Raises `Error` with the file if it cannot be read or has no rows of numbers.
        """
    @property
    def imported(self) -> list[dict[str, Any]]:
        """What `import_csv` found in each file and left out of it: for each file a dict with `file`,
        `rows_read`, `rows_dropped`, `rows_incomplete`, `missing_readings`, `clipped_readings`,
        `outliers`, `presses`, `presses_dropped`, `shared_frames`, `unread_columns`, `warnings`.
        Empty for other recordings.
        """
    @property
    def sensor(self) -> str:
        """Name of the sensor in its description."""
    @property
    def provenance(self) -> _Provenance:
        """Provenance of the numbers: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def taxels(self) -> list[str]:
        """Names of the taxels, in the order of every row of readings."""
    @property
    def presses(self) -> list[str]:
        """Names of the presses, in the order in which they were made."""
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """The columns of the Parquet file as NumPy arrays, by name, with a value for each frame:

        - `press_index`, `press`, `mounting`, `indenter`, `control`, `provenance`: properties of the
          press, the same in all its frames. `mounting` is the installation of the indenter.
        - `time_s`: time, s.
        - `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`: pose of the indenter in the gel's frame:
          position, mm, and quaternion.
        - `force_n`: force into the gel, N; NaN if it is not known.
        - `<taxel>_kpa`, `<taxel>_raw`, `<taxel>_valid`: reading of the taxel, kPa; the reading as
          it was recorded; whether it is usable. A missing reading is NaN.
        """
    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a `pandas.DataFrame`."""
    def to_polars(self) -> polars.DataFrame:
        """The columns as a `polars.DataFrame`, through Arrow. `polars.DataFrame(recording)` does the
        same.
        """
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The columns for any library that reads Arrow through its PyCapsule interface:
        `polars.DataFrame(recording)`, `pyarrow.table(recording)`,
        `pandas.DataFrame.from_arrow(recording)`, or DuckDB. Types are those of `columns`. Texts are
        strings. An unknown force and a missing reading are null. The schema is always this one;
        `requested_schema` is ignored.
        """
    def save(self, path: _Path) -> None:
        """Writes a Parquet file. The file appears whole or not at all.

        Raises `Error` with the file if it cannot be written.
        """
    def save_lerobot(self, folder: _Path, *, how_made: str = "") -> dict[str, int]:
        """Writes a LeRobot data set, version 3.0: presses are episodes, indenters are tasks.

        - `folder`: path of a folder that does not exist yet.
        - `how_made`: text for the data card that says how the data were made.

        Returns the numbers of episodes, frames and tasks (`episodes`, `frames`, `tasks`), the
        frames per second (`fps`), and the rate from which frames were resampled, Hz
        (`resampled_from_hz`; `None` if they were evenly spaced).

        Raises `Error` for a folder that exists or cannot be written.
        """
    def characterize(self, sensor: Sensor, folder: _Path | None = None) -> dict[str, Any]:
        """Characterizes the sensor from the presses: sensitivity, noise, hysteresis and other figures.
        Ctrl-C ends the wait.

        - `sensor`: the sensor.
        - `folder`: folder for the report and the data sheet; without it, they are not written.

        Returns the figures as `twintac characterize --json` prints them. A figure that the presses
        do not show is replaced by the reason.

        Raises `Error` for a sensor whose taxels are not those of the recording.
        """
    def plot(self, press: _Count = 0, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws one press over time with Matplotlib: usable readings, force and height of the
        indenter.

        - `press`: index of the press, from 0.
        - `axes`: three axes to draw in; new ones unless given.

        Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
        Matplotlib, and `Error` for a press that does not exist or another number of axes.
        """
    def __len__(self) -> int: ...

@final
class Dataset:
    """Many simulated presses, made in shards by any number of processes and machines. A press depends
    only on the seed and on its own name. The merged file therefore has the same bytes for every
    division into shards.

    - `sensor`: path of the sensor description (TOML); unless given, the sensor of the twin, or
      PhysTac without a twin.
    - `protocol`: path of the press protocol (TOML); random presses unless given.
    - `indenters`: names of the indenters of random presses; all indenters of the sensor unless
      given. A protocol names its own.
    - `n_presses`: number of presses; unless given, 1000 random presses, rounded up to the same
      number for each indenter, or all presses of the protocol.
    - `seed`: seed of all random choices.
    - `fast`: the surrogate of the gel: `True` for the built-in one of PhysTac or of its fingertip,
      or the path of a file. Without it, the gel is computed with finite elements.
    - `twin`: folder of the twin that computes the readings; unless given, readings are the
      pressures at the ports.
    - `variation`: path of the sensor variation (TOML), from which each press gets an imperfect
      sensor of its own. It needs `fast`.
    - `settings`: path of a file (TOML) that may have a table `[simulate]` with settings of the
      simulation; not together with `twin`.

    Raises `Error` with file, line and field if a file is wrong, and for arguments that do not go
    together.
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
        variation: _Path | None = None,
        settings: _Path | None = None,
    ) -> Dataset: ...
    @property
    def n_presses(self) -> int:
        """Number of presses."""
    @property
    def identity(self) -> str:
        """The text of `dataset.toml`: the inputs of the data set. Data sets with the same text are the
        same.
        """
    def make(self, folder: _Path, shard: _Count = 1, of: _Count = 1, *, progress: Progress = None) -> dict[str, Any]:
        """Makes one shard in a folder, unless it is complete there. The shard appears whole or not at
        all. Ctrl-C ends the call before the next press.

        - `folder`: path of the folder.
        - `shard`: number of the shard, from 1 to `of`.
        - `of`: number of shards.
        - `progress`: display of the progress, see `Progress`.

        Returns the manifest of the shard, with the paths `parquet` and `manifest_file`.

        Raises `Error` for a folder that holds another data set or another division into shards, and
        for a shard that is not from 1 to `of`.
        """
    @staticmethod
    def check(folder: _Path, *, progress: Progress = None) -> dict[str, Any]:
        """Checks that all shards in a folder are complete and unchanged.

        - `folder`: path of the folder.
        - `progress`: display of the progress, see `Progress`.

        Returns the numbers of shards, presses and frames, and the presses that were left out.

        Raises `Error` that names the shard that is missing or differs.
        """
    @staticmethod
    def merge(folder: _Path, file: _Path | None = None, *, progress: Progress = None) -> dict[str, Any]:
        """Checks all shards as `check` does, and writes all presses as one recording.

        - `folder`: path of the folder.
        - `file`: path of the recording; `presses.parquet` in the folder unless given.
        - `progress`: display of the progress, see `Progress`.

        Returns what `check` returns.

        Raises `Error` as `check` does, and for a file that cannot be written.
        """

@final
class Twin:
    """A trained twin: it predicts the readings of one sensor's barometers while its gel is pressed.

    `predict` computes a whole press, `predict_along` a path, `at` one location frame by frame, and
    `states` many sensors together from the pressures at their ports.
    """
    @staticmethod
    def load(folder: _Path) -> Twin:
        """Loads a twin. A pickle contains the path of the folder. Unpickling loads the same twin from
        there, or raises `Error`.

        - `folder`: the folder of a run's twin: `<run>/model` (`Run.model_folder`).

        Raises `Error` for a folder that holds no twin, or a damaged one.
        """
    @property
    def sensor(self) -> Sensor:
        """The sensor of the twin."""
    @property
    def trained_on(self) -> _Provenance:
        """Provenance of the recordings on which the twin was trained: `"real"`, `"emulated"` or
        `"simulated"`. Its predictions are `"simulated"`.
        """
    def predict(self, press: Press) -> Prediction:
        """Predicts the readings along a press, at the frame rate of the sensor. Test setup and gel are
        as they were fitted in the training. The call takes a few seconds; Ctrl-C ends the wait.

        - `press`: the press.

        Raises `Error` for an indenter that the sensor does not have, and for a location that cannot
        be pressed.
        """
    def predict_along(self, path: PressPath, *, progress: Progress = None) -> Prediction:
        """Predicts the readings along a path. The gel is computed by finite elements, frame by frame,
        with sliding and tilting; a frame takes from some milliseconds to seconds. Ctrl-C ends the
        call before the next frame. If the path cannot be followed to its end, `Prediction.failure`
        says why.

        - `path`: the path. Its points are not read.
        - `progress`: display of the progress, see `Progress`.

        Raises `Error` for an indenter that the sensor does not have, and for a path that misses the
        gel.
        """
    def at(self, press: Press) -> TwinAtPlace:
        """The twin at the location of a press and down to its depth, to be stepped with depths as they
        come. The call takes a second; Ctrl-C ends the wait. A step then takes a microsecond.

        - `press`: the press.

        Raises `Error` as `predict` does.
        """
    def states(self, n_sensors: _Count = 1) -> TwinState:
        """Twins of many sensors, to be stepped together with the pressures at their ports: for
        programs that compute the gel themselves.

        - `n_sensors`: number of sensors, from 1 to as many as give ten million readings.

        Raises `Error` for a number out of this range.
        """

@final
class Prediction:
    """Predicted readings along a press or a path: the result of `Twin.predict` and
    `Twin.predict_along`. Every array has a row for each frame.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    @property
    def failure(self) -> str | None:
        """Why the frames end before the path does; `None` if they reach its end, and for a press."""
    @property
    def place_mm(self) -> _Float:
        """Location of the indenter's origin in the gel's plane, x and y, mm; `[n_frames, 2]`."""
    @property
    def time_s(self) -> _Float:
        """Time since the start of the press or the path, s; `[n_frames]`."""
    @property
    def depth_mm(self) -> _Float:
        """Depth below first touch, which is at the contact height of the recordings' test setup, mm;
        negative above the gel; `[n_frames]`.
        """
    @property
    def force_n(self) -> _Float:
        """Force of the indenter into the gel, N; `[n_frames]`."""
    @property
    def readings_kpa(self) -> _Float:
        """Predicted readings of the barometers above those of the untouched sensor, kPa;
        `[n_frames, n_taxels]`.
        """
    @property
    def simulated(self) -> _Bool:
        """Whether the frame was simulated; `[n_frames]`. A frame that is deeper than the gel could be
        pressed in the simulation was not: it has the last simulated pressures.
        """
    @property
    def half_width_kpa(self) -> _Float | None:
        """Half width of the 90 % interval around each reading, kPa; `[n_frames, n_taxels]`. `None` for
        a twin without intervals.
        """
    @property
    def ood_score(self) -> _Float | None:
        """Out-of-distribution (OOD) score of the contact: its distance from the training set, without
        unit; `[n_frames]`. `None` for a twin without intervals.
        """
    @property
    def is_out_of_distribution(self) -> _Bool | None:
        """Whether the contact is so far out of distribution that readings and intervals cannot be
        trusted; `[n_frames]`. `None` for a twin without intervals.
        """
    def plot(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draws readings with their 90 % intervals, force and depth over time with Matplotlib. The
        background is grey where the prediction cannot be trusted: where it was not simulated, or is
        out of distribution.

        - `axes`: three axes to draw in; new ones unless given.

        Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
        Matplotlib, and `Error` for another number of axes.
        """
    def __len__(self) -> int: ...

@final
class TwinAtPlace:
    """A twin whose sensor is pressed at one location, stepped with depths. `Twin.at` returns it."""
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def step(self, since_previous_s: float, depth_mm: float) -> _Float:
        """Computes one more frame.

        - `since_previous_s`: time since the last frame, s. The first frame ignores it.
        - `depth_mm`: depth below first touch, mm; negative above the gel.

        Returns the predicted readings of the barometers above their zero, kPa; `[n_taxels]`.

        Raises `Error` for a time below 0, and for a depth that is not finite.
        """
    @property
    def force_n(self) -> float:
        """Force of the indenter into the gel at the last frame, N."""
    @property
    def half_width_kpa(self) -> _Float | None:
        """Half widths of the 90 % intervals around the last readings, kPa; `[n_taxels]`. `None` for a
        twin without intervals.
        """
    @property
    def ood_score(self) -> tuple[float, bool] | None:
        """Out-of-distribution (OOD) score of the last contact, without unit, and whether the contact
        is so far out of distribution that readings and intervals cannot be trusted. `None` for a
        twin without intervals.
        """
    @property
    def max_depth_mm(self) -> float:
        """Depth below first touch at which the table over depth ends, mm. At larger depths, its last
        pressures are used.
        """
    def tare(self) -> None:
        """Sets the present readings to zero, as a tare of a real sensor does."""
    def rest(self) -> None:
        """Resets the gel to rest until the next frame: readings no longer depend on earlier presses.
        The zero stays.
        """

@final
class TwinState:
    """Twins of many sensors, stepped together with the pressures at their ports. `Twin.states` returns
    them. `len()` is the number of sensors.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def step(self, since_previous_s: float, pressure_kpa: _Floats) -> _Float:
        """Computes one more frame of every sensor.

        - `since_previous_s`: time since the last frame, s. Sensors whose gel has rested ignore it.
        - `pressure_kpa`: pressures at the ports, kPa; `[n_sensors, n_taxels]`.

        Returns the predicted readings of the barometers above the zero that `tare` or
        `tare_untouched` has set, else above the twin's own zero, kPa; `[n_sensors, n_taxels]`.

        Raises `Error` for a time below 0, and for pressures of another shape or that are not
        finite.
        """
    def tare(self) -> None:
        """Sets the present readings to zero, as a tare of a real sensor does."""
    def tare_untouched(self) -> None:
        """Sets the readings of an untouched sensor to zero."""
    def rest(self, sensor: _Count) -> None:
        """Resets the gel of one sensor to rest until its next frame: readings no longer depend on
        earlier presses. The zero stays.

        - `sensor`: index of the sensor, from 0.

        Raises `Error` for an index out of range.
        """
    def __len__(self) -> int: ...

@final
class Run:
    """A folder in which recordings become an evaluated twin and a report. Finished stages are kept: a
    call with the same inputs does only what is missing.

    `start`, `import_csv` and `finish` make a run, `demo` makes one without data, and `open` opens
    an existing one.
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
        """Starts a run, or continues the one in the folder with new settings. The same recordings,
        settings and `seed` give the same twin.

        - `folder`: path of the folder.
        - `sensor`: the sensor.
        - `source`: a text that says where the presses come from.
        - `seed`: seed of all random choices.
        - `settings`: settings that differ from the default ones, with a dictionary for each stage:
          `{"train": {"epochs": 40}}`.

        Raises `Error` for a setting that is not allowed (its `field` names the setting), and for a
        folder that cannot be written.
        """
    @staticmethod
    def open(folder: _Path) -> Run:
        """Opens an existing run.

        Raises `Error` for a folder that is not a run.
        """
    @staticmethod
    def demo(folder: _Path, *, seed: _Count = 1, progress: Progress = None) -> Run:
        """Starts a demo run, and makes its recordings: PhysTac, pressed on the emulated bench.
        `finish` does the rest. Both together take a minute. Ctrl-C stops the call.

        - `folder`: path of the folder.
        - `seed`: seed of all random choices.
        - `progress`: display of the progress, see `Progress`.
        """
    def import_csv(self, description: _Path, *paths: _Path) -> None:
        """Makes the recordings of the run from CSV files of any laboratory, as `Recording.import_csv`
        does.

        - `description`: path of the import description (TOML), which says how to read the files.
        - `paths`: paths of the CSV files.

        Raises `Error` with file, line and field: of the import description, or of the cell that
        cannot be read.
        """
    def finish(self, *, progress: Progress = None) -> dict[str, Any]:
        """Runs all stages after the recordings: simulation, alignment, training, evaluation, report.
        Ctrl-C stops the call before the next step; the same call continues from there.

        - `progress`: display of the progress, see `Progress`.

        Returns the figures of the evaluation, as in `metrics.json`.

        Raises `Error` for a run without recordings, and for presses on which no twin can be
        trained.
        """
    def recording(self) -> Recording:
        """The recorded presses.

        Raises `Error` for a run without recordings.
        """
    @property
    def folder(self) -> Path:
        """The run's folder."""
    @property
    def model_folder(self) -> Path:
        """The folder of the twin that was trained on all presses. `Twin.load` reads it."""
    @property
    def report_path(self) -> Path:
        """Path of the report on the evaluation of the twin: `report.html` in the folder. It exists
        after `finish`.
        """

@final
class Pose:
    """A pose: the rigid transform from an inner frame of reference to an outer one, such as from an
    indenter's frame to the gel's.

    - `position_mm`: origin of the inner frame in the outer one, mm.
    - `quaternion`: rotation from the inner to the outer frame, `(x, y, z, w)`, of length 1; no
      rotation unless given.

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
    """A rigid shape that presses the gel. `edge_radius_mm` rounds every convex edge and moves no face.
    Prismatic shapes have their profile in the xy plane and stand on z = 0. All lengths are in mm.

    Each function that makes a shape raises `Error` for a length that is not allowed; its `field`
    names the length.
    """
    @staticmethod
    def sphere(radius_mm: float) -> Shape:
        """A ball that stands on its origin: its centre is `radius_mm` above the origin."""
    @staticmethod
    def cylinder(radius_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """A flat-ended upright cylinder. Its rims are rounded with `edge_radius_mm`."""
    @staticmethod
    def box(size_mm: _Floats, edge_radius_mm: float) -> Shape:
        """A box with the full size `size_mm` along x, y and z, mm. Its edges are rounded with
        `edge_radius_mm`.
        """
    @staticmethod
    def x(length_mm: float, width_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """Two crossed bars in the shape of an X (a plus, rotated by 45°). Each bar is `length_mm` long
        and `width_mm` wide.
        """
    @staticmethod
    def ring(
        outer_radius_mm: float, inner_radius_mm: float, height_mm: float, edge_radius_mm: float
    ) -> Shape:
        """An upright tube."""
    @staticmethod
    def triangle(side_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """An upright equilateral prism, with its centroid at the origin and one corner towards +x."""
    @staticmethod
    def wedge(angle_rad: float, length_mm: float, height_mm: float, edge_radius_mm: float) -> Shape:
        """A wedge like a roof upside down. It touches with its ridge, which lies along y. `angle_rad`
        is the full angle between its two faces, `length_mm` the length of the ridge, and
        `height_mm` the height from the ridge to the base.
        """
    @staticmethod
    def stl(path: _Path, *, unit: str | None = None, scale: float | None = None) -> Shape:
        """A closed triangle surface from an STL file. Its lowest point is moved to the height of the
        origin.

        - `path`: path of the file.
        - `unit`: unit of lengths in the file: `"mm"`, `"cm"`, `"m"` or `"inch"`; mm unless given.
        - `scale`: the length in mm of 1 in the file, instead of a `unit`.

        Raises `Error` with the file if it cannot be read, if its surface is not closed, or if its
        size is impossible in that unit.
        """
    @staticmethod
    def surface(vertices_mm: _Floats, triangles: _Integers) -> Shape:
        """A closed surface of triangles, which keeps its position.

        - `vertices_mm`: positions of the vertices, mm; `[n_vertices, 3]`.
        - `triangles`: indices of the three vertices of each triangle, counter-clockwise seen from
          outside; `[n_triangles, 3]`.

        Raises `Error` for arrays of another shape, for an index without a vertex, for a surface
        that is not closed, and for one of less than 0.1 mm along an axis, as lengths in metres make
        it.
        """
    @staticmethod
    def union(parts: Sequence[tuple[Shape, Pose]]) -> Shape:
        """Several shapes, joined rigidly. They may overlap.

        - `parts`: each shape with its pose in the frame of the whole.
        """
    @property
    def bounds_mm(self) -> _Float:
        """Lowest and highest corner of the smallest box along the shape's axes that contains the
        shape, mm; `[2, 3]`.
        """
    def signed_distance_mm(self, points_mm: _Floats) -> _Float:
        """Signed distances of points to the surface, negative inside. Ctrl-C ends the wait.

        - `points_mm`: points in the shape's own frame, mm; `[n_points, 3]`.

        Returns the distances, mm; `[n_points]`.

        Raises `Error` for an array of another shape, and for a point that is not finite.
        """

@final
class Body:
    """A shape in the form in which the surrogate of the gel can press it: its signed distances are
    sampled once.

    - `shape`: the shape. Sampling takes from a millisecond to a second, for a surface of many
      triangles.
    """
    def __new__(cls, shape: Shape) -> Body: ...

@final
class FastGel:
    """The surrogate of a sensor's gel: neural networks instead of finite elements. A reading takes
    microseconds. The gel may be touched by bodies of any shape.

    `FastGel.phystac()` and `FastGel.phystac_tip()` are built in. `twintac fast train` makes the
    surrogate of another sensor, and `FastGel.load` reads it. A surrogate has no viscoelastic
    relaxation. It has no friction either, which `Friction` adds.
    """
    @staticmethod
    def phystac() -> FastGel:
        """The surrogate of PhysTac's gel, which is built in."""
    @staticmethod
    def phystac_tip() -> FastGel:
        """The surrogate of the gel of PhysTac's fingertip, which is built in."""
    @staticmethod
    def load(path: _Path) -> FastGel:
        """Reads a surrogate from a file that `twintac fast train` has made.

        Raises `Error` with the file if it is not a surrogate, or cannot be read.
        """
    def to_bytes(self) -> bytes:
        """The surrogate as the bytes of a file that `load` reads:
        `Path("gel.safetensors").write_bytes(gel.to_bytes())`.
        """
    @property
    def sensor(self) -> str:
        """Name of the sensor that the surrogate was trained for."""
    def check(self, sensor: Sensor) -> None:
        """Checks that this is the surrogate of a sensor's gel: shape, material, shell and ports must
        be the same. Names, indenters, limits, the read-out, relaxation and friction may differ.

        Raises `Error` for another gel. The message says all that differs.
        """
    @property
    def ports_mm(self) -> _Float:
        """Locations of the ports in the gel's plane, mm; `[n_taxels, 2]`."""
    def with_ports(self, places_mm: _Floats) -> FastGel:
        """The same surrogate with its ports at other locations, for example closer together than the
        taxels.

        - `places_mm`: locations on the base of the gel, x and y, mm; `[n_ports, 2]`. A port has to
          be within the gel there. With boxes cast into the gel, the taxels are the only locations.

        Raises `Error` for an array of another shape, for no location or more than a million, and
        for a location where the surrogate was not trained.
        """
    def reader(self) -> FastReader:
        """Returns a reader for one sensor. Each thread needs its own reader."""
    def batch(self, bodies: Sequence[Body], n_threads: _Count | None = None) -> FastBatch:
        """Returns a reader for many sensors in one call.

        - `bodies`: the bodies that may touch the sensors, at least one.
        - `n_threads`: number of threads, 1 to 1024; as many as there are cores unless given.

        Raises `Error` if there is no body, and for a number of threads out of this range.
        """

@final
class FastReader:
    """Evaluates the surrogate for one sensor. `FastGel.reader` returns it."""
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def read(self, bodies: Sequence[tuple[Body, Pose]]) -> tuple[_Single, _Single]:
        """Computes the pressures at the ports, and force and torque on the gel, under bodies.

        - `bodies`: each body with its pose in the gel's frame (`gel_from_body`).

        Returns the pressure at each port, kPa, `[n_taxels]`, and the wrench, `[6]`: force on the
        gel, N, and torque about the centre of the top of the gel's bounding box, N mm.
        """
    def ood_score(self, bodies: Sequence[tuple[Body, Pose]]) -> float:
        """The out-of-distribution (OOD) score of a contact, without unit. It is 0 if nothing is near
        the gel. Above 1, readings and force may be wrong: the shape is unlike those of the training
        set, the contact is deeper than the training presses, or too few training presses were
        there.

        - `bodies`: each body with its pose in the gel's frame (`gel_from_body`).
        """

@final
class Friction:
    """Friction of one body on one sensor's gel, frame by frame: the body shears the top of the gel
    until it slips. At first, there is no contact.

    - `sensor`: the sensor.
    - `coefficient`: Coulomb's coefficient, 0 or more.

    Raises `Error` for a coefficient that is negative or not finite.
    """
    def __new__(cls, sensor: Sensor, coefficient: float) -> Friction: ...
    def read(self, reader: FastReader, body: Body, gel_from_body: Pose) -> tuple[_Single, _Single]:
        """Computes one more frame of a sensor that this body alone touches.

        - `reader`: the reader of the sensor's surrogate.
        - `body`: the body.
        - `gel_from_body`: pose of the body in the gel's frame.

        Returns what `FastReader.read` returns, with friction.

        Raises `Error` for the reader of another gel.
        """
    def release(self) -> None:
        """Ends the contact: the next frame begins without friction."""

@final
class FastBatch:
    """Evaluates the surrogate for many sensors of one kind in one call. `FastGel.batch` returns it."""
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def read(
        self, gel_from_body: _Floats, body: _Integers | None = None, ends: _Integers | None = None
    ) -> tuple[_Single, _Single]:
        """Computes the pressures at the ports, and force and torque on each gel, under the bodies that
        touch it. The numbers of a sensor do not depend on the other sensors.

        - `gel_from_body`: poses of the bodies in the gel's frame, one row for each touch, those of
          the first sensor first: position, mm, and quaternion (x, y, z, w), `[n_touches, 7]`; or
          the position alone, `[n_touches, 3]`.
        - `body`: indices of the bodies, `[n_touches]`; the first body unless given.
        - `ends`: the end of each sensor's touches in the list, `[n_sensors]`; one touch for each
          sensor unless given.

        Returns the pressures at the ports, kPa, `[n_sensors, n_taxels]`, and the wrenches,
        `[n_sensors, 6]`: force on each gel, N, and torque about the centre of the top of its
        bounding box, N mm.

        Raises `Error` for an array with another shape or with numbers that are not allowed; its
        `field` names the array.
        """

@final
class SensorVariation:
    """Sensor variation: the distributions from which each sensor's deviations from a perfect sensor
    are drawn.

    Keywords are the fields of the table `[variation]` in a file. Each is 0 unless given;
    `SensorVariation()` is a perfect sensor. A *deviation* is the standard deviation of a normal
    distribution about zero.

    - `gain_deviation`: deviation of each taxel's gain, as a fraction of the gain.
    - `growth_deviation_per_kpa`: deviation of the relative growth of each taxel's gain with its
      reading, 1/kPa.
    - `offset_deviation_kpa`: deviation of each taxel's zero, kPa.
    - `drift_kpa_per_k`, `drift_deviation_kpa_per_k`: temperature drift that all taxels share, and
      the deviation of each taxel's drift from it, kPa/K.
    - `temperature_deviation_k`, `temperature_time_s`: deviation of the temperature from that of the
      tare, K, and the time constant with which the temperature fluctuates, s, above 0 if the
      deviation is.
    - `cross_talk`, `cross_talk_deviation`: fraction of every other taxel's pressure that a taxel
      reads in addition, beyond what the gel spreads, and its deviation from pair to pair.
    - `noise_deviation_kpa`: deviation of the noise of each reading, kPa.
    - `quantum_kpa`: resolution of the readings, kPa.
    - `hysteresis`: half of the gap between loading and unloading, as a fraction of the reading, 0
      to 1.
    - `dead_chance`, `stuck_chance`, `late_chance`: probabilities, 0 to 1, that a taxel always reads
      zero, that it stays at its first reading, and that its readings are late by one frame. Their
      sum is at most 1.
    - `rate_hz`, `jitter`: frames that the bus delivers in a second, Hz (0: one at each step), and
      the deviation of the time between frames, as a fraction of it.
    - `modulus_deviation`: deviation of the logarithm of the gel's modulus from that of the
      surrogate's gel. Forces and pressures at given poses are proportional to it.
    - `height_deviation_mm`, `place_deviation_mm`, `turn_deviation_rad`, `tilt_deviation_rad`:
      deviations of the installation of the sensor: height, position, rotation about the vertical
      axis, and tilt, mm and radians.

    Raises `Error` for a value that is not allowed; its `field` names the keyword.
    """
    def __new__(cls, **fields: _Number) -> SensorVariation: ...
    @staticmethod
    def load(path: _Path) -> SensorVariation:
        """Reads a file (TOML) with the table `[variation]`. `twintac fast variation` makes such
        files.

        Raises `Error` with file, line and field if the file is wrong, and with the file if it
        cannot be read.
        """
    @staticmethod
    def usual() -> SensorVariation:
        """The sensor variation of a working sensor, the default of the tasks in `twintac.gymnasium`.
        Gains and their growth, noise, resolution and frame rate are those found on the emulated
        PhysTac; the drift of the zeros, hysteresis, installation and faults are assumed.
        """
    def fields(self) -> dict[str, float]:
        """All fields by name, including those that are 0."""
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Coupling:
    """The forces between gels and bodies that move freely: friction, and the damping of the gel, which
    brings a body that hits it to rest.

    - `sensor`: the sensor.
    - `friction`: Coulomb's coefficient of each body on each gel, 0 or more.
    - `retardation_s`: time constant `t` of the gel's damping, s. The force is `F + t dF/dt` with
      the elastic force `F`, as of a Kelvin-Voigt solid. 0 for a gel without damping.

    Raises `Error` for a number that is not allowed; its `field` names the argument.
    """
    def __new__(cls, sensor: Sensor, *, friction: float, retardation_s: float = 0.0) -> Coupling: ...

@final
class SensorBatch:
    """Many sensors of one kind, each with its own deviations, stepped in one call. Their gels are at
    rest at first. `len()` is the number of sensors.

    - `gel`: the surrogate of their gel.
    - `bodies`: the bodies that may touch them, at least one.
    - `n_sensors`: number of sensors, from 1 to as many as give ten million readings: 1,250,000
      sensors of eight taxels.
    - `variation`: the sensor variation from which each sensor's deviations are drawn; perfect
      sensors unless given.
    - `twin`: the twin whose barometers they have, with its gains and viscoelastic relaxation;
      readings are the pressures at the ports unless given.
    - `coupling`: the forces between bodies and gels; neither friction nor damping unless given.
    - `seed`: seed of the deviations. Sensor `n` is the same for the same seed, whatever the other
      sensors are.
    - `n_threads`: number of threads, at most 1024; as many as there are cores unless given. Results
      do not depend on it.

    Raises `Error` for a twin or a coupling of another gel, if there is no body, and for a number
    out of its range.
    """
    def __new__(
        cls,
        gel: FastGel,
        bodies: Sequence[Body],
        n_sensors: _Count,
        *,
        variation: SensorVariation | None = None,
        twin: Twin | None = None,
        coupling: Coupling | None = None,
        seed: _Count = 0,
        n_threads: _Count | None = None,
    ) -> SensorBatch: ...
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    def set_bodies(self, bodies: Sequence[Body]) -> None:
        """Replaces the bodies that may touch the sensors. The gels keep the state of each touch under
        its `touch_id`.

        - `bodies`: the new bodies, at least one.

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
        """Computes one more step of every sensor.

        - `since_previous_s`: time since the last step, s.
        - `gel_from_body`, `body`, `ends`: the touches, as in `FastBatch.read`. Poses are in the
          frame of the sensor as described.
        - `touch_id`: an integer for each touch, which identifies the touching thing, `[n_touches]`.
          It is the same as long as it is the same thing, and differs between things on one sensor.
          Sensors with a `Coupling` need it: they keep the state of each touch under this number,
          whatever its position in the list and its body. The state of a touch that is not in the
          list is deleted.

        Returns the last readings that the bus of each sensor delivered, kPa,
        `[n_sensors, n_taxels]`, and the wrenches, `[n_sensors, 6]`: force on each gel, N, and
        torque about the centre of the top of its bounding box, N mm, in the frame of the sensor as
        it is installed.

        Raises `Error` for an argument with another shape or with numbers that are not allowed (its
        `field` names the argument), and if a thing touches one sensor twice. The sensors are then
        unchanged.
        """
    def slip_of_touches(self) -> _Single:
        """How fast each thing slipped over its gel in the last step, mm/s, along x and y of the gel,
        in the order of the touches, `[n_touches, 2]`: 0 while it sticks. Without a `Coupling` there
        are none: `[0, 2]`.
        """
    def read_ground_truth(self) -> _Single:
        """The readings of the last step without sensor variation, kPa, `[n_sensors, n_taxels]`."""
    def proximity(self) -> _Single:
        """How near the bodies were to each sensor in the last step, `[n_sensors]`: 1 where one
        touches, falling linearly to 0 where the nearest is 2 mm away or farther. Distances are
        those of points of the gel's surface, which are 2 mm apart on PhysTac. No readings depend on
        it: it is for rewards, and for sensors that measure proximity besides.
        """
    def wrench_of_touches(self) -> _Single:
        """Wrench of each touch by itself in the last step, in the order of the touches,
        `[n_touches, 6]`: force on the gel, N, and torque about the centre of the top of its
        bounding box, N mm, in the frame of the sensor as described. Without a `Coupling` there are
        none: `[0, 6]`.
        """
    def state(self, sensor: _Count) -> SensorState:
        """The state of one sensor. A sensor that is set back to it continues with the same bits.

        - `sensor`: index of the sensor, from 0.

        Raises `Error` for an index out of range.
        """
    def set_state(self, sensor: _Count, state: SensorState) -> None:
        """Sets one sensor to a state, its own or that of another sensor of such a batch.

        - `sensor`: index of the sensor, from 0.
        - `state`: the state.

        Raises `Error` for an index out of range, for the state of another kind of sensor or with
        another number of taxels, and for one with a twin if these sensors have none, or the
        reverse.
        """
    def rest(self, sensor: _Count) -> None:
        """Resets one sensor to rest until its next step. Its deviations stay.

        - `sensor`: index of the sensor, from 0.

        Raises `Error` for an index out of range.
        """
    def replace(self, sensor: _Count, number: _Count) -> None:
        """Replaces one sensor by another one at rest, whose deviations are drawn anew.

        - `sensor`: index of the sensor, from 0.
        - `number`: identifies the new sensor. Numbers below the number of sensors give the first
          sensors of the batch.

        Raises `Error` for an index out of range.
        """
    def __len__(self) -> int: ...

@final
class SensorState:
    """The state of one sensor of a `SensorBatch` at a moment: its deviations, the state of its noise,
    the relaxation of its twin, and the contacts of its gel. `SensorBatch.state` returns it.
    """
    def __copy__(self) -> SensorState:
        """Returns the object itself, which never changes."""
    def __deepcopy__(self, _memo: object, /) -> SensorState:
        """Returns the object itself, which never changes."""

@final
class Tasks:
    """Many environments of one task of reinforcement learning, each with its own sensor, stepped in
    one call. `len()` is the number of environments. `twintac.gymnasium` has them as Gymnasium
    environments, and describes observations, actions and rewards of each task.

    - `kind`: the task: `"ExploreShape"`, `"HoldForce"` or `"FollowEdge"`.
    - `n_environments`: number of environments, from 1 to as many as give ten million readings:
      1,250,000 with sensors of eight taxels.
    - `gel`: the surrogate of the gel; PhysTac's unless given.
    - `variation`: the sensor variation from which the sensor of each episode is drawn; that of
      working sensors unless given.
    - `autoreset`: when an environment whose episode has ended begins the next one: in the next step
      (`"NextStep"`), which ignores its action and has a reward of zero; in the same step
      (`"SameStep"`); or when `reset` is called (`"Disabled"`).
    - `n_threads`: number of threads, at most 1024; as many as there are cores unless given. Results
      do not depend on it.

    Raises `Error` for a task that does not exist, for a gel that the task cannot use, and for a
    number out of its range.
    """
    def __new__(
        cls,
        kind: str,
        n_environments: _Count,
        *,
        gel: FastGel | None = None,
        variation: SensorVariation | None = None,
        autoreset: Literal["NextStep", "SameStep", "Disabled"] = "NextStep",
        n_threads: _Count | None = None,
    ) -> Tasks: ...
    @property
    def provenance(self) -> _Simulated:
        """Provenance of all numbers: `"simulated"`."""
    @property
    def n_observed(self) -> int:
        """Length of an observation. Each of its numbers is from -10 to 10."""
    @property
    def n_actions(self) -> int:
        """Length of an action. Each of its numbers is from -1 to 1."""
    @property
    def figures(self) -> list[str]:
        """Names, with units, of the figures: true values of an environment that are not observed;
        `[n_figures]`.
        """
    def seed(self, seeds: Sequence[_Count | None] | npt.NDArray[np.integer[Any]]) -> None:
        """Sets the seeds of the environments. They take effect at the next reset.

        - `seeds`: a seed for each environment, from 0 to 2⁶⁴ - 1; with `None`, an environment keeps
          its seed.

        Raises `Error` for another number of seeds, and for a seed out of this range.
        """
    def reset(self, which: npt.ArrayLike | None = None) -> tuple[_Single, _Single]:
        """Begins the next episode of environments.

        - `which`: whether each environment is reset, `[n_environments]`; all of them unless given.

        Returns observations, `[n_environments, n_observed]`, and figures,
        `[n_environments, n_figures]`. They are zero for environments that are not reset.
        """
    def step(
        self, actions: _Floats
    ) -> tuple[_Single, _Float, _Bool, _Bool, _Single, tuple[_Single, _Single] | None]:
        """Computes one step of every environment.

        - `actions`: the actions, each number from -1 to 1; `[n_environments, n_actions]`.

        Returns observations, `[n_environments, n_observed]`; rewards, `[n_environments]`; whether
        the task has ended, `[n_environments]`; whether the time limit has ended the episode,
        `[n_environments]`; figures, `[n_environments, n_figures]`; and the last observations and
        figures of environments that began a new episode in the same step, or `None` if there are
        none.

        Raises `Error` for actions of another shape, or that are not finite.
        """
    def picture(self, environment: _Count) -> npt.NDArray[np.uint8]:
        """Draws one environment: the scene from above, and the readings of its sensor.

        - `environment`: index of the environment, from 0.

        Returns red, green and blue of each pixel, 0 to 255; `[240, 600, 3]`.

        Raises `Error` for an index out of range.
        """
    def __len__(self) -> int: ...

@final
class Inverse:
    """Contact estimation from readings: location, depth and force of the contact, and which of the
    known shapes it is.

    The constructor takes the surrogate of the gel as the model of the readings. `of_twin` takes a
    trained twin instead, and `of_tables` takes tables of readings.

    - `gel`: the surrogate of the gel.
    - `shapes`: the known shapes that may touch the gel, by name. They are upright.

    The other keywords are settings, here with their defaults:

    - `noise_kpa`: standard deviation of a reading's noise, kPa; 0.05.
    - `model_part`, `model_part_of_largest`: standard deviation of the model's error, as a fraction
      of each reading, 0.03, and as a fraction of the largest reading of the frame, 0.01.
    - `force_part`: standard deviation of the model's error of the force, as a fraction of the
      force; 0.03.
    - `correlated_s`: time within which errors of the model count as one, s; 0.1.
    - `touch_deviations`: there is a contact if at least one reading is this many standard
      deviations of the noise above zero; 6.
    - `place_walk_mm`, `depth_walk_mm`, `yaw_walk_rad`: standard deviation of the random motion of
      a contact in one second: location, 3 mm, depth, 2 mm, and yaw, 1 radian.
    - `shape_memory_s`: time after which evidence for a shape is reduced to 1/e, s; 3.
    - `n_starts`, `n_steps`: number of possible presses of each shape that are followed at once, 3,
      and number of steps that each of them takes in a frame, 1.
    - `deepest_mm`: largest depth that is considered, mm; 5. Give no more than the largest depth
      that the surrogate was trained on.

    Raises `Error` for a setting that is not allowed (its `field` names the setting), for an
    impossible shape, and if there is no shape.
    """
    def __new__(cls, gel: FastGel, shapes: Mapping[str, Shape], **settings: _Number) -> Inverse: ...
    @staticmethod
    def of_tables(tables: Mapping[str, ReadingTable], **settings: _Number) -> Inverse:
        """An inverse that takes tables of readings, measured or simulated, as the model of the
        readings.

        - `tables`: for each shape, by name, the readings at locations and depths.

        The other keywords are settings, as in the class.

        Raises `Error` for tables with different numbers of taxels, for a setting that is not
        allowed, and if there is no shape.
        """
    @staticmethod
    def of_twin(
        folder: _Path, indenters: Sequence[str] = ..., *, progress: Progress = None, **settings: _Number
    ) -> Inverse:
        """An inverse that takes a trained twin as the model of the readings. It removes the twin's
        viscoelastic relaxation from the readings. Excluded taxels (`doubtful` in the description)
        are not used. The gel is computed by finite elements at locations all over the taxels, which
        takes minutes; Ctrl-C stops it.

        - `folder`: folder of the twin (`Run.model_folder`).
        - `indenters`: names of the sensor's indenters that are the known shapes, in the described
          orientation; all of them unless given.
        - `progress`: display of the progress, see `Progress`.

        The other keywords are settings, as in the class. Unless given, `noise_kpa` is 0.03,
        `model_part_of_largest` 0.02, `n_steps` 3 and `deepest_mm` 2.5.

        Raises `Error` for a folder that holds no twin, for an indenter that the sensor does not
        have, and for a setting that is not allowed.
        """
    @property
    def shapes(self) -> list[str]:
        """Names of the known shapes, in alphabetical order; for a twin, in the order of the indenters
        in the sensor description.
        """
    def start(self, provenance: _Provenance) -> Tracker:
        """Starts the contact estimation for a sensor that nothing has touched yet.

        - `provenance`: provenance of its readings: `"real"`, `"emulated"` or `"simulated"`.
        """
    def floor_map(self, spacing_mm: float = 0.5) -> FloorMap:
        """Prepares maps of the pressure on the base of the gel under contacts, at more points than the
        taxels.

        - `spacing_mm`: spacing of the grid of points, mm. The grid is centred on the gel, and
          covers the locations at which a port is within it. 0.5 mm makes about 2,000 points for
          PhysTac.

        Raises `Error` for a spacing that is not above 0 or makes more than ten million points, for
        an inverse without a surrogate, and for a gel with boxes cast into it.
        """

@final
class ReadingTable:
    """The readings under one shape at the nodes of a grid over location and depth, for
    `Inverse.of_tables`. A coordinate whose axis has one node is not estimated. Between the nodes,
    readings are interpolated with cubic polynomials.

    - `x_mm`, `y_mm`: locations of the shape's origin in the gel's plane, mm, evenly spaced and
      increasing; `[n_x]` and `[n_y]`.
    - `depth_mm`: depths below first touch, mm, evenly spaced and increasing; `[n_depth]`.
    - `readings_kpa`: readings above the untouched sensor, kPa; `[n_depth, n_y, n_x, n_taxels]`.
    - `force_n`: force into the gel, N, `[n_depth, n_y, n_x]`; unknown unless given.

    Raises `Error` for an array with another shape or with numbers that are not allowed; its `field`
    names the array.
    """
    def __new__(
        cls, x_mm: _Floats, y_mm: _Floats, depth_mm: _Floats, readings_kpa: _Floats, force_n: _Floats | None = None
    ) -> ReadingTable: ...

@final
class FloorMap:
    """Computes the pressure on the base of a gel under an estimated contact, on a grid of points, with
    the surrogate. `Inverse.floor_map` returns it.
    """
    @property
    def provenance(self) -> _Simulated:
        """Provenance of the pressures: `"simulated"`, whatever the provenance of the readings from
        which the contact was estimated.
        """
    @property
    def x_mm(self) -> _Float:
        """Positions of the columns along x in the gel's plane, mm; `[n_columns]`."""
    @property
    def y_mm(self) -> _Float:
        """Positions of the rows along y in the gel's plane, mm; `[n_rows]`."""
    def read(self, contact: Contact) -> _Single:
        """Computes the map under a contact that the same inverse has estimated.

        - `contact`: the contact.

        Returns the pressures, kPa, `[n_rows, n_columns]`, the row of smallest y first. Each value
        is the mean over a disc as large as a port; NaN where that is not within the gel, as in the
        corners around a round one.

        Raises `Error` for a contact that another inverse has estimated.
        """

@final
class Tracker:
    """Estimates the contact of one sensor, frame by frame. `Inverse.start` returns it."""
    @property
    def provenance(self) -> _Provenance:
        """Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`."""
    def update(self, since_previous_s: float, readings_kpa: _Floats) -> Contact | None:
        """Takes one more frame, and estimates the contact.

        - `since_previous_s`: time since the previous frame, s.
        - `readings_kpa`: readings above the untouched sensor, kPa; `[n_taxels]`. With a twin as the
          model, NaN marks a taxel without a usable reading; its last usable reading is taken.

        Returns the contact, or `None` if the readings are within noise.

        Raises `Error` for a time below 0, for another number of readings, and for readings that are
        beyond a million kPa or, without a twin as the model, not finite.
        """

@final
class Contact:
    """The estimated contact, with its uncertainty: the result of `Tracker.update`. Deviations are
    standard deviations. An inverse of tables (`Inverse.of_tables`) may not know the force, which is
    0 then.
    """
    @property
    def provenance(self) -> _Provenance:
        """Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`."""
    @property
    def shape(self) -> str:
        """Name of the most probable shape. The other properties describe the contact of this shape."""
    @property
    def shape_probabilities(self) -> dict[str, float]:
        """Probability of each known shape, by name. The sum is 1."""
    @property
    def place_mm(self) -> tuple[float, float]:
        """Location of the shape's origin in the gel's plane: x and y, mm."""
    @property
    def depth_mm(self) -> float:
        """Depth below first touch, mm."""
    @property
    def yaw_rad(self) -> float:
        """Yaw (rotation about the vertical axis), radians, modulo the symmetry of the shape; 0 for a
        round shape.
        """
    @property
    def force_n(self) -> float:
        """Force into the gel, N."""
    @property
    def place_deviation_mm(self) -> tuple[float, float]:
        """Standard deviation of the location along x and along y, mm."""
    @property
    def depth_deviation_mm(self) -> float:
        """Standard deviation of the depth, mm."""
    @property
    def yaw_deviation_rad(self) -> float:
        """Standard deviation of the yaw, radians; 0 for a round shape."""
    @property
    def force_deviation_n(self) -> float:
        """Standard deviation of the force, N."""
    @property
    def covariance(self) -> _Float:
        """Covariance of x, y and depth, mm, and yaw, radians, in this order; `[4, 4]`. Its units are
        products of these: mm², mm rad and rad².
        """
    @property
    def misfit(self) -> float:
        """Root mean square of the residuals of the readings, in standard deviations of a single frame.
        If it is far above 1, something else touches the gel.
        """

def _restored(class_: str, state: bytes) -> Any:
    """Restores a pickled object from its class name and its state."""
def command() -> int:
    """Runs the command line (`sys.argv`) as the command `twintac` does. Returns the exit code: 0 on
    success, 2 for bad input, 3 if a test setup was stopped safely.
    """
