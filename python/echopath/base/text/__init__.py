"""Words: counts, names, and the colours that stand for names."""
