"""Four-bar by pairs of angles of its input and output links, or by a function that it generates."""
