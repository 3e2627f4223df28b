"""Trajectories of whatever moves, lanes that they follow, and what files tell of them."""
from .lane import Lane
from .files.read import read_trajectories
from .trajectory import Trajectory
