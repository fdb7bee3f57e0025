"""`cratous version`."""

from __future__ import annotations

import json

import click


@click.command()
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def version(as_json: bool) -> None:
    """Print the version of CRATOUS and of Python.

    Example:  cratous version --json
    """
    import platform

    from cratous import __version__

    found = {"cratous": __version__, "python": platform.python_version()}
    if as_json:
        click.echo(json.dumps(found))
    else:
        click.echo(f"cratous {found['cratous']} (Python {found['python']})")
