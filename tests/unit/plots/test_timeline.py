"""The timeline shows events in the order of their years."""

import pytest
from matplotlib.figure import Figure

from robonav.plots.timeline import HISTORY, SUBJECTS, Event, draw_timeline


def test_every_event_is_written_and_every_year_once():
    axes = Figure().add_subplot()
    draw_timeline(axes)
    texts = [text.get_text() for text in axes.texts]
    assert all(event.text in texts for event in HISTORY)
    years = [text for text in texts if text.isdigit()]
    assert years == [str(year) for year in sorted({event.year for event in HISTORY})]
    assert {event.subject for event in HISTORY} == set(SUBJECTS)


def test_events_in_another_order():
    subject = next(iter(SUBJECTS))
    with pytest.raises(ValueError, match="order of their years"):
        draw_timeline(
            Figure().add_subplot(),
            [Event(2000, "second", subject), Event(1990, "first", subject)],
        )
