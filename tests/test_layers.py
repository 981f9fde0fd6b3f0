"""Imports point one way: engine <- sandbox <- web, engine <- recordings.

Read from the source text. The engine must run where neither viser nor rerun is wanted; compiled code on disk depends on
what its file imports; and whoever reads a file may rely on what it cannot know.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

LAYERS = {
    "engine": {"engine", "numpy", "numba"},
    "sandbox": {"sandbox", "engine", "numpy", "rich"},
    "web": {"web", "sandbox", "engine", "numpy", "rich", "viser", "websockets", "msgspec", "zstandard", "trimesh"},
    "recordings": {"recordings", "engine", "numpy", "rerun", "rerun_bindings", "pyarrow"},
}
# Files and folders that may import more than their layer does.
EXCEPTIONS = {
    "engine/jit.py": {"llvmlite"},
    "engine/simd.py": {"llvmlite"},
    "engine/rows.py": {"llvmlite"},
    "engine/atomics.py": {"llvmlite"},
    # The command line wires everything together ...
    "sandbox/cli.py": {"web", "recordings", "viser", "rerun"},
    "sandbox/verbs/": {"web", "recordings", "viser", "rerun"},
    # ... and the laboratory draws diagrams, and compares with engines, and asks clusters, that are extras.
    "sandbox/lab/": {"pyb2d3", "pymunk", "matplotlib", "distributed"},
}


def module_name(file: str) -> str:
    return file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


FILES = [str(path.relative_to(ROOT)) for layer in LAYERS for path in sorted((ROOT / layer).rglob("*.py"))]
MODULES = {module_name(file): file for file in FILES}


def imports(nodes: list[ast.stmt], package: str, *, everywhere: bool) -> Iterator[str]:
    """Full names of what is imported: of `from a import b`, "a.b" if that is a module, else "a"."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            outer = package.split(".")[: package.count(".") + 2 - node.level] if node.level else []
            module = ".".join([*outer, *filter(None, [node.module])])
            inner = [f"{module}.{alias.name}" for alias in node.names]
            yield from (name if name in MODULES else module for name in inner)
        elif isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            if everywhere:
                yield from imports(node.body, package, everywhere=True)
        elif everywhere or not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            for field in ("body", "orelse", "finalbody", "handlers", "cases"):
                yield from imports(getattr(node, field, []), package, everywhere=everywhere)


def imports_of(file: str, *, everywhere: bool) -> set[str]:
    package = module_name(file) if file.endswith("/__init__.py") else module_name(file).rpartition(".")[0]
    tree = ast.parse((ROOT / file).read_text())
    return set(imports(tree.body, package, everywhere=everywhere))


def allowed(file: str) -> set[str]:
    more = [
        names for place, names in EXCEPTIONS.items() if file == place or (place[-1] == "/" and file.startswith(place))
    ]
    return LAYERS[file.partition("/")[0]].union(sys.stdlib_module_names, *more)


@pytest.mark.parametrize("file", FILES)
def test_imports_stay_in_their_layer(file: str) -> None:
    packages = {name.partition(".")[0] for name in imports_of(file, everywhere=True)}
    assert packages <= allowed(file), f"{file} may not import {', '.join(sorted(packages - allowed(file)))}"


@pytest.mark.parametrize("layer", LAYERS)
def test_no_module_imports_itself_through_others(layer: str) -> None:
    modules = {name: file for name, file in MODULES.items() if name.partition(".")[0] == layer}
    graph = {name: (imports_of(file, everywhere=False) & modules.keys()) - {name} for name, file in modules.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" imports ".join(reversed(error.args[1])))


def test_every_layer_was_read() -> None:
    assert {file.partition("/")[0] for file in FILES} == set(LAYERS)
