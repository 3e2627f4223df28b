"""From paths to IF signals, whole and of their parts, with noise and what other radars send."""
