"""Time the engine."""

NAME = "bench"


def add_arguments(parser):
    pass


def run(options):
    return 0
