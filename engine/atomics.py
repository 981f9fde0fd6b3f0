"""What threads need to work together inside one compiled region: counting, waiting, and letting others run."""

from __future__ import annotations

import os
import platform
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from engine.jit import kernel

PATIENCE = 2000
"""Looks at a counter before the thread lets others run: some 20 us. Fewer: a thread that shares its core with nobody
gives it up for nothing; more: one that does share it keeps the other from what both wait for."""

LINGERING = 8000
"""Looks at whether there is more to do, some 100 us, before a helper goes to sleep. More: it keeps a core from others
between two steps; fewer: it sleeps between two stages of one step, and takes 50 us to wake."""

HAS_PAUSE = platform.machine().lower() in ("x86_64", "amd64", "i686")
CAN_YIELD = hasattr(os, "sched_yield")  # so libc has it too


def count_up(counters: Any, place: int) -> int:
    """Adds one to counters[place], whoever else does at the same time. Returns what it was."""
    before = int(counters[place])
    counters[place] += 1
    return before


def read_now(counters: Any, place: int) -> int:
    """counters[place]; all that its writer did before can be seen from here on."""
    return int(counters[place])


def rest(looks: int) -> None:
    """A moment's rest between two looks at a counter."""


@kernel
def wait_for(counters, place, number):
    """Returns when counters[place] has reached a number."""
    looks = 0
    while read_now(counters, place) < number:
        looks += 1
        rest(looks)


@kernel
def linger(counters, seen):
    """Returns when the first counter is no longer what was seen, or after a while."""
    looks = 0
    while looks < LINGERING and read_now(counters, 0) == seen:
        looks += 1
        rest(looks)


def _address(context: Any, builder: Any, array: Any, value: Any, place: Any) -> Any:
    return builder.gep(context.make_array(array)(context, builder, value).data, [place])


@intrinsic
def _count_up(typing, counters, place):
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address = _address(context, builder, counters, *arguments)
        return builder.atomic_rmw("add", address, ir.Constant(ir.IntType(64), 1), "seq_cst")

    return types.int64(counters, types.intp), generate


@intrinsic
def _read_now(typing, counters, place):
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load_atomic(_address(context, builder, counters, *arguments), "seq_cst", 8)

    return types.int64(counters, types.intp), generate


@intrinsic
def _pause(typing):
    """Tells the processor that this is a loop that waits."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        if HAS_PAUSE:
            kind = ir.FunctionType(ir.VoidType(), [])
            builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.x86.sse2.pause"), [])
        return context.get_dummy_value()

    return types.void(), generate


_yield = types.ExternalFunction("sched_yield", types.intc())


@overload(count_up)
def _overload_count_up(counters, place):
    return lambda counters, place: _count_up(counters, place)


@overload(read_now)
def _overload_read_now(counters, place):
    return lambda counters, place: _read_now(counters, place)


@overload(rest)
def _overload_rest(looks):
    if not CAN_YIELD:
        return lambda looks: _pause()

    def rest(looks):
        if looks < PATIENCE:
            _pause()
        else:
            _yield()

    return rest


def new_counters(count: int) -> np.ndarray:
    """Room for so many counters."""
    return np.zeros(count, np.int64)
