"""What many modules ask of a radar: its antennas, its chirps, the velocities that it takes for each other."""
