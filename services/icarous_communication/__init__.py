"""IcarousCommunicationService: UxAS's end of the CRATOUS bridge, as a service of any configuration."""
