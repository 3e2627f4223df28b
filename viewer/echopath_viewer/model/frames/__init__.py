"""Where a view comes from: frames, files, time lines, live scenes."""
