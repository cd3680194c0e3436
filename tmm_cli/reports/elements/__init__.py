"""How load elements are shown: table row, warnings, formula, symbol. A module for each kind, named for its block."""
