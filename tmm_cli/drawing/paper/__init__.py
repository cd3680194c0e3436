"""What goes on paper: the record of a drawing, texts, labels, blocks, charts, dimension lines. Knows no mechanism."""
