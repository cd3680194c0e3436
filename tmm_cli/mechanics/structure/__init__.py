"""Who is joined to whom: mobility, Assur groups, names of links."""
