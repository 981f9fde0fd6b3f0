"""What a step of a plain pyramid runs: with the effects as they are, with more, and with those alone that it uses.

Run as a program, it prints that as JSON. Without compilation (NUMBA_DISABLE_JIT=1) kernels are Python: every bytecode
of a step is counted, and every call of a function of the engine. With it, every signature for which a kernel was
compiled is listed. Neither may depend on effects that the pyramid does not call for.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from types import FrameType
from typing import Any

import numba

import engine
import engine.lacking
import engine.state
from engine import Box, World
from engine.effects import BODY_PROPERTIES, EFFECTS, Effect, Property
from engine.effects.effect import any_number, bodies_with
from engine.state import State

ROOT = str(Path(engine.__file__).parent)
USED = ("gravity", "friction", "continuous collision", "sleeping")
BASE = 3  # boxes in the lowest row
MORE = 10  # effects added
WARM_UP, COUNTED = 3, 2  # steps


def added(number: int) -> Effect:
    """An effect that nothing calls for, with everything an effect can have."""

    def apply(state: State, settings: Any) -> None:
        raise AssertionError("nothing called for it")

    name = f"effect_{number}"
    return Effect(name, "none", bodies_with(name, name), body=(Property(name, 0.0, any_number, "none"),), apply=apply)


def use(effects: tuple[Effect, ...]) -> None:
    """The engine has these."""
    engine.state.EFFECTS = engine.lacking.EFFECTS = effects  # type: ignore[misc]
    properties = {p.name: p for effect in effects for p in effect.body}
    engine.state.BODY_PROPERTIES = {**BODY_PROPERTIES, **properties} if len(effects) > len(EFFECTS) else properties


def pyramid() -> World:
    """Unit boxes that stand on a floor."""
    world = World()
    world.create_body(Box(20, 2), position=(0, -1), kind="static")
    for row in range(BASE):
        for k in range(BASE - row):
            world.create_body(Box(1, 1), position=(1.1 * (k - 0.5 * (BASE - row - 1)), 0.5 + row))
    for _ in range(WARM_UP):
        world.step(1 / 60)
    return world


def count(world: World) -> dict[str, Any]:
    """Bytecodes of some steps, and how often each function of the engine was called."""
    codes, calls = 0, Counter[str]()

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal codes
        if event == "call":
            frame.f_trace_opcodes = True
            frame.f_trace_lines = False
            file = frame.f_code.co_filename
            if file.startswith(ROOT):
                calls[f"{file[len(ROOT) + 1 :]}:{frame.f_code.co_name}"] += 1
        codes += event == "opcode"
        return trace

    sys.settrace(trace)
    try:
        for _ in range(COUNTED):
            world.step(1 / 60)
    finally:
        sys.settrace(None)
    return {"bytecodes": codes, "calls": dict(sorted(calls.items())), "hash": world.state_hash()}


def signatures() -> dict[str, list[str]]:
    """What each kernel of the engine was compiled for."""
    return {
        f"{name}.{attribute}": [str(signature) for signature in value.signatures]
        for name, module in sorted(sys.modules.items())
        if name.startswith("engine.")
        for attribute, value in vars(module).items()
        if isinstance(value, numba.core.dispatcher.Dispatcher) and value.py_func.__module__ == name
    }


def effect_sets() -> dict[str, tuple[Effect, ...]]:
    """What the engine may have, by name."""
    first, second = (tuple(added(k) for k in part) for part in (range(MORE // 2), range(MORE // 2, MORE)))
    return {
        "as they are": EFFECTS,
        "with more": (*first, *EFFECTS, *second),
        "those used": tuple(effect for effect in EFFECTS if effect.name in USED),
    }


def report() -> dict[str, Any]:
    world = pyramid()
    used = {effect.name for effect in world.effects if effect.called_for}
    expected = world.state_hash()  # it has a kernel, too
    found = {"used": sorted(used), "hash": expected, "signatures": signatures()}
    found["counts"] = {}
    for name, effects in effect_sets().items():
        use(effects)
        found["counts"][name] = count(pyramid()) if numba.config.DISABLE_JIT else {"hash": pyramid().state_hash()}
        found["signatures after"] = signatures()
    return found


if __name__ == "__main__":
    json.dump(report(), sys.stdout)
