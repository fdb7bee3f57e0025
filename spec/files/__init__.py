"""Reading external input: size bounds, text, and text made safe for display."""
