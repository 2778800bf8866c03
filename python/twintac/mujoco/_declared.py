"""Sensors that a model declares in MJCF.

    <sensor>
      <user name="phystac/palm" objtype="site" objname="palm" datatype="real" needstage="vel" dim="8"/>
    </sensor>

The name begins with that of the sensor's description and a slash. The site is the frame of the gel,
and the dimension is the number of taxels.
"""

from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

_EXAMPLE = '<user name="{name}/palm" objtype="site" objname="palm" datatype="real" needstage="vel" dim="{n_taxels}"/>'
# MuJoCo clears the values of sensors of a later stage in the step that follows an update.
_STAGES = (int(mujoco.mjtStage.mjSTAGE_POS), int(mujoco.mjtStage.mjSTAGE_VEL))


class Declared(NamedTuple):
    """The user sensors of a model that are touch sensors of one description."""

    site: npt.NDArray[np.intp]
    """Indices of their sites."""
    names: list[str]
    address: npt.NDArray[np.intp]
    """Where the readings of each are in `sensordata`, `[n_sensors, n_taxels]`."""


def declared(model: mujoco.MjModel, name: str, n_taxels: int) -> Declared:
    """The sensors whose names begin with `name/`.

    Raises `ValueError` if there is none, and for one that is not at a site, has another dimension,
    or is computed from accelerations.
    """
    sites, names, addresses = [], [], []
    for number in range(model.nsensor):
        own = model.sensor(number).name
        if model.sensor_type[number] != int(mujoco.mjtSensor.mjSENS_USER) or not own.startswith(f"{name}/"):
            continue
        dim, stage = int(model.sensor_dim[number]), int(model.sensor_needstage[number])
        if model.sensor_objtype[number] != int(mujoco.mjtObj.mjOBJ_SITE):
            raise ValueError(f'sensor `{own}` is not at a site: give it `objtype="site"`, and the site as `objname`')
        if dim != n_taxels:
            raise ValueError(f'sensor `{own}` has `dim="{dim}"`, and `{name}` has {n_taxels} taxels: write `dim="{n_taxels}"`')
        if stage not in _STAGES:
            raise ValueError(f'sensor `{own}` needs accelerations, and touch is known before: write `needstage="vel"`')
        sites.append(int(model.sensor_objid[number]))
        names.append(own)
        addresses.append(int(model.sensor_adr[number]) + np.arange(n_taxels))
    if not sites:
        example = _EXAMPLE.format(name=name, n_taxels=n_taxels)
        raise ValueError(f"the model has no sensor `{name}/…`: name `sites`, or declare it in MJCF: {example}")
    return Declared(np.array(sites, int), names, np.array(addresses, int))
