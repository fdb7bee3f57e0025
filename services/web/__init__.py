"""Pages and data over HTTP: uvicorn at an address of this machine, with limits to what clients may hold."""
