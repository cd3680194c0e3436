"""How many digits are to be trusted, and the rival methods that the bench compares."""
