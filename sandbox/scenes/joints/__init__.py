"""What joints are for: ragdolls, bridges, vehicles and machines, and each kind of joint by itself."""

from __future__ import annotations

# isort: off
from sandbox.scenes.joints import kinds
from sandbox.scenes.joints import chains
from sandbox.scenes.joints import bridges
from sandbox.scenes.joints import welds
from sandbox.scenes.joints import ragdolls
from sandbox.scenes.joints import machines
from sandbox.scenes.joints import car
from sandbox.scenes.joints import pinball
# isort: on

__all__ = ["bridges", "car", "chains", "kinds", "machines", "pinball", "ragdolls", "welds"]
