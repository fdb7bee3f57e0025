"""`python -m cratous` is the command `cratous`."""

from cratous.services.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
