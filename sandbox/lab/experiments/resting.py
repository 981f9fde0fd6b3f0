"""What rests: the forces that hold it, and how far it sinks."""

from __future__ import annotations

import numpy as np

from engine import Box, Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    COPIES,
    G,
    History,
    Measure,
    Watch,
    add_floor,
    experiment,
    late,
    of_soft_step,
    places,
)
from sandbox.lab.sag import BOX_INERTIA, predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure

# --- stack ------------------------------------------------------------------------------------------------------------

MASSES = (4.0, 1.0, 2.5, 0.5, 3.0, 1.5, 2.0, 0.8, 1.2, 1.0)  # from below [kg]


def impulse_error(history: History, dt: float) -> float:
    expected = np.array(references.loads(MASSES, G)) * dt
    return float(np.abs(late(history, dt)[:, :-1] / expected - 1.0).max(axis=1).mean())


def stack_structure() -> Structure:
    """The boxes, and the two points of each contact."""
    masses = np.array(MASSES)
    centers = np.column_stack([np.zeros(len(masses)), np.arange(len(masses)) + 0.5])
    points = [Point(k - 1 if k else GROUND, k, x, float(k)) for k in range(len(masses)) for x in (-0.5, 0.5)]
    return Structure(centers, masses, BOX_INERTIA * masses, points)


@experiment(
    "stack",
    f"{len(MASSES)} boxes of {min(MASSES):g} to {max(MASSES):g} kg on each other",
    seconds=3.0,
    measures=(
        Measure(
            "impulse",
            "relative",
            "what its contacts give, against the weight above",
            impulse_error,
            against="the weight above times the time step",
        ),
        Measure(
            "sag",
            "m",
            "how far its top sinks",
            lambda history, dt: abs(float(history[-1, -1])),
            of_soft_step(lambda world, dt: predicted_sink(world, dt, stack_structure(), len(MASSES) - 1)),
            scale=1.0,
            against="the height of one box",
        ),
    ),
)
def build_stack(world: World) -> Watch:
    add_floor(world)
    for x, y in places(COPIES // len(MASSES)):
        for k, mass in enumerate(MASSES):
            world.create_body(Box(1, 1), position=(x, y + k + 0.5), mass=mass, friction=0.6)

    def watch(world: World) -> np.ndarray:
        records = world.contact_records()
        records = records[records["body2"] <= len(MASSES)]  # the first tower's; body2 is the upper one
        given = np.zeros(len(MASSES))
        np.add.at(given, records["body2"] - 1, records["normal_impulse"])
        return np.append(given, len(MASSES) - 0.5 - world.positions[len(MASSES), 1])

    return watch


# --- lever ------------------------------------------------------------------------------------------------------------

BEAM, BEAM_MASS, LOAD = (6.0, 0.2), 2.0, 5.0  # [m], [kg], [kg]
SHORT_ARM, LONG_ARM, STOP = 1.0, 2.5, 0.2  # of the stop and of the load [m], radius of the stop [m]
STOP_FORCE = LOAD * G * LONG_ARM / SHORT_ARM  # [N]
PIN_FORCE = STOP_FORCE + (LOAD + BEAM_MASS) * G  # [N]


def force_error(column: int, force: float) -> Measure:
    """Of what was watched as an impulse of a step, on average over the end."""
    name, says = ("stop", "what the stop bears, against load x arm / arm") if column == 0 else (
        "pin", "what the fulcrum bears, against the sum of all that pushes the beam down"
    )  # fmt: skip
    return Measure(
        f"{name} force",
        "relative",
        says,
        lambda history, dt: float(np.abs(late(history, dt)[:, column] / (force * dt) - 1.0).mean()),
        against="the force it should bear",
    )


@experiment(
    "lever",
    "a beam on a fulcrum, a load on its long arm, a stop above its short arm",
    seconds=2.0,
    measures=(force_error(0, STOP_FORCE), force_error(1, PIN_FORCE)),
    needs=("revolute joints",),
)
def build_lever(world: World) -> Watch:
    fulcrum = world.create_body(kind="static")
    pins, stops = [], []
    for x, y in places(20, 10.0):
        stop = world.create_body(Circle(STOP), position=(x - SHORT_ARM, y + 0.5 * BEAM[1] + STOP), kind="static")
        beam = world.create_body(Box(*BEAM), position=(x, y), mass=BEAM_MASS, friction=0.0)
        load = world.create_body(Circle(0.3), position=(x + LONG_ARM, y), mass=LOAD)
        pins.append(world.create_joint_revolute(fulcrum, beam, anchor=(x, y)))
        world.create_joint_revolute(beam, load, anchor=(x + LONG_ARM, y), collide_connected=False)
        stops.append(stop)
    pin, stop = pins[0], stops[0]

    def watch(world: World) -> np.ndarray:
        records = world.contact_records()
        pressed = float(records["normal_impulse"][records["body1"] == stop.serial].sum())
        return np.array([pressed, pin.impulse.y])

    return watch
