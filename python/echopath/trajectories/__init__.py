"""Trajectories of whatever moves, lanes that they follow, and what files tell of them."""
from .files.read import read_trajectories
from .lane import Lane
from .trajectory import Trajectory
