"""The ground station: a flight, a run or a message log in the browser, served on this machine alone."""
