"""The verbs of the command: one file each, one line here.

A verb has NAME, a docstring whose first line is its help, `add_arguments(parser)` and `run(options) -> exit code`.
These files alone wire the sandbox to the page (web) and to recordings; they import those when they run, so that
`tumble scenes` does not wait for a web server.
"""

from __future__ import annotations

from sandbox.verbs import accuracy, bench, effects, record, replay, run, scenes, stability, verify, warmup

VERBS = (run, scenes, record, replay, verify, accuracy, stability, effects, bench, warmup)
