"""IcarousCommunicationService: the UxAS end of the CRATOUS bridge, as a service for any configuration."""
