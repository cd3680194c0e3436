"""One file a command: parse, call, print. Heavy packages are imported inside, when their command runs."""
