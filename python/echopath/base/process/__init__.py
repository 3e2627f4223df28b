"""The running program: Ctrl-C, progress, threads, libraries loaded late, and the user's own code."""
