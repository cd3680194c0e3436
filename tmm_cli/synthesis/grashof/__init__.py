"""Which links of a four-bar, a crank-slider or a slotted lever turn fully."""
