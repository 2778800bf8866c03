"""The press on Newton: vertex block descent (VBD) on one Warp CPU device."""

import newton
import numpy as np
import warp as wp

import press


def model(run, nodes, tets):
    mu, lam = press.lame_pa(run["poissons_ratio"])
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    builder.add_soft_mesh(
        pos=wp.vec3(0.0, 0.0, 0.0),
        rot=wp.quat_identity(),
        scale=1.0,
        vel=wp.vec3(0.0, 0.0, 0.0),
        vertices=[wp.vec3(*node) for node in nodes.tolist()],
        indices=tets.ravel().tolist(),
        density=press.DENSITY_G_PER_MM3,
        k_mu=mu,
        k_lambda=lam,
        k_damp=run["damping_pa_s"],
        tri_ke=0.0,
        tri_ka=0.0,
        tri_kd=0.0,
        particle_radius=run["radius_mm"],
    )
    for node in press.bonded(nodes):
        builder.particle_mass[node] = 0.0
        builder.particle_flags[node] = builder.particle_flags[node] & ~newton.ParticleFlags.ACTIVE
    ball = builder.add_body(is_kinematic=True, mass=1.0)
    config = newton.ModelBuilder.ShapeConfig(ke=run["contact_n_per_mm"] * 1e6, kd=0.0, mu=0.0, margin=0.0, density=0.0)
    builder.add_shape_sphere(ball, radius=press.RADIUS_MM - run["radius_mm"], cfg=config)
    builder.color()
    built = builder.finalize(device="cpu")
    built.soft_contact_ke = run["contact_n_per_mm"] * 1e6
    built.soft_contact_kd = 0.0
    built.soft_contact_mu = 0.0
    return built


def main():
    run = press.settings()
    wp.config.quiet = True
    nodes, tets = press.mesh(run)
    built = model(run, nodes, tets)
    pipeline = newton.CollisionPipeline(built, soft_contact_gap=run["gap_mm"])
    contacts = pipeline.contacts()
    solver = newton.solvers.SolverVBD(built, iterations=run["iterations"], particle_enable_tile_solve=False)
    kind = solver.ObservableKind.CONTACT_F
    seen = solver.observables(contacts=contacts, kinds={kind})
    states = [built.state(), built.state()]
    control = built.control()

    def step(height_mm):
        before, after = states
        pose = np.array([[0.0, 0.0, height_mm, 0.0, 0.0, 0.0, 1.0]], dtype=np.float32)
        before.body_q.assign(pose)
        after.body_q.assign(pose)
        before.clear_forces()
        pipeline.collide(before, contacts)
        solver.step(before, after, control, contacts, run["time_step_s"], observables=seen)
        states.reverse()
        return abs(seen.contact_f.numpy()[:, 2].sum())

    press.follow(run, len(nodes), len(tets), step)


if __name__ == "__main__":
    main()
