"""What ICAROUS and detect-and-avoid are set to for a mission, and the parameter files of the original."""
