"""Parameters of ICAROUS and detect and avoid for a mission, and the original's parameter files."""
