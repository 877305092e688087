"""DAgger and nearest neighbours."""

import numpy as np
import pytest

from robonav.lfd import (
    ComputerExpert,
    NeighbourPolicy,
    collect_with_expert_labels,
    concatenate,
    dagger,
    demonstrate,
    learn_neighbours,
    learn_policy,
    record_demonstrations,
)
from robonav.lfd.dagger import round_seeds
from robonav.networks import NetworkPolicy
from robonav.robot import (
    REFLEX,
    Encoder,
    Simulator,
    make_world,
    navigate,
    random_worlds,
    straight,
)


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(10, 20, seed=70))


@pytest.fixture(scope="module")
def gone_straight():
    return collect_with_expert_labels(straight, random_worlds(6, 20, seed=71))


def test_the_policy_acts_and_the_expert_labels(gone_straight):
    rollout = navigate(straight, gone_straight.worlds, record_paths=True)
    assert gone_straight.outcome.tolist() == rollout.outcome.tolist()
    assert np.array_equal(
        gone_straight.poses, np.concatenate([path[:-1] for path in rollout.paths])
    )
    assert (gone_straight.effective.actions != 0).any()


def test_label_is_the_first_action_of_a_plan_from_there(gone_straight):
    asked = np.flatnonzero(REFLEX(gone_straight.sensing, 2.0) < 0)
    rng = np.random.default_rng(1)
    for row in rng.choice(asked, 12, replace=False):
        world = gone_straight.worlds[int(gone_straight.trajectory[row])]

        class Here:
            worlds, poses, centres, speed = (
                world,
                gone_straight.poses[row][None],
                world.centres,
                2.0,
            )

        own = ComputerExpert()(Here, np.array([0]))[0]
        followed = (
            row - 1 >= 0
            and gone_straight.trajectory[row - 1] == gone_straight.trajectory[row]
        )
        assert gone_straight.actions[row] == own or (
            followed and gone_straight.actions[row - 1] == 0
        )


def test_joined_sets(demonstrations, gone_straight):
    both = concatenate([demonstrations, gone_straight])
    assert len(both) == len(demonstrations) + len(gone_straight)
    assert both.lengths.tolist() == [*demonstrations.lengths, *gone_straight.lengths]
    back = both.select_trajectories(
        np.arange(len(demonstrations.worlds), len(both.worlds))
    )
    assert np.array_equal(back.poses, gone_straight.poses)
    assert np.array_equal(back.sensing.walls, gone_straight.sensing.walls)
    assert back.worlds.digest() == gone_straight.worlds.digest()
    for sets in (
        [],
        [demonstrations, demonstrate(random_worlds(1, 0, seed=1), speed=1.0)],
    ):
        with pytest.raises(ValueError, match="sets must hold at least one set"):
            concatenate(sets)


@pytest.mark.slow
def test_a_round_of_dagger_beats_cloning_little(demonstrations):
    few = demonstrations.select_trajectories(range(3))
    unseen = random_worlds(300, 20, seed=73)
    gathered = dagger(few, [random_worlds(15, 20, seed=74)], seed=1, iterations=100)
    cloned, mended = (
        navigate(policy, unseen).success.mean() for policy in gathered.policies
    )
    assert mended > cloned + 0.05
    assert mended > 0.9
    assert gathered.policy is gathered.policies[-1]
    assert len(gathered.demonstrations[1]) > len(gathered.demonstrations[0]) == len(few)


@pytest.mark.slow
def test_each_round_adds_labelled_states_to_all_data_before(demonstrations):
    begin = demonstrate(random_worlds(3, 20, seed=79), speed=1.5)
    rounds = [random_worlds(3, 20, seed=80), random_worlds(2, 20, seed=81)]
    seeds = [[2, 3], [4, 5], [6, 7]]
    made = dagger(begin, rounds, seed=seeds, iterations=20, temperature=0.3)
    assert [policy.temperature for policy in made.policies] == [0.3] * 3
    gathered = begin
    for number, worlds in enumerate(rounds):
        met = collect_with_expert_labels(
            made.policies[number], worlds, speed=1.5, seed=seeds[number + 1][1]
        )
        gathered = concatenate([gathered, met])
        assert np.array_equal(made.demonstrations[number + 1].poses, gathered.poses)
        assert np.array_equal(made.demonstrations[number + 1].actions, gathered.actions)
        learned = learn_policy(gathered, seed=seeds[number + 1][0], iterations=20)
        assert np.array_equal(
            made.policies[number + 1].network.weights[0], learned.network.weights[0]
        )


