"""Tasks of touch as Gymnasium environments: `gym.make("TwinTac/HoldForce-v0")`, `gym.make_vec("TwinTac/HoldForce-v0", num_envs=1024)`.

Importing this module registers `TwinTac/ExploreShape-v0`, `TwinTac/HoldForce-v0` and `TwinTac/FollowEdge-v0`. All that is observed is simulated.

Keywords of all three: `imperfection` (from what the imperfections of each episode's sensor are drawn; those of a sensor that works unless given, `twintac.Imperfection()` for
perfect sensors), `gel` (a `twintac.FastGel`; PhysTac's unless given) and `render_mode` (`"rgb_array"`). Vector environments also take `autoreset_mode` and `n_threads`.

Observations are float32 from -10 to 10. `n` is the number of taxels, eight for PhysTac. Readings are in units of 10 kPa, above those of the untouched sensor; changes since the last step
in units of 1 kPa. The first observation of an episode has no reading yet: zeros. Actions are from -1 to 1; what is beyond counts as that.

HoldForce: to press with a wanted force on a ball, a cylinder or a cube that sits on a spring (1 to 10 N/mm) somewhere under the gel. A step is a frame of the sensor, 1/55 s; an episode has 220.

- Action `[1]`: speed down, times 10 mm/s.
- Observation `[2 n + 3]`: readings; changes; how far the robot has moved beyond where it would touch, times 5 mm; its speed, times 10 mm/s; the wanted force, times 3 N.
- Reward: minus how far the force is off, N. Another force, 0.3 to 3 N, is wanted each second.
- Terminated at more than 10 N, or 4.8 mm deep in the gel; each step that is left then costs 3 N.
- Info: `force_n`, `wanted_n`, `depth_mm`, `stiffness_n_per_mm`.

FollowEdge: to take the gel's middle along the edge of a disc, box or triangle (13 to 25 mm) that nobody sees, in a wanted sense. A step is 1/55 s; an episode has 330.

- Action `[3]`: velocity along x and y, times 20 mm/s (a longer one counts as one of 20 mm/s), and speed down, times 5 mm/s.
- Observation `[2 n + 7]`: readings; changes; place since the start along x and y, times 10 mm; depth since the start, times 2 mm; the three speeds, as they were; the sense, 1 if the object's middle
  stays on the left and -1 if on the right.
- Reward: mm of edge that were passed in the wanted sense, times `1 - (beside / 3 mm)²`, if the force is 0.3 to 6 N; minus 0.1 mm for each newton beyond.
- Terminated at more than 15 N, or more than 8 mm beside the edge: minus 5 mm.
- Info: `followed_mm`, `beside_mm` (negative over the object's face), `force_n`, `depth_mm`.

ExploreShape: to tell whether it is a ball, a cube, a ring, a triangle or a cross that lies within 5 mm along x and 3 mm along y, turned by an unknown angle. A step is a press of half a second; an episode has
four, and a last step without one.

- Action `[8]`: place along x, times 12 mm, and y, times 7 mm; depth, from 0.4 to 2.4 mm; a score for each shape: it is held to be as probable as `softmax(5 scores)`.
- Observation `[4 n + 17]`: for each press readings, place and depth as in the action, zeros before it is made; then how many presses were made, one of five.
- Reward: `ln(5 p)`, in nats, of the probability `p` that this action says the right shape has: what it knows of the presses before.
- Terminated after the last step.
- Info: `shape` (its number), `is_right` (whether the most probable shape is the right one), `probability_of_right`.
"""

from twintac.gymnasium._spaces import KINDS, require_gymnasium

require_gymnasium()

import gymnasium as gym  # noqa: E402  after the check that says how to install it

from twintac.gymnasium._environment import TouchEnv  # noqa: E402
from twintac.gymnasium._vector import TouchVectorEnv  # noqa: E402

__all__ = ["TouchEnv", "TouchVectorEnv"]

for _kind in KINDS:
    gym.register(
        id=f"TwinTac/{_kind}-v0",
        entry_point="twintac.gymnasium:TouchEnv",
        vector_entry_point="twintac.gymnasium:TouchVectorEnv",
        kwargs={"kind": _kind},
    )
