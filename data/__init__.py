"""Scenes, materials, antennas and reference values that come with echopath."""
