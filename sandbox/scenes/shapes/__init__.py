"""Every shape, and bodies of several."""

from __future__ import annotations

# isort: off
from sandbox.scenes.shapes import gathering
from sandbox.scenes.shapes import compounds
from sandbox.scenes.shapes import polygons
from sandbox.scenes.shapes import capsules
from sandbox.scenes.shapes import chain
from sandbox.scenes.shapes import far
# isort: on

__all__ = ["capsules", "chain", "compounds", "far", "gathering", "polygons"]
