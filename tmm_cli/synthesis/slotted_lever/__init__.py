"""Slotted lever by k (or its swing) and the extreme positions of its end."""
