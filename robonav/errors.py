"""Warnings and errors of the package that are none of Python's own."""


class ConvergenceWarning(UserWarning):
    """An iteration ran out of its budget; the message says how far it still was."""


class WorkerLost(RuntimeError):
    """Runs of an experiment killed the processes that did them, again and again."""
