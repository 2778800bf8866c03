"""The time of each world, from update to update."""

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
# Tolerances for rounding, as fractions of a time step and of the time.
_OF_STEP, _OF_TIME = 1e-6, 1e-12


class Clock:
    """The time of each world at the last update, s; NaN in a world that starts anew."""

    def __init__(self, n_worlds: int) -> None:
        self.last_s = np.full(n_worlds, np.nan)

    def passed(self, now_s: _Array, timestep_s: _Array) -> tuple[float, npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Compares the current times with those of the last update.

        Returns the time that has passed, s (one time step or 0, the same in all worlds); which
        worlds have started anew, because their time went back; and which have made a step. Raises
        `ValueError` if more or less than one time step has passed.
        """
        known = ~np.isnan(self.last_s)
        begun = known & (now_s < self.last_s)
        elapsed_s = np.where(known & ~begun, now_s - self.last_s, 0.0)
        goes_on = known & ~begun & (np.abs(elapsed_s - timestep_s) <= _OF_STEP * timestep_s + _OF_TIME * np.abs(now_s))
        stands = known & ~begun & (elapsed_s == 0.0)
        self._check(~known | begun | stands | goes_on, now_s, timestep_s)
        if goes_on.any() and stands.any():
            world = int(np.nonzero(stands)[0][0])
            raise ValueError(f"world {world} has stood still since the last update while others went on: step all worlds, or reset those that begin anew")
        least_s, most_s = float(timestep_s.min()), float(timestep_s.max())
        if least_s != most_s:
            raise ValueError(f"worlds have time steps from {least_s:g} to {most_s:g} s: give all the same `opt.timestep`")
        return 0.0 if stands.any() else least_s, begun, goes_on

    def _check(self, right: npt.NDArray[np.bool_], now_s: _Array, timestep_s: _Array) -> None:
        if right.all():
            return
        world = int(np.nonzero(~right)[0][0])
        passed_s, step_s = now_s[world] - self.last_s[world], timestep_s[world]
        problem = f"in world {world}, {passed_s:g} s have passed since the last update, a time step is {step_s:g} s"
        raise ValueError(f"{problem}: update once in each time step; after data were set to another moment, call `reset` or `set_state`")
