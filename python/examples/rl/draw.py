"""Draws an environment of each task while its scripted baseline acts.

python python/examples/rl/draw.py docs/tasks.png
"""

import sys

import gymnasium as gym
import matplotlib.image  # type: ignore[import-not-found, unused-ignore]
import numpy as np

import twintac.gymnasium
from twintac.gymnasium.policies import scripted_policy

pictures = []
for kind, n_steps, seed in (("ExploreShape", 3, 5), ("HoldForce", 100, 1), ("FollowEdge", 120, 4)):
    env = gym.make(f"TwinTac/{kind}-v0", render_mode="rgb_array")
    observed, _ = env.reset(seed=seed)
    script = scripted_policy(kind)
    for _step in range(n_steps):
        observed = env.step(script(observed[None])[0])[0]
    pictures.append(np.asarray(env.render()))
matplotlib.image.imsave(sys.argv[1], np.concatenate(pictures))
print(f"wrote {sys.argv[1]}, {twintac.gymnasium.TouchEnv.provenance}")
