"""Reading what comes from outside: bounds, text, and text made safe to show."""
