"""What the verbs of the laboratory share: names to choose from, and a folder to write into."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Callable, Iterable
from pathlib import Path

from sandbox.verbs.common import BadInput
from sandbox.verbs.writable import folder_hindrance, hindrance


def add_folder(parser: argparse.ArgumentParser, does: str) -> None:
    """-o DIR."""
    parser.add_argument("-o", "--output", type=Path, metavar="DIR", help=does)


def chosen_names(what: str, given: Iterable[str], known: Iterable[str]) -> list[str]:
    """The names that were given, each once; all if none was. BadInput if there is no such thing."""
    names = list(known)
    chosen = list(dict.fromkeys(given))
    for name in chosen:
        if name not in names:
            close = difflib.get_close_matches(name[:80], names, n=1, cutoff=0.4)
            hint = f"; did you mean {close[0]!r}?" if close else f"; it must be one of {', '.join(names)}"
            raise BadInput(f"there is no {what} {name[:80]!r}{hint}")
    return chosen or names


def check_folder(folder: Path | None, files: Iterable[str]) -> None:
    """BadInput if these files cannot be written into the folder, which need not be there yet. Makes nothing."""
    if folder is None:
        return
    if why := folder_hindrance(folder):
        raise BadInput(f"-o {folder}: cannot be made or written into: {why}")
    for file in files:
        if (folder / file).parent.is_dir() and (why := hindrance(folder / file)):
            raise BadInput(f"-o {folder}: {file} cannot be written: {why}")


def prepare_folder(folder: Path | None) -> None:
    """Makes the folder."""
    if folder is not None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise BadInput(f"-o {folder}: cannot be made: {error.strerror}") from None


def write_file(file: Path, write: Callable[[Path], object]) -> None:
    """Writes a file of the report."""
    try:
        write(file)
    except OSError as error:
        raise BadInput(f"-o {file.parent}: {file.name} cannot be written: {error.strerror}") from None
