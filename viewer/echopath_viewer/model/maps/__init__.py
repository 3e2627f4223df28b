"""Signals, their parts and maps, and which paths and echoes make a cell."""
