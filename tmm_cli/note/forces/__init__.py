"""Chapter on forces: loads on links, moment equations, force plans, Zhukovsky lever, tables."""
