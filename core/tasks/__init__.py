"""What tasks fly and observe: lanes over areas, footprints, coverage."""
