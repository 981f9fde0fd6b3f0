"""Kernels on disk: an edit anywhere must be seen, and without an edit nothing is compiled twice.

Each test writes a few modules into an empty folder and runs them in processes of their own, as a user would.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import numba
import pytest

import engine.jit
from engine.jit import kernel

ROOT = Path(engine.jit.__file__).parents[1]

# Calls `run` of each module and prints {module: [value, loaded from disk, compiled]}.
MAIN = """
import importlib, json, sys
report = {}
for name in sys.argv[1:]:
    module = importlib.import_module(name)
    stats = module.run.stats
    value = getattr(module, "call", module.run)()
    report[name] = [value, sum(stats.cache_hits.values()), sum(stats.cache_misses.values())]
print(json.dumps(report))
"""

HELPER = """
from engine.jit import kernel

@kernel
def f():
    return 1
"""

# Every way to write an import of the helper.
IMPORTS = {
    "flat_from": ("from helper import f", "f()"),
    "flat_module": ("import helper", "helper.f()"),
    "flat_renamed": ("import helper as other", "other.f()"),
    "package.absolute": ("from package.helper import f", "f()"),
    "package.relative": ("from .helper import f", "f()"),
    "package.sibling": ("from . import helper", "helper.f()"),
    "package.submodule": ("from package import helper", "helper.f()"),
    "package.dotted": ("import package.helper as helper", "helper.f()"),
    "package.starred": ("from package.helper import *", "f()"),
    "package.inner.upwards": ("from ..helper import f", "f()"),
    "package.inner.reexported": ("from package.inner import f", "f()"),
    "package.two_steps": ("from package.absolute import run as f", "f()"),
    "package.guarded": ("try:\n    from package.helper import f\nexcept ImportError:\n    pass", "f()"),
}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A folder of modules that all call the same helper. Its engine is jit.py alone: that starts in half the time."""
    write(tmp_path, {"engine/__init__.py": "", "engine/jit.py": Path(engine.jit.__file__).read_text()})
    write(tmp_path, {"main.py": MAIN, "helper.py": HELPER, "package/__init__.py": "", "package/helper.py": HELPER})
    write(tmp_path, {"package/inner/__init__.py": "from package.helper import f"})
    for name, (line, call) in IMPORTS.items():
        write(tmp_path, {name.replace(".", "/") + ".py": caller(line, call)})
    return tmp_path


def caller(imports: str, expression: str, arguments: str = "") -> str:
    return f"from engine.jit import kernel\n{imports}\n\n@kernel\ndef run({arguments}):\n    return {expression}\n"


def write(folder: Path, sources: dict[str, str]) -> None:
    for name, source in sources.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(source))


