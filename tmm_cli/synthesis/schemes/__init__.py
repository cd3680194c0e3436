"""Structural synthesis: kinematic chains, schemes of mechanisms from Assur groups, and problem files for them."""
