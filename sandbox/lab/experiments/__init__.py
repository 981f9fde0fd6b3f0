"""Small scenes with a known answer, a file a family; experiment.py says what one is.

EXPERIMENTS: all of them by name. CONVERGED: those whose answer is not exact but a reference, which the laboratory makes
in `prepare`, and keeps.
"""

from __future__ import annotations

# They are listed everywhere in the order of these imports.
# isort: off
from sandbox.lab.experiments import flight
from sandbox.lab.experiments import swinging
from sandbox.lab.experiments import sliding
from sandbox.lab.experiments import slopes
from sandbox.lab.experiments import rolling
from sandbox.lab.experiments import bouncing
from sandbox.lab.experiments import impacts
from sandbox.lab.experiments import resting
from sandbox.lab.experiments import joined
from sandbox.lab.experiments import beams
from sandbox.lab.experiments import hard

# isort: on
from sandbox.lab.experiments.experiment import COPIES, EXPERIMENTS, Experiment, History, Measure, Watch, experiment
from sandbox.lab.experiments.hard import CONVERGED

__all__ = [
    "CONVERGED",
    "COPIES",
    "EXPERIMENTS",
    "Experiment",
    "History",
    "Measure",
    "Watch",
    "beams",
    "bouncing",
    "experiment",
    "flight",
    "hard",
    "impacts",
    "joined",
    "resting",
    "rolling",
    "sliding",
    "slopes",
    "swinging",
]
