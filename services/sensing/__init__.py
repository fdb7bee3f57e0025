"""A vehicle's sensors and the tracks made from them: ICAROUS's input in place of the true states."""
