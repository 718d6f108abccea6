#!/usr/bin/python3
"""A learning environment: a ball, pushed in the plane, has to knock a tower of bricks down.

    environment.py [--episodes N] [--seed S]

reset(seed) and step(action) return what Gymnasium's environments return, without depending on it.
Played here by a policy that pushes the ball towards the tower.
"""
import argparse

import numpy as np

import sunder

BRICK_M = np.array([0.4, 0.3, 0.4])


class Tower:
    """The environment. An action is a push (x, z), each from -1 to 1, for a tenth of a second."""

    layers = 5
    most_steps = 50
    push_Ns = 200.0

    def __init__(self):
        half = BRICK_M * [0.5, 0, 0.5]
        self.brick = sunder.Asset.from_boxes([(-half, BRICK_M - half)], "brick")

    def reset(self, seed=None):
        """Begins an episode. Returns an observation and a dict."""
        random = np.random.default_rng(seed)
        self.world = sunder.World(sunder.Scene(), threads=1, particles=False)
        self.bricks = [self.world.add_solid(self.brick, origin=(0, k * BRICK_M[1], 0))
                       for k in range(self.layers)]
        angle = random.uniform(0, 2 * np.pi)
        self.ball = self.world.add_ball((3 * np.cos(angle), 0.3, 3 * np.sin(angle)), radius_m=0.3,
                                        material="wood")
        self.steps = 0
        return self.observe(), {}

    def observe(self):
        """Returns the ball's position and velocity, and the top of the tower, in one array."""
        ball = self.world.body(self.ball)
        return np.concatenate([ball.position, ball.velocity, [self.top_m()]]).astype(np.float32)

    def top_m(self):
        """Returns the height of the highest body but the ball."""
        bodies = self.world.bodies
        others = bodies.positions[bodies.keys != self.ball]
        return float(others[:, 1].max()) if len(others) else 0.0

    def step(self, action):
        """Pushes. Returns observation, reward, terminated, truncated and a dict."""
        push = self.push_Ns * np.clip(action, -1, 1)
        before_m = self.top_m()
        self.world.apply_impulse(self.ball, (push[0], 0, push[1]))
        self.world.run(0.1)
        self.steps += 1
        reward = before_m - self.top_m() - 0.01
        is_down = self.top_m() < 1.5 * BRICK_M[1]
        return self.observe(), reward, is_down, self.steps >= self.most_steps, {}


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--episodes", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    environment = Tower()
    for episode in range(options.episodes):
        observation, _ = environment.reset(options.seed + episode)
        total, ended = 0.0, False
        while not ended:
            towards = -observation[[0, 2]]
            action = towards / max(np.linalg.norm(towards), 1e-6)
            observation, reward, terminated, truncated, _ = environment.step(action)
            total += reward
            ended = terminated or truncated
        print(f"episode {episode}: {environment.steps} steps, reward {total:.2f}, "
              f"{'down' if terminated else 'standing'}")


if __name__ == "__main__":
    main()
