"""How many digits are to be trusted."""
