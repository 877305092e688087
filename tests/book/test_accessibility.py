"""axe-core finds nothing serious or critical of ours on any page, in the light and in the dark."""

from __future__ import annotations

from page_visits import Shown


def test_nothing_serious_of_ours(shown: Shown) -> None:
    assert shown.violations == []


def test_no_colours_in_the_dark_that_are_hard_to_see(served_dark: Shown) -> None:
    assert served_dark.violations == []
