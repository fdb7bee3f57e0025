"""Files on disk: written whole or not at all, and what is kept from run to run."""
