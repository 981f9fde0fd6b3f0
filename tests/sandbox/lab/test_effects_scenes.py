"""In every scene: the code of all effects that it does not call for is forced on, and nothing changes.

Those of the benchmark are left out: they are large, and the code of magnets looks at every pair.
"""

from __future__ import annotations

import pytest

from engine import EFFECTS, World
from sandbox.scenes import SCENES, find_scene
from sandbox.simulation import TIME_STEP

STEPS = 300


def run(world: World) -> str:
    """The state after 300 steps."""
    for _ in range(STEPS):
        world.step(TIME_STEP)
    return world.state_hash()


@pytest.mark.parametrize("name", [name for name in SCENES if not name.startswith("Benchmark/")])
def test_forced_code_without_content_changes_nothing(name: str) -> None:
    scene = find_scene(name)
    world = scene.make()
    idle = {effect.name for effect in world.effects if not effect.called_for}
    world._state.forced = frozenset(idle)
    forced = run(world)
    assert {effect.name for effect in EFFECTS} == world._state.effects, "all of them ran"
    assert forced == run(scene.make())


def test_leaving_out_what_is_called_for_does_change_something() -> None:
    # or the test above would pass if `forced` and `suppressed` did nothing
    scene = find_scene("The Talk/Pyramid")
    world = scene.make()
    world._state.suppressed = frozenset({"friction"})
    assert run(world) != run(scene.make())
