"""JaxNav: 64 environments, one robot with nine beams each, random actions; steps a second after compiling."""

import time

import jax
from jaxmarl.environments.jaxnav.jaxnav_env import JaxNav

NUMBER, STEPS, ROUNDS = 64, 200, 8
env = JaxNav(
    num_agents=1,
    map_id="Grid-Rand-Poly",
    map_params={"map_size": (11, 11), "fill": 0.3},
    act_type="Discrete",
    lidar_num_beams=9,
)


def drive(key):
    key, start = jax.random.split(key)
    _, state = jax.vmap(env.reset)(jax.random.split(start, NUMBER))

    def step(carry, _):
        key, state = carry
        key, choose, act = jax.random.split(key, 3)
        actions = {"agent_0": jax.random.randint(choose, (NUMBER,), 0, 15)}
        seen, state, reward, _, _ = jax.vmap(env.step)(
            jax.random.split(act, NUMBER), state, actions
        )
        return (key, state), (reward["agent_0"].sum(), seen["agent_0"].sum())

    return jax.lax.scan(step, (key, state), None, length=STEPS)[1]


compiled = jax.jit(drive)
jax.block_until_ready(compiled(jax.random.PRNGKey(0)))
start = time.perf_counter()
for k in range(ROUNDS):
    jax.block_until_ready(compiled(jax.random.PRNGKey(k + 1)))
print(NUMBER * STEPS * ROUNDS / (time.perf_counter() - start))