def run(folder: Path, *modules: str, **environment: str) -> dict[str, list[int]]:
    """{module: [value, loaded from disk, compiled]}, from a new process."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA_", "COV_", "PYTHON"))}
    paths = os.pathsep.join([str(folder), str(ROOT)])
    done = subprocess.run(
        [sys.executable, str(folder / "main.py"), *modules],
        env={**kept, "PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1", **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def cache_files(folder: Path) -> set[Path]:
    return set(folder.rglob("*.nb[ic]"))


def test_edited_helper_is_seen_through_every_kind_of_import(tree: Path) -> None:
    first = run(tree, *IMPORTS)
    files = cache_files(tree)
    second = run(tree, *IMPORTS)
    assert {name: value for name, (value, *_) in first.items()} == dict.fromkeys(IMPORTS, 1)
    assert second == {name: [1, 1, 0] for name in IMPORTS}, "an unchanged kernel was compiled again"
    assert cache_files(tree) == files, "a run that compiled nothing left files behind"

    for name in ("helper.py", "package/helper.py"):
        write(tree, {name: HELPER.replace("return 1", "return 2")})
    third = run(tree, *IMPORTS)
    assert third == {name: [2, 0, 1] for name in IMPORTS}, "an old kernel came from the disk"

    for name in ("helper.py", "package/helper.py"):
        write(tree, {name: HELPER})
    assert run(tree, *IMPORTS) == second, "the code of the first state was thrown away"


def test_edited_constant_is_seen_and_unrelated_kernels_stay(tree: Path) -> None:
    write(tree, {"package/constants.py": "X = 10", "package/uses.py": caller("from package.constants import X", "X")})
    write(tree, {"package/derived.py": "from package.constants import X\nTWICE = 2 * X"})
    write(tree, {"package/uses_derived.py": caller("from package import derived", "derived.TWICE")})
    modules = ("package.uses", "package.uses_derived", "package.absolute")
    run(tree, *modules)
    write(tree, {"package/constants.py": "X = 30"})
    assert run(tree, *modules) == {
        "package.uses": [30, 0, 1],
        "package.uses_derived": [60, 0, 1],
        "package.absolute": [1, 1, 0],
    }


def test_edited_operator_reaches_kernels_that_do_not_import_it(tree: Path) -> None:
    # `helper` cannot know what + will mean for what it is handed; its code on disk has to know.
    vector = """
        import operator
        from typing import NamedTuple
        from numba.extending import overload
        from numba.core import types

        class Pair(NamedTuple):
            a: int
            b: int

        @overload(operator.add)
        def _add(left, right):
            if isinstance(left, types.BaseNamedTuple) and left.instance_class is Pair:
                return lambda left, right: left.a + right.b
        """
    write(tree, {"package/vector.py": vector, "package/adds.py": caller("", "left + right", "left, right")})
    entry = "from package.adds import run\nfrom package.vector import Pair\n\n"
    entry += "def call():\n    return run(Pair(1, 2), Pair(10, 20))\n"
    write(tree, {"package/entry.py": entry})
    assert run(tree, "package.entry") == {"package.entry": [21, 0, 1]}
    write(tree, {"package/vector.py": vector.replace("left.a + right.b", "left.a - right.b")})
    assert run(tree, "package.entry") == {"package.entry": [-19, 0, 1]}


@pytest.mark.parametrize("kind", ["class", "call"])
def test_reordered_fields_reach_kernels_that_do_not_import_the_tuple(tree: Path, kind: str) -> None:
    def layout(first: str, second: str) -> str:
        if kind == "class":
            return f"from typing import NamedTuple\n\nclass Pair(NamedTuple):\n    {first}: int\n    {second}: int\n"
        return f"from collections import namedtuple\n\nPair = namedtuple('Pair', '{first} {second}')\n"

    write(tree, {"package/pair.py": layout("big", "small"), "package/uses.py": caller("", "p.big - p.small", "p")})
    entry = (
        "from package.uses import run\nfrom package.pair import Pair\n\ndef call(): return run(Pair(small=3, big=5))\n"
    )
    write(tree, {"package/entry.py": entry})
    assert run(tree, "package.entry") == {"package.entry": [2, 0, 1]}
    write(tree, {"package/pair.py": layout("small", "big")})
    assert run(tree, "package.entry") == {"package.entry": [2, 0, 1]}, "big and small have changed places"


def test_settings_of_numba_and_options_have_code_of_their_own(tree: Path) -> None:
    source = (
        caller("import numpy as np\nZEROS = np.zeros(3)", "ZEROS[i]", "i") + "\ndef call():\n    return checked()\n"
    )
    source += (
        "\ndef checked():\n    try:\n        return float(run(-4)) * 0\n    except IndexError:\n        return -1\n"
    )
    write(tree, {"index.py": source})
    assert run(tree, "index") == {"index": [0, 0, 1]}
    assert run(tree, "index", NUMBA_BOUNDSCHECK="1") == {"index": [-1, 0, 1]}, "the unchecked kernel ran"
    assert run(tree, "index") == {"index": [0, 1, 0]}
    write(tree, {"index.py": source.replace("@kernel", "import os\n@kernel(boundscheck='CHECK' in os.environ)")})
    run(tree, "index")
    assert run(tree, "index", CHECK="1") == {"index": [-1, 0, 1]}


def test_cache_folder(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    chosen, home = tmp_path_factory.mktemp("chosen"), tmp_path_factory.mktemp("home")
    run(tree, "flat_from", NUMBA_CACHE_DIR=str(chosen))
    assert cache_files(chosen)
    assert not cache_files(tree)
    run(tree, "flat_from")
    assert {path.parent for path in cache_files(tree)} == {tree / "__pycache__"}

    read_only = tmp_path_factory.mktemp("read_only")
    write(read_only, {"main.py": MAIN, "alone.py": caller("", "7")})
    (read_only / "__pycache__").touch()  # a file: no folder of this name can be made, not even by root
    assert run(read_only, "alone", XDG_CACHE_HOME=str(home)) == {"alone": [7, 0, 1]}
    assert run(read_only, "alone", XDG_CACHE_HOME=str(home)) == {"alone": [7, 1, 0]}
    assert cache_files(home)
    (read_only / "nowhere").touch()
    for _ in range(2):
        assert run(read_only, "alone", XDG_CACHE_HOME=str(read_only / "nowhere")) == {"alone": [7, 0, 1]}


def test_each_kernel_keeps_its_last_few_versions(tree: Path) -> None:
    modules = ("package.absolute", "package.relative")
    run(tree, *modules)
    for file in cache_files(tree):  # as if the helper had been edited nine times before
        name, line, rest = file.name.split("-")
        for days in range(1, 10):
            older = file.with_name(f"{name}-{line}-{days:012x}{rest[12:]}")
            older.write_bytes(file.read_bytes())
            os.utime(older, (file.stat().st_mtime - 86400 * days,) * 2)
    write(tree, {"package/helper.py": HELPER.replace("return 1", "return 2")})
    run(tree, "package.absolute")
    for kind in ("nbi", "nbc"):
        assert len(list(tree.rglob(f"absolute.run-*.{kind}"))) == 6
        assert len(list(tree.rglob(f"relative.run-*.{kind}"))) == 10, "another kernel's code was removed"
    write(tree, {"package/helper.py": HELPER})
    assert run(tree, "package.absolute") == {"package.absolute": [1, 1, 0]}, "the newest version was removed"


def test_half_written_neighbour_does_no_harm(tree: Path) -> None:
    write(tree, {"package/broken.py": "def f(:"})
    assert run(tree, "package.absolute") == {"package.absolute": [1, 0, 1]}


def test_installed_packages_are_not_read(tmp_path: Path) -> None:
    folder = tmp_path / "site-packages"
    write(folder, {"main.py": MAIN, "ours/__init__.py": "", "theirs/__init__.py": "X = 1"})
    write(folder, {"ours/uses.py": caller("import theirs", "5")})
    run(folder, "ours.uses")
    write(folder, {"theirs/__init__.py": "X = 2"})
    assert run(folder, "ours.uses") == {"ours.uses": [5, 1, 0]}


def test_kernel_without_a_file_compiles() -> None:
    scope: dict[str, object] = {"__name__": "typed"}
    exec("def double(x):\n    return 2 * x", scope)
    double = kernel(scope["double"])  # type: ignore[type-var]
    assert double(21) == 42


def test_options_are_numbas_and_its_setting_is_put_back() -> None:
    setting = numba.config.CACHE_LOCATOR_CLASSES
    same = kernel(error_model="python")(_reciprocal)
    assert setting == numba.config.CACHE_LOCATOR_CLASSES
    if numba.config.DISABLE_JIT:
        assert same is _reciprocal
        return
    assert kernel(_reciprocal)(0.0) == float("inf")
    with pytest.raises(ZeroDivisionError):
        same(0.0)


def _reciprocal(x: float) -> float:
    return 1.0 / x


RACING = {
    "kernels.py": "from engine.jit import kernel\n\n\n@kernel\ndef f(x):\n    return x[0] + x[1]\n",
    # has noted that its code is in a file, but not written that file yet, while the other does all that it has to
    "slow.py": """
        import sys
        import numpy as np
        from kernels import f

        save = f._cache._cache_file._save_data

        def late(name, data):
            print("noted", flush=True)
            sys.stdin.readline()
            save(name, data)

        f._cache._cache_file._save_data = late
        f(np.array([1, 2], np.float64))
        """,
    "quick.py": """
        import subprocess, sys
        import numpy as np
        from kernels import f

        load = f._cache._cache_file._load_index

        def empty():
            found = load()
            other.append(subprocess.Popen([sys.executable, "slow.py"], stdin=-1, stdout=-1, text=True))
            other[0].stdout.readline()
            f._cache._cache_file._load_index = load
            return found

        other = []
        f(np.array([1, 2], np.int64))  # makes the folder
        f._cache._cache_file._load_index = empty
        f(np.array([1, 2], np.float32))
        other[0].communicate("go on")
        """,
    "after.py": """
        import numpy as np
        from kernels import f

        print(f(np.array([1, 2], np.float32)), f(np.array([1, 2], np.float64)))
        """,
}


def test_two_processes_that_compile_at_the_same_time_do_not_mix_their_code(tmp_path: Path) -> None:
    write(tmp_path, {name: dedent(text) for name, text in RACING.items()})
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}:{tmp_path}"}
    environment.pop("NUMBA_CACHE_DIR", None)
    for program in ("quick.py", "after.py"):
        result = subprocess.run(
            [sys.executable, program], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert result.returncode == 0, result.stderr
    assert result.stdout.split() == ["3.0", "3.0"]
