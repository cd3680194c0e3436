"""A mechanism over its parameters: what comes of many variants, and where they cease to be mechanisms."""
