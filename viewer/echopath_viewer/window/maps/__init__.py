"""Maps of the signal and what makes their cells."""
