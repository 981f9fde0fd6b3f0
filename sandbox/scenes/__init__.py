"""The scenes: one decorated function each; importing a module here is what lists its scenes."""

from __future__ import annotations

# They are listed everywhere in the order of these imports.
# isort: off
from sandbox.scenes import the_talk
from sandbox.scenes import stacking
from sandbox.scenes import shapes
from sandbox.scenes import effects
from sandbox.scenes import joints
from sandbox.scenes import continuous
from sandbox.scenes import events
from sandbox.scenes import sleeping
from sandbox.scenes import robustness
from sandbox.scenes import benchmark

# isort: on
from sandbox.scenes.registry import SCENES, Scene, UnknownScene, find_scene, scene

__all__ = [
    "SCENES",
    "Scene",
    "UnknownScene",
    "benchmark",
    "continuous",
    "effects",
    "events",
    "find_scene",
    "joints",
    "robustness",
    "scene",
    "shapes",
    "sleeping",
    "stacking",
    "the_talk",
]
