"""The hard cases of `tumble stability`: a family a file; a case is a line in its family's CASES."""

from __future__ import annotations

from sandbox.lab.hard_cases import contacts, crowds, far, fast, joints, life, masses, sizes, stacking, stepping
from sandbox.lab.hard_cases.case import Case, NotApplicable, Program, Stage

FAMILIES = {
    "stacks": stacking.CASES,
    "mass ratios": masses.CASES,
    "joints": joints.CASES,
    "overlap and crowds": crowds.CASES,
    "sizes": sizes.CASES,
    "fast": fast.CASES,
    "contacts": contacts.CASES,
    "far away": far.CASES,
    "time steps": stepping.CASES,
    "during life": life.CASES,
}

CASES: dict[str, Case] = {name: case for family in FAMILIES.values() for name, case in family.items()}

__all__ = ["CASES", "FAMILIES", "Case", "NotApplicable", "Program", "Stage"]
