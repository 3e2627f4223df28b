"""What the window reads, writes, watches and remembers."""
