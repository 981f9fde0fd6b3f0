"""Tables for a terminal, or as lines where nobody watches."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

WIDTH = 120  # where the report does not go to a terminal [characters]


def rendered(table: Table) -> str:
    """As text. Whoever reads it from a pipe takes lines as they are."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=WIDTH)
    with console.capture() as captured:
        console.print(table)
    return "\n".join(line.rstrip() for line in captured.get().rstrip().split("\n"))
