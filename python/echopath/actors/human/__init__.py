"""A walking person: proportions, walking model, gait on planted feet, body surfaces."""
