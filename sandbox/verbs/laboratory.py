"""What the verbs of the laboratory share: names to choose from, and a folder to write into."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Callable, Iterable
from pathlib import Path

from sandbox.verbs.common import BadInput


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


def prepare_folder(folder: Path | None) -> None:
    """Makes the folder, before minutes of measuring are lost for want of it."""
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
