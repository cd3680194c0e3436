"""Chapter on the law of motion of a machine: reduced moments, flywheel, velocity and acceleration of the input link."""
