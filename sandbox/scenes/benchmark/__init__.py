"""What `tumble bench` times: Box2D's own benchmark scenes, and heaps.

The numbers of the first nine are those of `shared/benchmarks.c` in Box2D 3.2 (E. Catto, 2026); where one departs from
it, its docstring says so. All bodies are awake here, and nothing is created, destroyed or steered while they run.
"""

from __future__ import annotations

# isort: off
from sandbox.scenes.benchmark import pyramids
from sandbox.scenes.benchmark import joint_grid
from sandbox.scenes.benchmark import smash
from sandbox.scenes.benchmark import drums
from sandbox.scenes.benchmark import yards
from sandbox.scenes.benchmark import piles
from sandbox.scenes.benchmark import rain
# isort: on

__all__ = ["drums", "joint_grid", "piles", "pyramids", "rain", "smash", "yards"]
