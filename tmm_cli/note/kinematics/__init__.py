"""Chapter on kinematics: drivers, velocity and acceleration plans, tables of all positions."""
