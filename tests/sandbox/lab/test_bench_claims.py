"""What `tumble bench --claims` measures is what it says."""

from __future__ import annotations

import json

import pytest

from sandbox.lab import bench_claims
from tests.sandbox.commandline import Tumble


def test_all_sleeps_that_is_timed() -> None:
    found = bench_claims.rest(100)
    assert found.boxes == 100
    assert 30 <= found.steps_until_asleep < bench_claims.LONGEST
    assert 0.0 < found.run_us < found.step_us < 1000.0


@pytest.mark.parametrize("scene", bench_claims.CHAINS)
def test_one_world_is_solved_at_once_and_the_other_is_not(scene: str) -> None:
    at_once, visited = (bench_claims.made(scene, how) for how in ("auto", "iterated"))
    for world in (at_once, visited):
        world.step(1 / 60)
    assert at_once._state.chains is not None
    assert visited._state.chains is None


def test_the_command_tells_all_of_them(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    rest, chain = bench_claims.rest, bench_claims.chain
    monkeypatch.setattr(bench_claims, "rest", lambda: rest(100))
    monkeypatch.setattr(bench_claims, "chain", lambda scene: chain(scene, 4))
    code, out, _ = tumble("bench", "--claims")
    assert code == 0
    assert "100 boxes asleep" in out
    assert out.count("times the time") == len(bench_claims.CHAINS)
    code, out, _ = tumble("bench", "--claims", "--json", "-")
    data = json.loads(out)
    assert [one["scene"] for one in data["chains"]] == list(bench_claims.CHAINS)
    for one in data["chains"]:
        assert one["ratio"] == pytest.approx(one["step_us"] / one["iterated_step_us"])
        assert one["gap_mm"] < one["iterated_gap_mm"]
