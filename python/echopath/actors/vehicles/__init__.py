"""Road vehicles: bodies of smooth panels on turning wheels."""
