"""5.6 by comparing every step of the expert's with every step of the policy's."""


def accuracies(expert_actions, policy_actions, number):
    expert_actions, policy_actions = expert_actions.tolist(), policy_actions.tolist()
    agreed = sum(a == b for a, b in zip(expert_actions, policy_actions)) / len(
        expert_actions
    )
    strangers = (
        sum(a == b for a in expert_actions for b in policy_actions)
        / len(expert_actions) ** 2
    )
    return agreed, 0 if strangers == 1 else 1 - (1 - agreed) / (1 - strangers)
