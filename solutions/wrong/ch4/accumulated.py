"""Known mistakes in 4.4; a function's docstring is its hint."""

import numpy as np


def _weights(features, actions, rewards, ended, number, discount, gradient_step, *, all_so_far=True, fresh=False,
             oldest=True, end=True, after=False, at_once=False, sarsa=False, discounted=True):  # fmt: skip
    weights, targets, steps = np.zeros((number, features.shape[1])), [], len(rewards)

    def target(t):
        last = end and ended and t == steps - 1
        q = weights @ features[t + 1]
        value = q[actions[t + 1]] if sarsa and t + 1 < steps else q.max()
        return rewards[t] + (0.0 if last else (discount if discounted else 1.0) * value)

    for t in range(steps):
        targets.append(target(t))
        if after and t < steps - 1:
            continue
        seen = list(range(t + 1)) if all_so_far else [t]
        if fresh:
            targets = [target(k) for k in range(t + 1)]
        old = weights.copy() if at_once else weights
        for k in seen if oldest else seen[::-1]:
            weights[actions[k]] += (
                gradient_step
                * (targets[k] - old[actions[k]] @ features[k])
                * features[k]
            )
    return weights


def newest_alone(*arguments):
    """This is one-step learning: NNQL trains on all pairs so far after each step."""
    return _weights(*arguments, all_so_far=False)


def fresh_targets(*arguments):
    """Keep the targets as they were computed. Fitted Q iteration would compute them again."""
    return _weights(*arguments, fresh=True)


def newest_first(*arguments):
    """Go through the pairs from the oldest to the newest."""
    return _weights(*arguments, oldest=False)


def at_the_end(*arguments):
    """Train after each step, not only when the episode is over."""
    return _weights(*arguments, after=True)


def all_at_once(*arguments):
    """Each pair changes the weights immediately, and the next pair uses the changed weights."""
    return _weights(*arguments, at_once=True)


def on_from_the_end(*arguments):
    """If the episode ended, the last step has no next state: its target is only the reward."""
    return _weights(*arguments, end=False)


def of_the_next_action(*arguments):
    """This is SARSA's target. Q-learning uses the largest value of the next state, whichever action is taken there."""
    return _weights(*arguments, sarsa=True)


def no_discount(*arguments):
    """Multiply the value of the next state by the discount factor."""
    return _weights(*arguments, discounted=False)
