"""What tasks fly and see: lanes over areas, footprints, coverage."""
