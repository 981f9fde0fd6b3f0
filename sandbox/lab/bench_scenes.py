"""What `tumble bench` measures if nobody names a scene, from when on, and for how many steps."""

from __future__ import annotations

from sandbox.lab.pyramids import BASES, pyramid
from sandbox.scenes import SCENES, Scene

FOLDER = "Benchmark/"
SETTLES = {
    "Benchmark/Smash": 1.0,  # just before it hits
    "Benchmark/Tumbler": 5.0,
    "Benchmark/Washer": 6.0,
    "Benchmark/Spinner": 5.0,
    "Benchmark/Compounds": 10.0,
    "Benchmark/Junkyard": 5.0,
    "Benchmark/Pile 1000": 5.0,
    "Benchmark/Pile 5000": 7.0,
    "Benchmark/Pile 20000": 10.0,
    "Benchmark/Circles 5000": 6.0,
    "Benchmark/Mixed Pile": 9.0,
}
"""What falls in them first is down by then, heaps are at rest [s]; all others are measured from their start."""

MOST_STEPS, FEWEST_STEPS = 600, 80
THING_STEPS = 1_200_000  # steps times bodies and joints: a scene then takes half a minute or so, peers and all


def default_scenes(*, talk: bool) -> list[Scene]:
    """Box2D's own and the heaps; beside Box2D Lite, which looks at all pairs, the talk's pyramids."""
    scenes = [scene for name, scene in SCENES.items() if name.startswith(FOLDER)]
    return scenes if scenes and not talk else [pyramid(base) for base in BASES]


def settling_time(scene: str) -> float:
    """How long a scene runs before it is measured [s]."""
    return SETTLES.get(scene, 0.0)


def default_steps(things: int) -> int:
    """How many steps are measured of a scene with so many bodies and joints: the same on every machine."""
    return min(max(THING_STEPS // max(things, 1), FEWEST_STEPS), MOST_STEPS)