def test_dagger_asks_the_expert_it_is_given(demonstrations):
    def always_left(simulator, asked):
        return np.full(len(asked), 2)

    made = dagger(
        demonstrations,
        [random_worlds(3, 20, seed=82)],
        expert=always_left,
        iterations=20,
    )
    added = made.demonstrations[1].select_trajectories(
        np.arange(len(demonstrations.worlds), len(demonstrations.worlds) + 3)
    )
    assert set(added.effective.actions) == {2}


def test_an_episode_that_is_stopped_early_gives_no_more_labels(demonstrations):
    worlds = random_worlds(3, 20, seed=83)
    whole, cut = (
        collect_with_expert_labels(straight, worlds),
        collect_with_expert_labels(straight, worlds, max_steps=7),
    )
    assert (cut.lengths <= 7).all()
    assert set(cut.outcome[whole.lengths > 7]) == {"out of steps"}
    first = np.concatenate(
        [np.flatnonzero(whole.trajectory == number)[:7] for number in range(3)]
    )
    assert np.array_equal(cut.actions, whole.actions[first])
    made = dagger(demonstrations, [worlds], iterations=10, max_steps=7)
    assert made.demonstrations[1].lengths[len(demonstrations.worlds) :].max() <= 7


@pytest.mark.slow
def test_mixture_of_expert_and_learner():
    """With beta = 1 the expert acts alone, with 0 the learner, between them both; the labels are the expert's."""
    worlds = random_worlds(20, 20, seed=84)
    alone = demonstrate(worlds)
    by_expert = collect_with_expert_labels(straight, worlds, beta=1.0)
    assert np.array_equal(by_expert.poses, alone.poses)
    assert np.array_equal(by_expert.actions, alone.actions)
    arrived = [
        (
            collect_with_expert_labels(straight, worlds, beta=b).outcome == "arrived"
        ).sum()
        for b in (0.0, 0.5, 1.0)
    ]
    assert arrived[0] < arrived[1] <= arrived[2] == 20
    with pytest.raises(ValueError, match="beta must be at least 0 and at most 1"):
        collect_with_expert_labels(straight, worlds, beta=1.5)


def test_beta_schedule_of_dagger(demonstrations):
    worlds = [random_worlds(3, 20, seed=85)] * 2
    made = dagger(demonstrations, worlds, beta_decay=1.0, iterations=10)
    expert = demonstrate(worlds[0])
    gathered = concatenate([demonstrations, expert, expert])
    assert np.array_equal(made.demonstrations[2].poses, gathered.poses)
    assert np.array_equal(made.demonstrations[2].actions, gathered.actions)
    with pytest.raises(ValueError, match="beta_decay must be at least 0"):
        dagger(demonstrations, worlds, beta_decay=-0.5)


def test_seeds_of_the_rounds_of_dagger():
    """Every round draws its weights and its episodes from seeds of their own."""
    seeds = np.array(round_seeds(3, 4))
    assert len(np.unique(seeds)) == seeds.size == 10
    assert round_seeds(3, 4) == list(map(tuple, seeds.tolist())) != round_seeds(4, 4)
    with pytest.raises(ValueError, match="seed must have shape"):
        round_seeds([1, 2], 4)
    with pytest.raises(ValueError, match="seed must hold numbers from 0 on, got -1"):
        round_seeds([[1, -1]], 0)


def test_expert_that_serves_two_worlds():
    """A plan made in one world is not followed in another that starts in the same pose."""
    empty = make_world(start=(10, 10), target=(40, 10), size=50)
    blocked = make_world(
        circles=[(20, 10, 4)], start=(10, 10), target=(40, 10), size=50
    )
    expert, robot = ComputerExpert(), np.array([0])
    expert.plan_from(Simulator(empty), 0)
    for world in (empty, blocked):
        simulator = Simulator(world)
        expert(simulator, robot)
        fresh = ComputerExpert().plan_from(Simulator(world), 0)
        assert np.array_equal(expert._plans[0].actions, fresh.actions)


def test_dagger_is_reproducible(demonstrations):
    rounds = [random_worlds(4, 10, seed=75)]
    one, same = (
        dagger(demonstrations, rounds, seed=3, iterations=30) for _ in range(2)
    )
    assert np.array_equal(one.policy.network.weights[0], same.policy.network.weights[0])
    assert np.array_equal(one.demonstrations[1].actions, same.demonstrations[1].actions)


