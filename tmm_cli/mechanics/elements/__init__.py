"""Load elements, such as springs: each acts between two links by a law of its own.

There is a module for each kind of element.
"""
