"""Sixteen blocks come to rest on the gels of sixteen palms, in MuJoCo XLA: on JAX's device, in
compiled steps.

pip install './python[mujoco]' mujoco-mjx
"""

import jax
import mujoco
from mujoco import mjx

from twintac import Sensor
from twintac.mujoco import add_sensor
from twintac.simulators import mjx as touch

N_WORLDS, N_STEPS, MASS_KG = 16, 600, 0.1

spec = mujoco.MjSpec.from_string(
    f"""<mujoco><option timestep="0.001"/><worldbody><body name="palm"/>
      <body name="block" pos="0 0 0.0181"><freejoint/>
        <geom name="block" type="box" size="0.006 0.006 0.01" mass="{MASS_KG}" contype="0" conaffinity="0"/></body>
    </worldbody></mujoco>"""
)
add_sensor(spec, Sensor.phystac(), body="palm", name="palm")
model = spec.compile()
on_device = mjx.put_model(model)
sensors = touch.put(model, ["palm"], geoms=["block"])

data = jax.vmap(lambda _: mjx.make_data(on_device))(jax.numpy.arange(N_WORLDS))
gel_state = jax.vmap(sensors.begin, in_axes=(None, 0))(on_device, data)
step = jax.jit(jax.vmap(sensors.step, in_axes=(None, 0, 0)))
for _ in range(N_STEPS):
    data, gel_state, reading = step(on_device, data, gel_state)

for taxel, pressure_kpa in zip(Sensor.phystac().taxels, reading.pressure_kpa[0, 0]):
    print(f"{taxel} {float(pressure_kpa):6.2f} kPa")
force_n = -reading.wrench[:, 0, 2]
print(f"{float(force_n.min()):.3f} to {float(force_n.max()):.3f} N in {N_WORLDS} worlds, of {9.81 * MASS_KG:.3f} N, simulated")
