"""The law of motion: what drives the machine, the flywheel, balancing."""
