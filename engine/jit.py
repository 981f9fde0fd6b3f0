"""@kernel: one place for numba's options, and a disk cache that knows what a kernel imports.

numba keeps compiled code on disk and throws it away when the *file* of the kernel changes. It does not look at the
files that this one imports, so a kernel that calls a helper, or reads a constant, from another file goes on running the
old one after an edit, silently. `KernelLocator` closes this through numba's own extension point. Code on disk is fresh
only while all of this is unchanged:

- the kernel's file and, recursively, the files it imports (read as text, never executed);
- every file of the package that extends numba: operators of Vec2 or of lanes reach kernels that import neither;
- the fields of every NamedTuple of the package: a kernel that is handed one need not import it, and numba itself
  compares the types of its fields, not their names or order;
- the kernel's options, the settings of numba that change the compiled code, and the versions of numpy and llvmlite.

All of it is hashed into the name of the cache file, so two checkouts, branches or settings never read each other's
code; each kernel keeps its last few. What remains with the author of a kernel:

- a global constant is written down or computed from other constants; one read from the environment is not seen here;
- no compiled function is an argument or a closure's free variable: numba would miss the cache at each start and leave a
  file behind each time. For the same reason a NamedTuple is defined at module level.
"""

from __future__ import annotations

import ast
import hashlib
import os
import sys
import tempfile
import threading
import uuid
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, Self, TypeVar, overload

import llvmlite
import numba
import numpy as np
from numba.core.caching import _CacheLocator
from numba.misc.appdirs import AppDirs

__all__ = ["OPTIONS", "KernelLocator", "kernel"]

Function = TypeVar("Function", bound=Callable[..., Any])

# fastmath stays off: results would depend on the CPU. error_model="numpy" divides without a test for zero, as C does.
# Indices are checked when NUMBA_BOUNDSCHECK=1 is set, and not otherwise.
OPTIONS: dict[str, Any] = {"nopython": True, "nogil": True, "error_model": "numpy", "fastmath": False}

