"""Known mistakes in 4.4; a function's docstring is its hint."""

import numpy as np


def _weights(features, actions, rewards, ended, number, discount, gradient_step, *, all_so_far=True, fresh=False,
             oldest=True, end=True, after=False, at_once=False, sarsa=False, again=False, discounted=True,
             always_ends=False, ahead=1, early=False, taken_alone=True, slope=True, sign=1):  # fmt: skip
    weights, targets, steps = np.zeros((number, features.shape[1])), [], len(rewards)

    def target(t):
        last = end and (ended or always_ends) and t == steps - 1
        q = weights @ features[t + ahead]
        value = q[actions[t + 1]] if sarsa and t + 1 < steps else q.max()
        value = q[actions[t]] if again else value
        return rewards[t] + (0.0 if last else (discount if discounted else 1.0) * value)

    first = [target(t) for t in range(steps)]
    for t in range(steps):
        targets.append(first[t] if early else target(t))
        if after and t < steps - 1:
            continue
        seen = list(range(t + 1)) if all_so_far else [t]
        if fresh:
            targets = [target(k) for k in range(t + 1)]
        old = weights.copy() if at_once else weights
        for k in seen if oldest else seen[::-1]:
            error = sign * (targets[k] - old[actions[k]] @ features[k])
            changed = actions[k] if taken_alone else slice(None)
            weights[changed] += gradient_step * error * (features[k] if slope else 1.0)
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


def of_the_same_action(*arguments):
    """Use the largest value of the next state, not the value that the action just taken has there."""
    return _weights(*arguments, again=True)


def no_discount(*arguments):
    """Multiply the value of the next state by the discount factor."""
    return _weights(*arguments, discounted=False)


def cut_off_as_an_end(*arguments):
    """If the episode did not end but was only cut off, the value of the state after its last step counts."""
    return _weights(*arguments, always_ends=True)


def of_the_same_state(*arguments):
    """The target needs the largest value of the state after the step, not of the one before it."""
    return _weights(*arguments, ahead=0)


def all_targets_first(*arguments):
    """Compute a target when its step is made, with the weights trained so far, not all of them before the training."""
    return _weights(*arguments, early=True)


def of_all_actions(*arguments):
    """Change the weights of the action that was taken, and leave those of the other actions."""
    return _weights(*arguments, taken_alone=False)


def without_the_features(*arguments):
    """Multiply the error by the features: they are the derivatives of the value with respect to the weights."""
    return _weights(*arguments, slope=False)


def away_from_the_target(*arguments):
    """The sign is wrong: the change is in proportion to the target minus the value."""
    return _weights(*arguments, sign=-1)
