"""What the sensors of a vehicle see, and the tracks that are made of it: what its ICAROUS is given for the truth."""
