"""What every package stands on: files that are written whole, Ctrl-C, progress, threads, time and memory of stages."""
