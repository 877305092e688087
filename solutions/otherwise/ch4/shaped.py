"""4.2 step by step."""


def shaped(rewards, potentials, ended, discount):
    answer = []
    for t, reward in enumerate(rewards):
        last = ended and t == len(rewards) - 1
        answer.append(
            reward - potentials[t] + (0 if last else discount * potentials[t + 1])
        )
    return answer
