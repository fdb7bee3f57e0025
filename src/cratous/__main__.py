"""`python -m cratous` is the command `cratous`."""

from cratous.services.cli import main
from cratous.services.processes.leash import end_with_parent

if __name__ == "__main__":
    end_with_parent()
    raise SystemExit(main())
