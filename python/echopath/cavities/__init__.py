"""Hollows in metal whose inside is computed by waves in place of rays."""
