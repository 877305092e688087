"""The training loop against a plain one, robot by robot, episode by episode and step by step."""

import numpy as np

from robonav.networks.multilayer_perceptron import random_network
from robonav.networks.network_stack import stacked
from robonav.nnql import NavigationTask, reward
from robonav.nnql._fast.agents import Agent
from robonav.nnql._fast.networks import BatchedNetworks
from robonav.nnql._fast.trainer import EpisodeStatistics, Trainer
from robonav.nnql.task import EXPLORING, make_rng
from robonav.robot import OUTCOMES, REFLEX, Simulator

SEEDS, EPISODES = (3, 8), 24
COURSE = NavigationTask(max_steps=45)


class Watching(Agent):
    """Learns nothing, and writes down what it is handed."""

    def __init__(self, networks):
        super().__init__(networks)
        self.seen = [[] for _ in SEEDS]

    def observe(self, rows, steps):
        for k, row in enumerate(rows):
            self.seen[row].append(
                (steps.inputs[k], steps.actions[k], steps.rewards[k], steps.reached[k], steps.terminal[k],
                 steps.fraction[k])
            )  # fmt: skip


def plain_episode(network, seed, episode):
    """What one robot goes through where its policy decides (Algorithm 8, lines 3 to 12), and how its episode ends.

    And whether its policy made the last step of it.
    """
    robot = Simulator(
        COURSE.worlds([seed], episode, episode + 1),
        COURSE.speed,
        max_steps=COURSE.max_steps,
    )
    uniforms = make_rng(seed, EXPLORING, episode).random(COURSE.max_steps)
    fraction, happened = episode / (EPISODES - 1), []
    temperature = 0.9 * (0.1 / 0.9) ** fraction
    while OUTCOMES[robot.outcome[0]] == "running":
        before = robot.sense()
        command, x = REFLEX(before, COURSE.speed), COURSE.encoder(before)[0]
        asked = command[0] < 0
        if asked:
            weights = np.exp(network.forward(x) / temperature)
            reached = np.cumsum(weights / weights.sum())
            command = np.searchsorted(reached, uniforms[robot.steps], side="right")
        robot.step(command)
        if asked:
            after, ended = (
                robot.sense(),
                OUTCOMES[robot.outcome[0]] in ("arrived", "collided"),
            )
            earned = reward(before, after, robot.outcome)[0]
            happened.append(
                (x, command[0], earned, COURSE.encoder(after)[0], ended, fraction)
            )
    return happened, str(OUTCOMES[robot.outcome[0]]), asked


def test_the_loop_is_a_plain_one_for_each_robot():
    networks = stacked([random_network((16, 8, 5), seed=seed) for seed in SEEDS])
    agent, statistics = (
        Watching(BatchedNetworks(networks)),
        EpisodeStatistics(len(SEEDS), EPISODES),
    )
    Trainer(
        agent, COURSE, SEEDS, EPISODES, (0.9, 0.1), statistics, first=0, last=EPISODES
    ).run()
    ends, cut = set(), 0
    for row, seed in enumerate(SEEDS):
        episodes = [
            plain_episode(networks[row], seed, episode) for episode in range(EPISODES)
        ]
        happened = [step for steps, _, _ in episodes for step in steps]
        for ours, theirs in zip(
            zip(*agent.seen[row], strict=True),
            zip(*happened, strict=True),
            strict=True,
        ):
            np.testing.assert_allclose(np.array(ours), np.array(theirs), rtol=1e-12)
        assert OUTCOMES[statistics.outcomes[row]].tolist() == [
            end for _, end, _ in episodes
        ]
        assert statistics.decisions[row].tolist() == [
            len(steps) for steps, _, _ in episodes
        ]
        np.testing.assert_allclose(
            statistics.returns[row],
            [sum(step[2] for step in steps) for steps, _, _ in episodes],
        )
        ends |= {end for _, end, _ in episodes}
        cut += sum(end == "out of steps" and asked for _, end, asked in episodes)
    assert ends == {"arrived", "collided", "out of steps"}
    assert cut  # a policy's step that time cut short, and no end of what can be earned


def test_the_course_is_that_of_section_4_5():
    task = NavigationTask()
    assert (task.obstacles, task.moving, task.speed, task.max_steps) == (
        10,
        0,
        2.5,
        400,
    )
    assert set(task.starts) == {(10, 10), (90, 10)}
    assert set(task.targets) == {(90, 90), (10, 90)}
    assert task.encoder.size == 16
    assert task.reward is reward
