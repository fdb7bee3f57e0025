"""HTTP server for pages and data: uvicorn at a local address, with limits on client resources."""
