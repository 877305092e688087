"""What happens one after the other when a robot senses, plans or learns, for the drill that puts parts in order."""

from __future__ import annotations

from ..runs import Line

OF_A_STEP = (
    Line("The sensors report what is around the robot", ""),
    Line(
        "Each reading becomes a degree of danger",
        "A degree of danger says how near a reading is, so the sensors come first.",
    ),
    Line(
        "The degrees of danger and the target's sector are joined to a state",
        "The state is put together from the degrees of danger of what was sensed.",
    ),
    Line(
        "The network gives a number for each action",
        "The network reads the whole state, which comes from the sensors.",
    ),
    Line(
        "The policy chooses an action",
        "The policy chooses by the network's numbers for the state that was sensed.",
    ),
    Line(
        "The robot turns and goes one step",
        "The robot moves as the policy has chosen for what it sensed.",
    ),
    Line(
        "It is checked whether the robot has arrived or collided",
        "Whether it has arrived or collided is known only after the move.",
    ),
)
OF_IMITATION = (
    Line("Maps are drawn for the demonstrations", ""),
    Line(
        "An expert drives through the maps",
        "There must be maps before somebody can drive in them.",
    ),
    Line(
        "The recorded steps in which the reflex acted are left out",
        "Steps can be left out only after an expert's demonstrations were recorded.",
    ),
    Line(
        "The pairs of state and action that are left become the rows of two matrices",
        "The rows are those pairs of the expert's demonstrations in which the expert decided.",
    ),
    Line(
        "A network is trained to give the action of each row",
        "A network is trained on the expert's pairs, so these come first.",
    ),
    Line(
        "The network drives in maps that no demonstration has shown",
        "Only a network that was trained on the expert's pairs can drive.",
    ),
    Line(
        "The share of these maps in which it has arrived is given with its interval",
        "How often it arrives is counted after it has driven.",
    ),
)
OF_TRIALS = (
    Line("The robot senses its state", ""),
    Line(
        "The network gives the value of each action",
        "The values are those of the state, so the robot senses it first.",
    ),
    Line(
        "An action is drawn, more probably one with a high value",
        "The action is drawn by the values of the state.",
    ),
    Line(
        "The robot carries the action out",
        "An action is carried out after it was drawn for the state.",
    ),
    Line(
        "The robot gets a reward and senses what the action has led to",
        "A reward follows an action, so the action comes first.",
    ),
    Line(
        "The target is computed: the reward plus the discounted best value there",
        "The target needs the reward of the action.",
    ),
    Line(
        "The value of the action moves towards the target",
        "An update needs the reward of the action, so the step comes first.",
    ),
)
OF_AN_INFERRED_REWARD = (
    Line("An expert gives demonstrations", ""),
    Line(
        "The expert's feature expectations are computed",
        "They are computed from the expert's demonstrations.",
    ),
    Line(
        "A reward is found under which the expert is better than the robot's policy",
        "The reward is inferred from the expert's demonstrations, by their features.",
    ),
    Line(
        "The policy is trained with this reward",
        "The policy is trained with a reward that was inferred from the expert.",
    ),
    Line(
        "The new policy drives",
        "The policy is new only after it was trained with the inferred reward.",
    ),
    Line(
        "The new policy's feature expectations are computed",
        "They are computed from episodes that the new policy has driven.",
    ),
    Line(
        "The new policy is compared with the expert, to see whether another reward is needed",
        "Only a policy that was trained, and has driven, can be compared.",
    ),
)
OF_A_PLAN = (
    Line("A map with all obstacles is given", ""),
    Line(
        "All cells of the map that are too near to an obstacle are marked as blocked",
        "The map says where the obstacles are, so the map comes first.",
    ),
    Line(
        "A* searches a path through the cells that are free",
        "The search needs the map, and it must know which cells are blocked.",
    ),
    Line(
        "The path is turned into actions of the robot",
        "There must be a path through the map before it can become actions.",
    ),
    Line(
        "The robot carries out the first of the planned actions",
        "The robot drives only after its actions were planned on the map.",
    ),
    Line(
        "The robot senses that its wheels have slipped",
        "Wheels slip only when the robot moves, and it moves as planned.",
    ),
    Line(
        "The robot turns back towards the path",
        "The robot turns back because it senses, after a planned action, that it has left the path.",
    ),
)
OF_A_BELIEF = (
    Line("The robot is switched on, and all places are equally probable", ""),
    Line(
        "The sensor reports a door",
        "A sensor reports something only after the robot was switched on.",
    ),
    Line(
        "Each place's probability is multiplied by that of seeing a door there",
        "The factors are those of the report, so the first probabilities and the report come before.",
    ),
    Line(
        "The products are divided by their sum",
        "There must be a report, and products of probabilities, before anything can be divided.",
    ),
    Line(
        "The robot drives to the next place on its right",
        "The robot updates its belief by the report before it moves.",
    ),
    Line(
        "The probability of each place moves to its right neighbour",
        "The probabilities move with the robot, so it drives first.",
    ),
    Line(
        "The sensor reports that there is no door",
        "This is the report of the new place, for which the robot has to move and its belief with it.",
    ),
)
OF_A_COMPARISON = (
    Line("Maps for tuning and other maps for the test are drawn", ""),
    Line(
        "Each method is tried with twenty settings in the maps for tuning",
        "Trials need maps, so these are drawn first.",
    ),
    Line(
        "The best of its settings is chosen for each method",
        "Settings are chosen by how they did in the trials.",
    ),
    Line(
        "Each method is trained with its chosen settings from ten seeds",
        "The final training uses the settings that were found in the trials.",
    ),
    Line(
        "All trained robots drive in the maps of the test",
        "The test is for robots that were trained with chosen settings.",
    ),
    Line(
        "The mean success of each method is computed, with its interval",
        "A success rate is computed from the episodes of trained robots.",
    ),
    Line(
        "The intervals of the two methods are compared",
        "The intervals come from the success rates of the test.",
    ),
)
OF_A_KNOWN_MODEL = (
    Line("The states and the actions are listed", ""),
    Line(
        "Each action's probabilities and reward are written down for each state",
        "Probabilities and rewards belong to states and actions, so these are listed first.",
    ),
    Line(
        "It is checked that all rows of probabilities sum to 1",
        "The rows can be checked when the probabilities are written down.",
    ),
    Line(
        "A first sweep computes a value of each state from zeros",
        "A sweep needs a model that is complete and without faults.",
    ),
    Line(
        "Sweeps are repeated until no value changes much",
        "Sweeps are repeated after a first one, with the same model.",
    ),
    Line(
        "The greedy action of each state is found from the values",
        "The values must be nearly right before actions are chosen by them.",
    ),
    Line(
        "The robot drives by the greedy policy",
        "The robot has no policy before the values of the model are known.",
    ),
)

PROCESSES = {
    "a robot's step": OF_A_STEP,
    "learning from demonstration": OF_IMITATION,
    "reinforcement learning": OF_TRIALS,
    "inverse reinforcement learning": OF_AN_INFERRED_REWARD,
    "driving by a plan": OF_A_PLAN,
    "localisation by a belief": OF_A_BELIEF,
    "a fair comparison of two methods": OF_A_COMPARISON,
    "planning with a known model": OF_A_KNOWN_MODEL,
}
"""What happens in each process, line by line, by its name."""
