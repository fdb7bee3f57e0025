"""Requirements over time, decided sample by sample."""
