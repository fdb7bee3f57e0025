"""UxAS as one process of ours: configuration, service manager, services, bridges, the loop."""
