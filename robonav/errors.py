"""Warnings and errors of the package."""


class ConvergenceWarning(UserWarning):
    """An iteration stopped before it converged. The message says how far it was from convergence."""


class WorkerLost(RuntimeError):
    """Runs of an experiment repeatedly killed their worker processes."""
