"""Persons: proportions and body surfaces, walking and running on planted feet, standing, motion captures."""
