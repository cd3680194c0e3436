"""Four-bar by k and both extreme positions of its rocker; the crank pivot A is chosen on its arcs."""
