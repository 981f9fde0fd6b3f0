"""What is hard on a solver: heavy on light, long chains, overlap, what is tiny, thin, fast or far too much at once."""

from __future__ import annotations

# isort: off
from sandbox.scenes.robustness import stacks
from sandbox.scenes.robustness import masses
from sandbox.scenes.robustness import chains
from sandbox.scenes.robustness import machines
from sandbox.scenes.robustness import crowds
from sandbox.scenes.robustness import sizes
from sandbox.scenes.robustness import contacts
from sandbox.scenes.robustness import bounces
# isort: on

__all__ = ["bounces", "chains", "contacts", "crowds", "machines", "masses", "sizes", "stacks"]
