"""What solvers hold, in figures, at 60 Hz with their own substeps and iterations: the tables of docs/solvers.md.

python -m sandbox.lab.holds
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import partial
from typing import Any

from engine import Body, Box, Circle, World
from sandbox.lab.experiments.experiment import G
from sandbox.lab.measures import energy, joint_error, momentum, penetration
from sandbox.simulation import TIME_STEP

Settings = dict[str, Any]

SOLVERS: dict[str, Settings] = {
    "soft_step, joints one by one": {"solver": "soft_step", "joint_solving": "iterated"},
    "soft_step": {"solver": "soft_step"},
    "xpbd": {"solver": "xpbd"},
    "avbd": {"solver": "avbd"},
}
STANDS_WITHIN = 0.5  # of a box's width: what is farther off has fallen [m]
SETTLING, SWINGING = 600, 600  # steps


def begun(gravity: tuple[float, float] = (0.0, -G), **settings: Any) -> World:
    return World(gravity=gravity, sleeping=False, **settings)


def add_floor(world: World, friction: float = 0.6) -> None:
    world.create_body(Box(60, 2), position=(0.0, -1.0), kind="static", friction=friction)


def millimetres(way: float) -> str:
    return f"{1e3 * way:.3g} mm"


# --- what stands and hangs --------------------------------------------------------------------------------------------


def tower(count: int, off: float = 0.01, **settings: Any) -> str:
    """How far the top of a tower sinks whose boxes are put down by a centimetre off, to and fro."""
    world = begun(**settings)
    add_floor(world)
    for k in range(count):
        world.create_body(Box(1, 1), position=(off * (k % 2), k + 0.5), friction=0.6)
    world.run(SETTLING, TIME_STEP)
    top = world.bodies[-1].position
    sunk = count - 0.5 - top.y
    return millimetres(sunk) if abs(top.x) < STANDS_WITHIN and sunk < 0.05 * count else "falls"


def heavy_on_light(ratio: float, **settings: Any) -> str:
    """The deepest overlap of a box with one below it, of a mass so many times smaller, or the floor."""
    world = begun(**settings)
    add_floor(world)
    for k, mass in enumerate((1.0, ratio)):
        world.create_body(Box(1, 1), position=(0.0, k + 0.5), mass=mass, friction=0.6)
    world.run(SETTLING, TIME_STEP)
    return millimetres(penetration(world)) if world.bodies[-1].position.y > 1.0 else "falls through"


def hanging(ratio: float, **settings: Any) -> str:
    """The widest joint of a chain of 20 links that hangs, with so many times a link's mass at its end."""
    world = begun(**settings)
    last: Body = world.create_body(kind="static")
    for k in range(20):
        link = world.create_body(Box(0.2, 1.0), position=(0.0, -0.5 - k))
        world.create_joint_revolute(last, link, anchor=(0.0, -k))
        last = link
    end = world.create_body(Box(1, 1), position=(0.0, -20.5), mass=ratio * last.mass)
    world.create_joint_revolute(last, end, anchor=(0.0, -20.0))
    world.run(SETTLING, TIME_STEP)
    return millimetres(widest(world, 60))


def widest(world: World, steps: int) -> float:
    """The farthest that a joint gives way in so many steps [m]."""
    found = 0.0
    for _ in range(steps):
        world.step(TIME_STEP)
        found = max(found, joint_error(world))
    return found


def ball_and_chain(**settings: Any) -> str:
    """The widest joint of the scene Joints/Ball and Chain on its way."""
    from sandbox.scenes import find_scene  # the scenes import the laboratory's closed forms

    world = begun(**settings)
    find_scene("Joints/Ball and Chain").build(world)
    return millimetres(widest(world, SWINGING))


# --- what moves -------------------------------------------------------------------------------------------------------