def test_round_zero_is_the_clone(demonstrations):
    clone = learn_policy(demonstrations, seed=4, iterations=30)
    begun = dagger(demonstrations, [], seed=[[4, 0]], iterations=30, temperature=0.0)
    assert np.array_equal(begun.policy.network.weights[1], clone.network.weights[1])


def test_temperature(demonstrations):
    policy = learn_policy(demonstrations, iterations=50)
    sensing = demonstrations.effective.sensing[:20]
    z = policy.logits(sensing)
    warm = NetworkPolicy(policy.network, policy.encoder, temperature=0.7)
    rng = np.random.default_rng(5)
    drawn = np.stack([warm(sensing, rng) for _ in range(4000)])
    probabilities = np.exp((z - z.max(axis=1, keepdims=True)) / 0.7)
    probabilities /= probabilities.sum(axis=1, keepdims=True)
    counted = (drawn[:, :, None] == np.arange(5)).mean(axis=0)
    assert np.abs(counted - probabilities).max() < 0.04
    with pytest.raises(ValueError, match="temperature must be at least 0"):
        NetworkPolicy(policy.network, policy.encoder, temperature=-1)


def test_the_nearest_neighbour_knows_its_own_examples(demonstrations):
    one = learn_neighbours(demonstrations, k=1, encoder=Encoder(target="one-hot"))
    pairs = demonstrations.effective
    x = one.encoder(pairs.sensing)
    answers = one(pairs.sensing, np.random.default_rng(0))
    alone = (x[:, None] == x).all(axis=2).sum(axis=1) == 1
    assert alone.sum() > 20
    assert np.array_equal(answers[alone], pairs.actions[alone])


@pytest.mark.parametrize("k", [1, 3, 6])
def test_neighbours_vote(demonstrations, k):
    policy = learn_neighbours(demonstrations, k=k)
    other = demonstrate(random_worlds(2, 20, seed=77)).effective.sensing
    x = policy.encoder(other)
    distance = np.linalg.norm(x[:, None] - policy.states, axis=2)
    for row, answer in enumerate(policy(other, np.random.default_rng(0))):
        nearest = distance[row].argsort(kind="stable")
        if distance[row][nearest[k - 1]] == pytest.approx(
            distance[row][nearest[k]], abs=1e-12
        ):
            continue  # a tie about who is among the k
        votes = np.bincount(policy.actions[nearest[:k]], minlength=5)
        assert votes[answer] == votes.max()


def test_of_equal_votes_the_nearer_neighbour_has_the_last(demonstrations):
    sensing = demonstrations.effective.sensing[:1]
    x = learn_neighbours(demonstrations).encoder(sensing)
    for nearer in (1, 3):
        states = np.concatenate([x + 0.01, x + 0.02])
        policy = NeighbourPolicy(states, np.array([nearer, 4 - nearer]), Encoder(), k=2)
        assert policy(sensing, np.random.default_rng(0)).tolist() == [nearer]


def test_neighbours_beat_going_straight(demonstrations):
    unseen = random_worlds(200, 20, seed=78)
    assert (
        navigate(learn_neighbours(demonstrations), unseen).success.mean()
        > navigate(straight, unseen).success.mean() + 0.2
    )


def test_too_many_neighbours(demonstrations):
    with pytest.raises(ValueError, match="k must be at most"):
        learn_neighbours(demonstrations, k=10**6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"expert": 3},
            r"expert must be callable as expert\(simulator, robots\), got int",
        ),
        ({"rounds": 3}, "rounds must be Sequence, got int"),
        ({"rounds": ["x"]}, r"rounds\[0\] must be Worlds, got str"),
        ({"temperature": "x"}, "temperature must be a number"),
        ({"max_steps": 1.5}, "max_steps must be a whole number"),
        ({"encoder": "x"}, "encoder must be Encoder, got str"),
    ],
)
def test_wrong_arguments_of_dagger_get_a_sentence(demonstrations, options, message):
    with pytest.raises(TypeError, match=message):
        dagger(demonstrations, **{"rounds": [], **options})


def test_what_cannot_be_called_is_refused():
    worlds = random_worlds(1, 5, seed=1)
    with pytest.raises(TypeError, match="expert must be callable"):
        record_demonstrations(3, worlds)
    with pytest.raises(TypeError, match="policy must be callable"):
        collect_with_expert_labels(3, worlds)
