"""A number and what it counts, in the singular or the plural."""

from __future__ import annotations


def counted(number: int, one: str, many: str = "") -> str:
    """Return a number with its noun.

    Parameters
    ----------
    number : int
        How many there are.
    one : str
        The noun in the singular.
    many : str
        The noun in the plural; by default the singular with an s.

    Returns
    -------
    str

    Examples
    --------
    >>> counted(1, "pair"), counted(2, "pair"), counted(0, "policy", "policies")
    ('1 pair', '2 pairs', '0 policies')
    """
    return f"{number} {one if number == 1 else many or f'{one}s'}"
