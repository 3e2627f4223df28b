"""Numerics: decibels, rotations, rates of change, analytic signals."""
