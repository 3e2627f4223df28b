"""What a caller may pass: checks of arguments, the settings of a simulation, and the words of what is refused."""
