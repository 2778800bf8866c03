"""The press on rapier: a soft body of finite elements, Neo-Hookean."""

import numpy as np
import rapier3d as rapier

import press


def surface(tets):
    """The triangles at the boundary of the tetrahedra, outwards."""
    faces = np.concatenate([tets[:, [0, 2, 1]], tets[:, [0, 1, 3]], tets[:, [1, 2, 3]], tets[:, [0, 3, 2]]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def world_of(run, nodes, tets):
    """The world, and the handle of the ball."""
    world = rapier.PhysicsWorld(gravity=(0.0, 0.0, 0.0))
    world.set_num_threads(2)
    parameters = world.integration_parameters
    parameters.dt = run["time_step_s"]
    parameters.length_unit = 1.0  # mm
    parameters.num_solver_iterations = run["substeps"]
    contact = rapier.SpringCoefficients(run["contact_hz"], run["contact_damping_ratio"])
    parameters.contact_softness = contact
    parameters.static_contact_softness = contact
    parameters.soft_bodies.fem.max_linear_iterations = run["iterations"]
    material = rapier.SoftBodyMaterial(
        young_modulus=press.YOUNGS_MODULUS_PA,
        poisson_ratio=run["poissons_ratio"],
        elastic_damping_ratio=run["damping_ratio"],
    )
    # A particle has the mass of its part of the block, a quarter of each of its tetrahedra.
    a, b, c, d = (nodes[tets[:, i]] for i in range(4))
    volume_mm3 = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    mass_g = np.zeros(len(nodes))
    np.add.at(mass_g, tets.ravel(), np.repeat(press.DENSITY_G_PER_MM3 * volume_mm3 / 4, 4))
    block = (
        rapier.SoftBodyBuilder(nodes)
        .masses(mass_g.tolist())
        .cells(tets)
        .surface(surface(tets))
        .cell_model(rapier.SoftBodyCellModel.NEO_HOOKEAN)
        .solver(rapier.SoftBodySolver.FEM)
        .material(material)
        .particle_radius(run["radius_mm"])
        .pinned_particles(press.bonded(nodes))
        .surface_collider(rapier.Collider.ball(1.0).friction(0.0))
        .can_sleep(False)
    )
    world.add_soft_body(block)
    touch_mm = press.SIZE_MM[2] + press.RADIUS_MM
    ball = rapier.Collider.ball(press.RADIUS_MM - run["radius_mm"]).friction(0.0)
    start = rapier.RigidBody.kinematic_position_based().translation((0.0, 0.0, touch_mm + 1.0))
    return world, world.add_body(start, [ball])


def main():
    run = press.settings()
    nodes, tets = press.mesh(run)
    world, ball = world_of(run, nodes, tets)
    collider = world.rigid_bodies[ball].colliders[0]

    def step(height_mm):
        world.rigid_bodies[ball].set_next_kinematic_translation((0.0, 0.0, height_mm))
        world.step()
        pairs = world.narrow_phase.contact_pairs_with(collider)
        return sum(abs(pair.total_impulse().z) for pair in pairs) / run["time_step_s"]

    press.follow(run, len(nodes), len(tets), step)


if __name__ == "__main__":
    main()
