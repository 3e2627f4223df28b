"""Time within a frame, and frames in time."""
