"""The sheets, one a file; `draw/__init__.py` lists those of a run."""
