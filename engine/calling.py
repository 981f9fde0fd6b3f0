"""Calling compiled kernels by their address, from within another kernel.

A kernel that calls others by name is compiled together with all of them. One that is given their addresses is compiled
by itself, once for the types of what it hands on; and those that it calls are the same that Python calls.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numba.extending import intrinsic

types: Any = numba.types


@intrinsic
def call(typing, address, result, arguments):
    """Calls the kernel at an address with a tuple of arguments. result: a value of the type that it returns."""
    returned = types.unliteral(result)
    handed_on = tuple(types.unliteral(argument) for argument in arguments.types)

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        convention = context.call_conv
        kind = convention.get_function_type(returned, handed_on)
        place = builder.inttoptr(values[0], kind.as_pointer())
        parts = [
            context.cast(builder, builder.extract_value(values[2], k), given, wanted)
            for k, (given, wanted) in enumerate(zip(arguments.types, handed_on, strict=True))
        ]
        status, value = convention.call_function(builder, place, returned, handed_on, parts)
        with builder.if_then(status.is_error, likely=False):
            convention.return_status_propagate(builder, status)
        return value

    return returned(address, result, arguments), generate


def address_of(kernel: Any, result: Any, arguments: tuple) -> int:
    """Where the compiled code of a kernel for such arguments is. TypeError if it does not return what `result` is.

    It stays there as long as the kernel lives. numba takes long to tell the types of arguments, so it is asked once for
    each layout of them.
    """
    key = (kernel, type(result), *(_layout(argument) for argument in arguments))
    if key not in _addresses:
        _addresses[key] = _find_address(kernel, result, arguments)
    return _addresses[key]


_addresses: dict[tuple, int] = {}


def _layout(argument: Any) -> Any:
    """What the type of an argument depends on."""
    if isinstance(argument, np.ndarray):
        return argument.dtype, argument.ndim, argument.flags.num
    return type(argument)


def _find_address(kernel: Any, result: Any, arguments: tuple) -> int:
    kinds = tuple(kernel.typeof_pyval(argument) for argument in arguments)
    compiled = _find(kernel, kinds)
    if compiled is None:
        kernel.compile(kinds)
        compiled = _find(kernel, kinds)
    returned = types.unliteral(compiled.signature.return_type)
    if returned != numba.typeof(result):
        raise TypeError(f"{kernel.__name__} returns {returned}, not {numba.typeof(result)}")
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))


def _find(kernel: Any, kinds: tuple) -> Any:
    """What the kernel was compiled to for arguments of these types, None if it was not."""
    for compiled in kernel.overloads.values():
        if _flat(compiled.signature.args) == kinds:
            return compiled
    return None


def _flat(kinds: tuple) -> tuple:
    """Types of arguments, those that a kernel takes as *arguments one by one, as they are handed on."""
    return sum((kind.types if isinstance(kind, types.BaseTuple) else (kind,) for kind in kinds), ())
