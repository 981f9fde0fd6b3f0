"""Scenes that are about what happens, and how it is told."""

from __future__ import annotations

from sandbox.scenes.events import hail

__all__ = ["hail"]
