"""From signals to maps: range, velocity and angle."""
