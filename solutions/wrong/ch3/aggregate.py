"""Known mistakes in 3.6; a function's docstring is its hint."""

import numpy as np


def _gathered(
    states,
    labels,
    visited,
    advice,
    capacity,
    *,
    renew=True,
    replace=True,
    heed=True,
    oldest=True,
    unique=True,
):
    kept = [
        (tuple(state), label) for state, label in zip(states.tolist(), labels.tolist())
    ]
    for state, label in zip(map(tuple, visited.tolist()), advice.tolist()):
        if heed and label < 0:
            continue
        places = (
            [n for n, (known, _) in enumerate(kept) if known == state] if unique else []
        )
        if places and not replace:
            continue
        if places and not renew:
            kept[places[0]] = (state, label)
            continue
        for place in reversed(places):
            del kept[place]
        kept.append((state, label))
    kept = kept[-capacity:] if oldest else kept[:capacity]
    return np.array([s for s, _ in kept], dtype=int).reshape(
        -1, states.shape[1]
    ), np.array([n for _, n in kept], dtype=int)


def only_the_new(states, labels, visited, advice, capacity):
    """Keep the data of earlier rounds: DAgger trains on the data of all rounds."""
    return _gathered(states[:0], labels[:0], visited, advice, capacity)


def learns_from_silence(states, labels, visited, advice, capacity):
    """A label of -1 means that there is none: do not add such a state."""
    return _gathered(states, labels, visited, advice, capacity, heed=False)


def first_advice_stays(states, labels, visited, advice, capacity):
    """The newest label of a state replaces the older one."""
    return _gathered(states, labels, visited, advice, capacity, replace=False)


def keeps_both(states, labels, visited, advice, capacity):
    """Each state occurs in the data once: remove its old pair when it gets a new label."""
    return _gathered(states, labels, visited, advice, capacity, unique=False)


def keeps_its_place(states, labels, visited, advice, capacity):
    """A state with a new label counts as the newest: move it to the end."""
    return _gathered(states, labels, visited, advice, capacity, renew=False)


def newest_go(states, labels, visited, advice, capacity):
    """When there are too many pairs, remove the oldest."""
    return _gathered(states, labels, visited, advice, capacity, oldest=False)


def _listed(kept, states):
    return np.array([s for s, _ in kept], dtype=int).reshape(
        -1, states.shape[1]
    ), np.array([n for _, n in kept], dtype=int)


def _pairs(states, labels):
    return dict(zip(map(tuple, states.tolist()), labels.tolist()))


def silence_deletes(states, labels, visited, advice, capacity):
    """A label of -1 changes nothing: a state that is in the data keeps its label and its place."""
    kept = _pairs(states, labels)
    for state, label in zip(map(tuple, visited.tolist()), advice.tolist()):
        kept.pop(state, None)
        if label >= 0:
            kept[state] = label
    return _listed(list(kept.items())[-capacity:], states)


def silence_renews(states, labels, visited, advice, capacity):
    """A visit without a label changes nothing: it does not make a known state the newest."""
    kept = _pairs(states, labels)
    for state, label in zip(map(tuple, visited.tolist()), advice.tolist()):
        if label >= 0:
            kept.pop(state, None)
            kept[state] = label
        elif state in kept:
            kept[state] = kept.pop(state)
    return _listed(list(kept.items())[-capacity:], states)


def newest_first(states, labels, visited, advice, capacity):
    """Return the oldest pair first."""
    kept, of = _gathered(states, labels, visited, advice, capacity)
    return kept[::-1], of[::-1]


def makes_room_first(states, labels, visited, advice, capacity):
    """Remove the oldest pairs at the end: a new label of a known state needs no room."""
    kept = _pairs(states, labels)
    for state, label in zip(map(tuple, visited.tolist()), advice.tolist()):
        if label < 0:
            continue
        if len(kept) >= capacity:
            del kept[next(iter(kept))]
        kept.pop(state, None)
        kept[state] = label
    return _listed(list(kept.items())[-capacity:], states)


def first_of_the_round(states, labels, visited, advice, capacity):
    """A state may be visited several times in a round: its newest label counts there, too."""
    seen, first = set(), []
    for n, (state, label) in enumerate(
        zip(map(tuple, visited.tolist()), advice.tolist())
    ):
        if label >= 0 and state not in seen:
            seen.add(state)
            first.append(n)
    return _gathered(states, labels, visited[first], advice[first], capacity)


def has_no_limit(states, labels, visited, advice, capacity):
    """The memory holds ``capacity`` pairs: remove the oldest if there are more."""
    return _gathered(states, labels, visited, advice, 10**6)
