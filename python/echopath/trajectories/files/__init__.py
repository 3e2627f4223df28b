"""Files of trajectories: tables, floating car data of SUMO, GPX."""
