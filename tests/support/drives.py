"""Trajectories that tests of actors follow."""
import math

import echopath as ep

WALK = ep.Trajectory([(0, 0), (4, 0), (4, 4)], turn_radius=1.5, speed=1.4, stops=[(0, 0.4), (5, 0.7), (math.inf, 0)],
                     acceleration=1.0, deceleration=1.0)
