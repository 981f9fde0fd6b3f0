"""Things that stand: on their contacts, and by friction alone."""

from __future__ import annotations

# isort: off
from sandbox.scenes.stacking import stacks
from sandbox.scenes.stacking import heaps
from sandbox.scenes.stacking import card_house
from sandbox.scenes.stacking import arch
from sandbox.scenes.stacking import dominoes
# isort: on

__all__ = ["arch", "card_house", "dominoes", "heaps", "stacks"]
