"""Records to rows, and rows to the terminal, CSV and JSON."""
