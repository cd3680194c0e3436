"""Velocity, acceleration and force plans and the lever, as named vectors with scale factors; nothing is drawn here."""
