"""Scenes that are changed while they are watched."""
