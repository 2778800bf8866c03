"""The press on MuJoCo: a flex with the `discrete` integrator."""

import mujoco
import numpy as np

import press


def text(values):
    return " ".join(f"{value:.9g}" for value in np.ravel(values))


def model(run, nodes, tets):
    """The compiled model. Every vertex is free, or, with `cellcount`, a coarse grid of hexahedra
    carries the vertices.
    """
    interpolated = "cellcount" in run
    if interpolated:
        order = 2 if run["dof"] == "quadratic" else 1
        across, along = (order * cells for cells in run["cellcount"][:2])
        freedom = f'dof="{run["dof"]}" cellcount="{text(run["cellcount"])}"'
        pin = f'gridrange="0 0 0 {across} {along} 0"'
    else:
        freedom, pin = "", f'id="{text(press.bonded(nodes))}"'
    mass_g = np.prod(press.SIZE_MM) * press.DENSITY_G_PER_MM3
    spec = mujoco.MjSpec.from_string(f"""
<mujoco>
  <option integrator="discrete" timestep="{run["time_step_s"]}" gravity="0 0 0"
      solver="{run["solver"]}" iterations="{run["iterations"]}" tolerance="{run["tolerance"]}">
    <flag refsafe="disable" autoreset="disable"/>
  </option>
  <worldbody>
    <body name="ball" mocap="true" pos="0 0 {2 * press.RADIUS_MM}">
      <geom type="sphere" size="{press.RADIUS_MM}" condim="1"/>
    </body>
    <flexcomp name="gel" type="direct" dim="3" radius="1e-3" mass="{mass_g}" {freedom}
        point="{text(nodes)}" element="{text(tets)}">
      <pin {pin}/>
      <elasticity young="{press.YOUNGS_MODULUS_PA}" poisson="{run["poissons_ratio"]}" damping="{run["damping_s"]}"/>
      <contact condim="1" priority="1" selfcollide="none" solref="{text(run["solref"])}" solimp="{text(run["solimp"])}"/>
    </flexcomp>
  </worldbody>
</mujoco>""")
    if not interpolated:
        spec.flexes[0].elastic3d = 1  # stable Neo-Hookean; 0 is Saint Venant-Kirchhoff
    return spec.compile()


def main():
    run = press.settings()
    nodes, tets = press.mesh(run)
    compiled = model(run, nodes, tets)
    data = mujoco.MjData(compiled)
    # Vertices slide along x, y and z; contact is the only constraint on their slides along z.
    vertical = compiled.jnt_dofadr[np.abs(compiled.jnt_axis[:, 2]) > 0.5]

    def step(height_mm):
        data.mocap_pos[0, 2] = height_mm
        mujoco.mj_step(compiled, data)
        return -data.qfrc_constraint[vertical].sum()

    interpolated = "cellcount" in run
    n_nodes = compiled.nflexnode if interpolated else len(nodes)
    n_elements = np.prod(run["cellcount"]) if interpolated else len(tets)
    press.follow(run, n_nodes, n_elements, step)


if __name__ == "__main__":
    main()
