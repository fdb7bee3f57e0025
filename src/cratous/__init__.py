"""CRATOUS: verified mission autonomy for teams of unmanned aircraft."""

__version__ = "0.2.0"
