"""`cratous warm`: compiles in advance what commands would otherwise compile when needed."""

from __future__ import annotations

import os
import time

import click

from cratous.services.cli.numbers import Number
from cratous.services.cli.progress import waiting


@click.command()
@click.option("--planning", is_flag=True, help="Only what planning uses.")
@click.option("--prune", is_flag=True, help="Then remove old machine code from the cache.")
@click.option(
    "--days", type=Number(0, 3650), default=7.0, show_default=True,
    help="Old is what nothing has used for so many days (with --prune).",
)  # fmt: skip
@click.option("--quiet", is_flag=True, help="No progress.")
def warm(planning: bool, prune: bool, days: float, quiet: bool) -> int:
    """Compile the kernels ahead, so that no command waits for the compiler.

    It takes a minute or two once; what is kept already takes seconds. The cache is in
    $CRATOUS_CACHE, else in the cache folder of the user.

    Example:  cratous warm --prune
    """
    from cratous.services.startup.prune import prune as pruned
    from cratous.services.startup.warm import CHAINS, PLANNING, compile_all

    chains, cores = (PLANNING,) if planning else CHAINS, os.cpu_count() or 1
    began = time.monotonic()
    with waiting("compiling", quiet) as wait:
        compile_all(chains, cores, lambda name: None if quiet else wait.line(f"compiled: {name}"))
    if not quiet:
        click.echo(f"what the runtime uses is compiled ({time.monotonic() - began:.0f} s)")
    if prune:
        count, freed = pruned(days)
        click.echo(f"{count} old parts of the cache removed, {freed / 1e6:.1f} MB")
    return 0
