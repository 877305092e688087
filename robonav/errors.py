"""Warnings and errors of the package."""


class ConvergenceWarning(UserWarning):
    """An iteration stopped before it converged. The message tells how far it was from convergence."""


class WorkerLost(RuntimeError):
    """Raised when runs of an experiment killed their worker processes again and again."""