def slide(**settings: Any) -> str:
    """How much the acceleration of a box is off that slides down a slope of 0.7 rad with friction 0.6."""
    angle, friction = 0.7, 0.6
    world = begun((G * math.sin(angle), -G * math.cos(angle)), **settings, precision="double")
    add_floor(world, friction)
    box = world.create_body(Box(2, 0.5), position=(0.0, 0.25), friction=friction)
    world.run(60, TIME_STEP)
    before = box.velocity.x
    world.run(60, TIME_STEP)
    exactly = G * (math.sin(angle) - friction * math.cos(angle))
    off = (box.velocity.x - before) / exactly - 1.0
    return "exact" if abs(off) < 1e-6 else f"{100.0 * off:+.2g} %"


def swing(**settings: Any) -> str:
    """What is left after 10 s of the energy of a pendulum, let go at 1 rad."""
    world = begun(**settings, precision="double")
    pivot = world.create_body(kind="static")
    bob = world.create_body(Circle(0.1), position=(math.sin(1.0), -math.cos(1.0)))
    world.create_joint_revolute(pivot, bob, anchor=(0.0, 0.0))
    lowest = -bob.mass * G
    start = energy(world) - lowest
    world.run(SWINGING, TIME_STEP)
    return f"{100.0 * (energy(world) - lowest) / start:.3g} %"


def head_on(**settings: Any) -> str:
    """What is left of the momentum when a disc of 1 kg and 5 m/s has hit one of 10 kg at rest [kg m/s]."""
    world = begun((0.0, 0.0), **settings, precision="double")
    world.create_body(Circle(0.5), position=(-1.0, 0.0), velocity=(5.0, 0.0), mass=1.0)
    world.create_body(Circle(0.5), position=(1.0, 0.0), mass=10.0)
    world.run(60, TIME_STEP)
    return f"{momentum(world)[0]:.3g}"


# --- tables -----------------------------------------------------------------------------------------------------------

ROWS: dict[str, Callable[..., str]] = {
    **{
        f"tower of {count}, put down by a centimetre off: its top sinks": partial(tower, count)
        for count in (10, 20, 40)
    },
    **{f"{ratio} on 1, deepest overlap": partial(heavy_on_light, ratio) for ratio in (100, 400)},
    **{
        f"chain of 20 and {ratio} times a link's mass, widest joint": partial(hanging, ratio)
        for ratio in (10, 100, 1000)
    },
    "ball and chain, widest joint on its way": ball_and_chain,
    "box that slides at 0.7 rad, friction 0.6: its acceleration is off by": slide,
    "pendulum let go at 1 rad: of its energy is left after 10 s": swing,
    "disc of 1 kg hits one of 10 kg head on: of 5 kg m/s is left": head_on,
}

MORE: dict[str, Callable[[], str]] = {
    "`xpbd`, 16 substeps: a tower of 40 that stands straight sinks": partial(tower, 40, 0.0, solver="xpbd"),
    "`xpbd`, 32 substeps: a tower of 40 a centimetre off": partial(tower, 40, solver="xpbd", substeps=32),
    **{
        f"`avbd`, {iterations} iterations: of 5 kg m/s is left when 1 kg hits 10 kg head on": partial(
            head_on, solver="avbd", iterations=iterations
        )
        for iterations in (10, 50, 1000)
    },
}


def line(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def row(what: str) -> str:
    """A line of the table of all solvers."""
    return line([what, *(ROWS[what](**settings) for settings in SOLVERS.values())])


def further() -> list[str]:
    """Lines of the table of other settings."""
    return [line([what, of()]) for what, of in MORE.items()]


def main() -> None:
    print(line(["", *SOLVERS]))
    print(line(["---"] * (1 + len(SOLVERS))))
    for what in ROWS:
        print(row(what))
        sys.stdout.flush()
    print("\n" + line(["", "holds"]) + "\n" + line(["---", "---"]))
    print("\n".join(further()))


if __name__ == "__main__":
    main()
