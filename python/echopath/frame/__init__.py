"""One simulated frame: its run from scene to labels, and what it holds."""
