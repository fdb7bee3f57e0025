"""UxAS as a single process: configuration, service manager, services, bridges and the main loop."""
