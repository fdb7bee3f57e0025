"""The ground station: a run or a message log in the browser, served on this machine alone."""
