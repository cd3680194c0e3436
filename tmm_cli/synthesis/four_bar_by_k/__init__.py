"""Four-bar by k and both extreme positions of its rocker; the crank's pivot A is chosen on its arcs."""
