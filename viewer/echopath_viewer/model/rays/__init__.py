"""Which rays are shown, and their places."""
