"""axe-core finds nothing serious or critical of ours on any page, in the light and in the dark."""

from __future__ import annotations

import pytest
from page_visits import Shown


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_serious_of_ours(shown: Shown, scheme: str) -> None:
    assert shown.violations[scheme] == []