config: Any = numba.config
_ENGINE = Path(__file__).resolve().parent
_SETTINGS = ("BOUNDSCHECK", "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "DEBUGINFO_DEFAULT", "LLVM_REFPRUNE_FLAGS")
_KEPT = 6  # versions of one kernel on disk: those of a few edits, branches and settings
_PROCESS = uuid.uuid4().hex[:8]  # beside the process number, which a machine gives again
_decorating = threading.RLock()


@overload
def kernel(function: Function, /) -> Function: ...
@overload
def kernel(**options: Any) -> Callable[[Function], Function]: ...
def kernel(function: Callable[..., Any] | None = None, /, **options: Any) -> Any:
    """Compile a function with the engine's options: `@kernel`, or `@kernel(parallel=True)` to add or change some.

    It is compiled at its first call and kept on disk where a folder can be written: in NUMBA_CACHE_DIR, or __pycache__
    beside its file, or the user's cache folder. Without any (or for a function typed at a prompt) it just compiles.
    With NUMBA_DISABLE_JIT=1 the plain function comes back.
    """
    if function is None:
        return lambda function: _compile(function, {**OPTIONS, **options})
    return _compile(function, OPTIONS)


def _compile(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    path = Path(function.__code__.co_filename)
    # Coverage of compiled lines is noted while compiling: a kernel from the cache would count as never run.
    folder = _cache_folder(str(path.parent), config.CACHE_DIR) if path.exists() and not config.JIT_COVERAGE else None
    function.__kernel_options__ = options  # type: ignore[attr-defined]  # read by KernelLocator
    with _decorating:  # the setting is numba's own and process-wide: ours only while this one function is wrapped
        before = config.CACHE_LOCATOR_CLASSES
        config.CACHE_LOCATOR_CLASSES = f"{__name__}.{KernelLocator.__name__}"
        try:
            compiled = numba.jit(**{"cache": folder is not None, **options})(function)
        finally:
            config.CACHE_LOCATOR_CLASSES = before
    if folder is not None and not config.DISABLE_JIT:
        _name_apart(compiled)
    return compiled


def _name_apart(compiled: Any) -> None:
    """Lets this process write code under names of its own.

    numba counts: two processes that compile one kernel for different types at the same time both write file 1, and
    whoever reads the index of the one may be given the code of the other, made for other types: it crashes.
    """
    file = compiled._cache._cache_file
    numbered = file._data_name
    file._data_name = lambda number: numbered(number).replace(".nbc", f".{os.getpid()}.{_PROCESS}.nbc")


class KernelLocator(_CacheLocator):
    """Tells numba where a kernel's compiled code lies on disk, and whether it is fresh."""

    def __init__(self, function: Callable[..., Any], path: str, folder: str) -> None:
        self._py_file = path  # numba reads this name for its warnings
        self._folder = folder
        self._line = function.__code__.co_firstlineno
        self._kernel = f"{Path(path).stem}.{function.__qualname__}".replace("<", "").replace(">", "")
        self._stamp = _stamp(function, Path(path).resolve())

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> Self | None:
        folder = _cache_folder(os.path.dirname(py_file), config.CACHE_DIR) if os.path.exists(py_file) else None
        return None if folder is None else cls(py_func, py_file, folder)

    def get_cache_path(self) -> str:
        return self._folder

    def get_source_stamp(self) -> str:
        return self._stamp

    def get_disambiguator(self) -> str:
        # numba writes an index first and the code after it: with the stamp in the name, a process that is killed
        # between the two, or another one that reads then, never pairs a new index with old code.
        return f"{self._line}-{self._stamp[:12]}"

    def ensure_cache_path(self) -> None:
        """numba asks for this before it saves: the oldest code of the same kernel makes room."""
        super().ensure_cache_path()
        versions: dict[str, list[Path]] = {}  # by stamp, newest first; a file is kernel-line-stamp.py311.1.nbc
        for file in sorted(Path(self._folder).glob(f"{self._kernel}-*-*.nb[ic]"), key=_saved, reverse=True):
            versions.setdefault(file.name.removeprefix(f"{self._kernel}-").split("-")[1][:12], []).append(file)
        versions.pop(self._stamp[:12], None)
        for files in list(versions.values())[_KEPT - 1 :]:
            for file in files:
                file.unlink(missing_ok=True)


def _saved(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except FileNotFoundError:  # another process made room too
        return 0


@cache
def _cache_folder(source_folder: str, chosen: str) -> str | None:
    """The first folder that can be written: numba's own choices in numba's own order."""
    user_wide = str(AppDirs(appname="numba", appauthor=False).user_cache_dir)
    inside: str = _CacheLocator.get_suitable_cache_subpath(os.path.join(source_folder, "_"))
    candidates = [os.path.join(source_folder, "__pycache__"), os.path.join(user_wide, inside)]
    if chosen:
        candidates.insert(0, os.path.join(chosen, inside))
    for folder in candidates:
        try:
            os.makedirs(folder, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


# --- what compiled code depends on -----------------------------------------------------------------------------------
# Modules are imported at different moments of a long run while somebody edits. A file is read once, for the first
# kernel that depends on it, and again if it has changed when a kernel of its own is made: that is what really runs.

Roots = tuple[tuple[str, Path], ...]  # the packages to look into, and the folder that holds each


class Source(NamedTuple):
    """What matters of one file."""

    digest: str
    imports: tuple[tuple[int, str, tuple[str, ...]], ...]  # (level, module, names): names is empty for `import module`
    extends_numba: bool
    layouts: tuple[str, ...]  # its NamedTuples: "Vec2: x y"


def _stamp(function: Callable[..., Any], path: Path) -> str:
    """One hash over everything that the compiled code of `function` depends on, apart from its argument types."""
    name = _module_name(function, path)
    root = (path.parent if path.stem == "__init__" else path).parents[name.count(".")]
    if path in _sources and _sources[path].digest != hashlib.sha256(path.read_bytes()).hexdigest():
        del _sources[path]
        _source_stamp.cache_clear()
    options = sorted(getattr(function, "__kernel_options__", OPTIONS).items())
    settings = [(setting, getattr(config, setting, None)) for setting in _SETTINGS]
    sources = _source_stamp(name, path, tuple({"engine": _ENGINE.parent, name.partition(".")[0]: root}.items()))
    return _hash(repr((options, settings, np.__version__, llvmlite.__version__, sources)))


def _module_name(function: Callable[..., Any], path: Path) -> str:
    if function.__module__ != "__main__":
        return function.__module__
    spec = getattr(sys.modules.get("__main__"), "__spec__", None)  # set for `python -m package.module`
    return spec.name if spec is not None else path.stem


@cache
def _source_stamp(name: str, path: Path, roots: Roots) -> str:
    layouts: list[str] = []
    waiting = [(name, path)]
    for module, file in (entry for top, folder in roots for entry in _package_files(folder, top)):
        source = _read(file)
        layouts += source.layouts
        if source.extends_numba:
            waiting.append((module, file))
    found = dict(waiting)
    while waiting:
        for module, file in _imported(*waiting.pop(), roots):
            if module not in found:
                found[module] = file
                waiting.append((module, file))
    return _hash("\n".join([*sorted(layouts), *sorted(_read(file).digest for file in found.values())]))


def _imported(module: str, file: Path, roots: Roots) -> Iterator[tuple[str, Path]]:
    """The modules that one file names. In `from package import name`, a name may be a module or stand in __init__."""
    package = module if file.stem == "__init__" else module.rpartition(".")[0]
    for level, named, names in _read(file).imports:
        above = package.split(".")[: package.count(".") + 2 - level] if level else []
        target = ".".join([*above, named] if named else above)
        inner = {f"{target}.{name}" for name in names}
        for candidate in {name if _find(name, roots) else target for name in inner} or {target}:
            if (found := _find(candidate, roots)) is not None:
                yield candidate, found


@cache
def _find(module: str, roots: Roots) -> Path | None:
    """The file of a module of the kernel's package, of the engine, or beside either; never an installed package's."""
    top, *rest = module.split(".")
    folders = [folder for name, folder in roots if name == top]
    for folder in folders or [folder for _, folder in roots if not folder.name.endswith("-packages")]:
        stem = folder.joinpath(top, *rest)
        for file in (stem.with_name(f"{stem.name}.py"), stem / "__init__.py"):
            if file.is_file():
                return file
    return None


@cache
def _package_files(folder: Path, top: str) -> list[tuple[str, Path]]:
    """Every file of a package, with its module name."""
    files = sorted((folder / top).rglob("*.py")) if (folder / top).is_dir() else []
    stems = [file.parent if file.stem == "__init__" else file.with_suffix("") for file in files]
    return [(".".join(stem.relative_to(folder).parts), file) for stem, file in zip(stems, files, strict=True)]


_sources: dict[Path, Source] = {}


def _read(file: Path) -> Source:
    if file not in _sources:
        try:
            _sources[file] = _parse(file.read_bytes())
        except FileNotFoundError:  # removed since the folder was listed
            _sources[file] = Source("", (), False, ())
    return _sources[file]


def _parse(content: bytes) -> Source:
    digest = hashlib.sha256(content).hexdigest()
    try:
        tree = ast.parse(content)
    except SyntaxError:  # half-written; whatever imports it will say so
        return Source(digest, (), False, ())
    imports: list[tuple[int, str, tuple[str, ...]]] = []
    layouts: list[str] = []
    for node in _statements(tree.body):
        if isinstance(node, ast.ImportFrom):
            imports.append((node.level, node.module or "", tuple(alias.name for alias in node.names)))
        elif isinstance(node, ast.Import):
            for alias in node.names:
                imports.append((0, alias.name, ()))
                if alias.asname is None and "." in alias.name:  # `import a.b` binds a: a.name may be read through it
                    imports.append((0, alias.name.partition(".")[0], ()))
        elif isinstance(node, ast.ClassDef) and any(_last_name(base) == "NamedTuple" for base in node.bases):
            fields = [ast.unparse(item.target) for item in node.body if isinstance(item, ast.AnnAssign)]
            layouts.append(f"{node.name}: {' '.join(fields)}")
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            layouts += [ast.unparse(node.value)] if _last_name(node.value.func) in ("NamedTuple", "namedtuple") else []
    extends = b"numba.extending" in content or b"numba.core" in content
    extends |= any(module == "numba" and {"extending", "core"} & set(names) for _, module, names in imports)
    return Source(digest, tuple(imports), extends, tuple(layouts))


def _statements(body: list[Any]) -> Iterator[ast.AST]:
    """Statements at any depth. Expressions, most of a tree, are left out: so reading takes half the time."""
    for node in body:
        yield node
        for inner in ("body", "orelse", "finalbody", "handlers", "cases"):
            yield from _statements(getattr(node, inner, []))


def _last_name(node: ast.expr) -> str:
    """`c` of a.b.c."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
