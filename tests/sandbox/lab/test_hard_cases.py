"""The hard cases: what they are made of, and that the quick ones hold with the defaults."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from engine import Box, World
from sandbox.lab.hard_cases import CASES, FAMILIES, joints, life, stepping
from sandbox.lab.hard_cases.causes import CAUSES
from sandbox.lab.stability import check
from sandbox.lab.stability_baseline import BASELINE, held
from sandbox.lab.stability_ladder import Variant
from sandbox.scenes import SCENES

ROOT = Path(__file__).parents[3]
SOFT = Variant("soft_step")
LISTED = {name for name, case in CASES.items() if case.scene.name in SCENES and not (case.program or case.shows)}
QUICK = [name for name, case in CASES.items() if case.quick and name not in LISTED and name not in CAUSES]


def test_there_are_enough_and_each_says_what_it_is() -> None:
    assert len(CASES) >= 45
    assert sum(map(len, FAMILIES.values())) == len(CASES), "two families have a case of the same name"
    for name, case in CASES.items():
        assert name == name.lower()
        assert case.scene.summary.endswith("."), name
        assert case.criteria, name
        assert all(criterion.after > 0.0 for criterion in case.criteria), name


@pytest.mark.parametrize("name", QUICK)
def test_holds_with_the_defaults(name: str) -> None:
    """Of the quick ones; what is a listed scene with its own criteria, tests/sandbox/test_scenes.py holds to them."""
    row = check(name, SOFT)
    assert row.passed, f"{row.claim}: {row.value:.3g}, limit {row.limit:.3g}"


@pytest.mark.parametrize("name", ["seams", "mass_ratio_1000", "load_removed_100"])
def test_what_is_known_to_fall_falls(name: str) -> None:
    """Otherwise its cause is told in vain; all_in_one_place is left out for its time."""
    assert check(name, SOFT).passed is False


def test_causes_are_told_of_what_falls_alone() -> None:
    fell = {name for name in CASES if (name, "soft_step") not in held()}
    assert set(CAUSES) == fell, "docs/stability.json and causes.py"


def test_the_committed_figures_keep_the_promise() -> None:
    """At least 93 % of what it can have holds with the defaults."""
    assert BASELINE.is_file()
    assert len([case for case, solver in held() if solver == "soft_step"]) >= 0.93 * len(CASES)


def test_broken_solvers_are_caught() -> None:
    """What the cases are worth: a solver that is wrong in one thing falls in the case that is about it."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.sandbox.lab.broken_solvers"], check=False,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, cwd=ROOT, capture_output=True, text=True, timeout=500,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    caught = {what: set(cases.split()) for what, cases in (line.split(":") for line in done.stdout.splitlines())}
    assert caught.pop("nothing") == set()
    assert "mass_ratio_10" in caught["wrong effective mass"]
    assert "overlap_recovery" in caught["no relax pass"]
    assert "friction_ramp" in caught["friction unclamped"]


# --- their answers ----------------------------------------------------------------------------------------------------


def test_catenary_of_many_planks_is_the_continuous_one() -> None:
    """y = a cosh(x / a): of length 2 a sinh(L / 2a), hanging a cosh(L / 2a) - a."""
    a, span = 40.0, 60.0
    x = np.linspace(-0.5 * span, 0.5 * span, 2001)
    points = list(zip(x.tolist(), (a * np.cosh(x / a)).tolist(), strict=True))
    assert joints.catenary(points) == pytest.approx(a * math.cosh(0.5 * span / a) - a, rel=1e-5)


def test_a_chain_of_two_planks_hangs_as_a_triangle() -> None:
    assert joints.catenary([(-3.0, 0.0), (0.0, -4.0), (3.0, 0.0)]) == pytest.approx(4.0, rel=1e-9)


def test_varying_steps_span_what_they_say() -> None:
    steps = [stepping.varying(None, k, 1.0) for k in range(500)]  # type: ignore[arg-type]
    assert min(steps) == pytest.approx(stepping.SHORTEST, abs=0.02)
    assert max(steps) == pytest.approx(stepping.LONGEST, abs=0.02)
    assert len(set(steps)) == 500


def test_bodies_come_and_go_without_touching_when_they_come() -> None:
    """Or the overlap would be the case's own."""
    case = CASES["create_and_destroy"]

    class Counting:
        world = World()
        made = 0

        def create(self, shape, position, **body) -> None:
            self.made += 1
            new = self.world.create_body(shape, position=position, **body)
            gaps = np.hypot(*(self.world.positions[:-1] - new.position).T)
            assert (gaps > 1.0).all(), "it comes in on top of another"

        def destroy(self, index: int) -> None:
            self.world.bodies[index].destroy()

    stage = Counting()
    stage.world.create_body(Box(1, 1), position=(0.0, -90.0), kind="static")
    assert case.program is not None
    for number in range(240):
        stage.world.step(case.program(stage, number, 1 / 60))  # type: ignore[arg-type]
    assert stage.made == math.ceil(240 / life.EVERY)
