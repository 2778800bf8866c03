"""The task of all engines: a ball is pressed into a block that is bonded to its base. Units here
are mm, g and s, and therefore Pa and µN.
"""

import json
import math
import os
import resource
import sys
import time

import numpy as np

SIZE_MM = (30.0, 20.0, 8.0)
RADIUS_MM = 12.5
SPEED_MM_PER_S = 2.0
DURATION_S = 1.0
YOUNGS_MODULUS_PA = 70e3
DENSITY_G_PER_MM3 = 1e-3
READ_AT_MM = (0.5, 1.0, 2.0)


def settings():
    """The settings of the run: one JSON object, the only argument."""
    return json.loads(sys.argv[1])


def regular_mesh(cells):
    """Nodes, mm, and tetrahedra of a block that is divided into cells, each into five tetrahedra,
    mirrored from cell to cell.
    """
    nx, ny, nz = cells
    x, y, z = (np.linspace(0.0, size, n + 1) for size, n in zip(SIZE_MM, cells))
    grid = np.meshgrid(x - SIZE_MM[0] / 2, y - SIZE_MM[1] / 2, z, indexing="ij")
    nodes = np.stack([g.ravel() for g in grid], axis=1)
    number = np.arange(len(nodes)).reshape(nx + 1, ny + 1, nz + 1)
    # Corners are numbered x + 2 y + 4 z.
    even = [(0, 1, 2, 4), (3, 2, 1, 7), (5, 1, 4, 7), (6, 4, 2, 7), (1, 2, 4, 7)]
    odd = [tuple(corner ^ 1 for corner in tet) for tet in even]
    tets = []
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                corners = [number[i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)] for c in range(8)]
                tets += [[corners[c] for c in tet] for tet in (odd if (i + j + k) % 2 else even)]
    return nodes, right_handed(nodes, np.array(tets))


def right_handed(nodes, tets):
    """The same tetrahedra, reordered so that all volumes are positive."""
    a, b, c, d = (nodes[tets[:, i]] for i in range(4))
    wrong = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets = tets.copy()
    tets[wrong, 2], tets[wrong, 3] = tets[wrong, 3], tets[wrong, 2]
    return tets


def mesh(run):
    """The mesh of a run: a regular one with the run's cells, or one from a file."""
    if "cells" in run:
        return regular_mesh(run["cells"])
    with open(run["mesh_file"]) as file:
        read = json.load(file)
    nodes = np.array(read["nodes_mm"])
    return nodes, right_handed(nodes, np.array(read["tets"]))


def bonded(nodes):
    """Indices of the nodes at the bottom."""
    return np.flatnonzero(nodes[:, 2] < 1e-6)


def lame_pa(nu):
    """Lamé's constants μ and λ, Pa."""
    return YOUNGS_MODULUS_PA / (2 * (1 + nu)), YOUNGS_MODULUS_PA * nu / ((1 + nu) * (1 - 2 * nu))


def follow(run, n_nodes, n_tets, step):
    """Presses with `step(centre_height_mm)`, which returns the force in µN, and prints a row of
    results.

    Ends early when the run's processor time is spent; other load on the machine does not shorten
    presses. The first step may include a compilation: it is made with the ball slightly above the
    gel, before the measurement starts.
    """
    dt, limit_s = run["time_step_s"], run["limit_s"]
    touch_mm = SIZE_MM[2] + RADIUS_MM
    step(touch_mm + 1e-3)
    start_up_s = time.time() - process_started()
    n_steps = math.ceil(DURATION_S / dt - 1e-9)
    depths, forces = [0.0], [0.0]
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    for n in range(1, n_steps + 1):
        depth_mm = min(n * dt, DURATION_S) * SPEED_MM_PER_S
        force_n = step(touch_mm - depth_mm) * 1e-6
        if not math.isfinite(force_n):
            sys.exit(f"unstable: the force is no number at {depth_mm:.2f} mm")
        depths.append(depth_mm)
        forces.append(force_n)
        if time.process_time() - cpu_s > limit_s:
            break
    wall_s, cpu_s = time.perf_counter() - wall_s, time.process_time() - cpu_s
    simulated_s = depths[-1] / SPEED_MM_PER_S
    reached = [mm for mm in READ_AT_MM if mm <= depths[-1] + 1e-9]
    row = {
        "nodes": int(n_nodes),
        "tets": int(n_tets),
        "rtf": simulated_s / wall_s,
        "cpu_s": cpu_s / simulated_s,
        "start_up_s": start_up_s,
        "reached_mm": depths[-1],
        "force_n": {f"{mm:.1f}": float(np.interp(mm, depths, forces)) for mm in reached},
        "memory_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(row), flush=True)


def process_started():
    """Start time of this process, s since the epoch."""
    ticks = float(open("/proc/self/stat").read().rsplit(")", 1)[1].split()[19])
    uptime_s = float(open("/proc/uptime").read().split()[0])
    return time.time() - uptime_s + ticks / os.sysconf("SC_CLK_TCK")
