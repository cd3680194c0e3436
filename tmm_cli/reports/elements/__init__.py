"""Presentation of load elements (such as springs): table, warnings, formula for the note and drawing symbol.

There is a module for each kind of element. It has the name of the block in the problem file.
"""
