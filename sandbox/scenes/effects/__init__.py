"""One scene for each effect, with what it does as a number."""

from __future__ import annotations

# isort: off
from sandbox.scenes.effects import surfaces
from sandbox.scenes.effects import motion
from sandbox.scenes.effects import media
from sandbox.scenes.effects import attraction
from sandbox.scenes.effects import explosion
from sandbox.scenes.effects import filters
from sandbox.scenes.effects import motors
# isort: on

__all__ = ["attraction", "explosion", "filters", "media", "motion", "motors", "surfaces"]
