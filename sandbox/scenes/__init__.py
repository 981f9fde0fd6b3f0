"""The scenes: one decorated function each; importing a module here is what lists its scenes."""

from __future__ import annotations

from sandbox.scenes import the_talk
from sandbox.scenes.registry import SCENES, Scene, UnknownScene, find_scene, scene

__all__ = ["SCENES", "Scene", "UnknownScene", "find_scene", "scene", "the_talk"]
