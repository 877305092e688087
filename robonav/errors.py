"""Warnings of the package."""


class ConvergenceWarning(UserWarning):
    """An iteration ran out of its budget; the message says how far it still was."""
