"""A mechanism that turns on a page: what the results say at places close together, and a script that moves it."""
