"""The bench's results as tables for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from sandbox.lab.bench import BLOCK, BenchResult
from sandbox.lab.tables import rendered
from sandbox.lab.timing import Ratio


def as_text(results: Sequence[BenchResult]) -> str:
    """Times of whole steps, with those of the peers below each scene's; then where our time went."""
    return "\n\n".join(rendered(table) for table in (step_table(results), stage_table(results)))


def step_table(results: Sequence[BenchResult]) -> Table:
    """CPU time a step, and ours over that of each peer: below 1 we are faster."""
    caption = f"CPU time; ratio: ours to theirs, median and quartiles over turns of {BLOCK} steps"
    table = Table(box=None, pad_edge=False, caption=caption, caption_justify="left")
    table.add_column("scene", no_wrap=True)
    for title in ("bodies", "contacts", "ms a step", "least", "99 %", "ratio"):
        table.add_column(title, justify="right", no_wrap=True)
    for result in results:
        times = (result.ms_median, result.ms_min, result.ms_p99)
        table.add_row(result.scene, str(result.bodies), str(result.contacts), *map(_ms, times))
        for name, peer in result.peers.items():
            table.add_row(f"  {name}", "", "", _ms(peer.ms_median), "", "", _ratio(peer.ratio))
    return table


def stage_table(results: Sequence[BenchResult]) -> Table:
    """Wall time of our stages, a column a scene."""
    table = Table(box=None, pad_edge=False)
    table.add_column("stage, ms a step", no_wrap=True)
    for result in results:
        table.add_column(result.scene, justify="right")
    for stage in results[0].stages:
        table.add_row(stage, *(_ms(result.stages[stage]) for result in results))
    return table


def _ms(value: float) -> str:
    """Milliseconds, to the microsecond where that says something."""
    return f"{value:.3f}" if value < 10.0 else f"{value:.1f}"


def _ratio(ratio: Ratio) -> str:
    return f"{ratio.median:.3f} ({ratio.low:.3f} to {ratio.high:.3f})"
