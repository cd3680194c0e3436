"""Rival methods, measured against the product."""
