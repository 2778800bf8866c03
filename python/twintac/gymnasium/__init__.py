"""Tasks of touch as Gymnasium environments: `gym.make("TwinTac/HoldForce-v0")`,
`gym.make_vec("TwinTac/HoldForce-v0", num_envs=1024)`.

Importing this module registers `TwinTac/ExploreShape-v0`, `TwinTac/HoldForce-v0`,
`TwinTac/FollowEdge-v0` and `TwinTac/InHandTurn-v0`. All observations are simulated.

Keywords of all environments; vector environments also take `autoreset_mode` and `n_threads`:

- `variation`: the sensor variation from which the sensor of each episode is drawn. The default
  is the variation of a working sensor; `twintac.SensorVariation()` gives perfect sensors.
- `gel`: a `twintac.FastGel`; that of the task's sensor unless given: phystac-tip's for InHandTurn,
  PhysTac's for the others.
- `touch`: for InHandTurn only, see there.
- `render_mode`: `"rgb_array"`, or none.

Observations are float32 from -10 to 10. `n` is the number of taxels, eight for PhysTac. Readings
are in units of 10 kPa, above those of the untouched sensor; changes since the last step are in
units of 1 kPa. The first observation of an episode has no reading yet: these values are 0. Actions
are from -1 to 1; values outside of this range are clipped.

HoldForce: press with a wanted force on a ball, a cylinder or a cube that is mounted on a spring (1
to 10 N/mm) at a random location under the gel. A step is a frame of the sensor, 1/55 s; an episode
has 220 steps.

- Action `[1]`: downward speed in units of 10 mm/s.
- Observation `[2 n + 3]`: readings; changes; how far the robot has moved beyond the pose of first
  touch, in units of 5 mm; its speed, in units of 10 mm/s; the wanted force, in units of 3 N.
- Reward: minus the error of the force, N. The wanted force, 0.3 to 3 N, changes each second.
- Terminated at more than 10 N, or 4.8 mm deep in the gel; each remaining step then costs 3 N.
- Info: `force_n`, `wanted_n`, `depth_mm`, `stiffness_n_per_mm`.

FollowEdge: move the gel's middle in a given direction along the edge of a disc, box or triangle (13
to 25 mm) that is not observed. A step is 1/55 s; an episode has 330 steps.

- Action `[3]`: velocity along x and y in units of 20 mm/s (a longer vector counts as one of 20
  mm/s), and downward speed in units of 5 mm/s.
- Observation `[2 n + 7]`: readings; changes; position relative to the start along x and y, in units
  of 10 mm; depth relative to the start, in units of 2 mm; the three speeds of the last step, in the
  units of the action; the direction, 1 if the object's middle stays on the left and -1 if on the
  right.
- Reward: mm of edge that were passed in the given direction, times `max(0, 1 - (beside / 3 mm)²)`,
  if the force is 0.3 to 6 N; minus 0.1 mm for each newton above 6 N.
- Terminated at more than 15 N, or more than 8 mm beside the edge: minus 5 mm.
- Info: `followed_mm`, `beside_mm` (negative over the object's face), `force_n`, `depth_mm`.

ExploreShape: classify the object as a ball, a cube, a ring, a triangle or a cross. It lies within 5
mm along x and 3 mm along y of the gel's middle, turned by an unknown angle. A step is a press of
half a second; an episode has four such steps, and a last step without a press.

- Action `[8]`: location along x in units of 12 mm, and along y in units of 7 mm; depth, -1 for 0.4
  and 1 for 2.4 mm; a score for each shape, in the order above: the probabilities are
  `softmax(5 scores)`.
- Observation `[4 n + 17]`: for each press readings, location and depth as in the action, zeros
  before the press is made; then the number of presses that were made, one-hot of five.
- Reward: `ln(5 p)`, in nats, where `p` is the probability that the action assigns to the right
  shape. The action is based on the presses before it.
- Terminated after the last step.
- Info: `shape` (its number from 0, in the order above), `is_right` (whether the most probable shape
  is the right one), `probability_of_right`.

InHandTurn: turn an object on the palm of a hand by a wanted angle, 15 to 90 degrees to the left or
right, without seeing it. The object is a cylinder or a box of unknown size (24 to 38 mm wide), mass
(30 to 120 g), place and rotation. Four fingers with a phystac-tip each stand around the palm; each
has two joints, `swing`, sideways, and `close`, towards the middle. A step is 80 ms; an episode has
60 steps. The worlds are simulated by MuJoCo, which must be version 4 or later.

- Action `[8]`: motion of the target of each joint's servo, `swing` and `close` of each finger in
  turn: 1 is 10 % of the target's range. The range of `swing` is -0.4 to 0.4 radians, that of `close`
  -0.1 to 0.35 radians. An episode begins with all targets at 0.
- Observation `[4 (n + 16) + 2]`: four frames, of this step and the three before, the newest first;
  the wanted angle in units of 90 degrees, positive to the left as seen from above; and the fraction
  of the episode that is left. A frame has what `touch` measures, what the encoders of the joints
  measure (zeros off by a standard deviation of 0.5 degrees, steps of 0.3 degrees), and the targets;
  both angles are -1 to 1 over their ranges.
- `touch="taxels"`: `n` is 32, the readings of the four fingertips in units of 10 kPa. `"forces"`:
  `n` is 4, the normal force on each fingertip in units of 3 N, as a contact sensor of MuJoCo gives
  it. `"none"`: `n` is 0. `"truth"`: `n` is 5, for a teacher: the angle that is left, in units
  of 90 degrees; cosine and sine of four times the angle of a box, 0 for a cylinder; half of the width
  along both axes, in units of 26 mm. `"truth+taxels"`: both, in this order.
- Reward: by how many radians the angle came closer to the wanted one, and 0.05 in each step that
  ends less than 5 degrees from it.
- Terminated with a reward of -2 if the object falls: its middle beyond the edge of the palm, or
  tilted by more than 40 degrees.
- Info: `error_rad` (wanted minus turned angle, without sign), `turned_rad`, `wanted_rad`,
  `is_dropped`, `is_box`.
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
