"""What the chapter on kinematics writes: the driver, plans of velocities and accelerations, tables of all positions."""
