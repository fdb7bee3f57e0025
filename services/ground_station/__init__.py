"""The ground station: a flight, a run or a message log in the browser, served to this machine only by default."""
