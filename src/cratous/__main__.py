"""`python -m cratous` is the command `cratous`."""

from cratous.services.cli import program
from cratous.services.processes.leash import end_with_parent

if __name__ == "__main__":
    end_with_parent()
    program()
