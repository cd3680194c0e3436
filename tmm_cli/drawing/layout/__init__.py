"""Large sheets to hand in: drawings and tables packed into a frame with its title block."""
