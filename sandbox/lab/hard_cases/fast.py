"""What is fast: bullets, balls on a table, and what spins."""

from __future__ import annotations

from sandbox.lab.hard_cases.case import Case, case

CASES: dict[str, Case] = {
    "tunnelling_1000": case("Continuous/Thin Walls"),
    "bounce_house": case("Continuous/Bounce House"),
    "pinball": case("Joints/Pinball", quick=True),
    "fast_spin": case("Robustness/Fast Spin", quick=True),
}
