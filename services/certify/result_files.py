"""The files of a results folder, compared with the report to which they should belong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import write_atomically
from cratous.services.certify.differences import text_difference
from cratous.services.certify.report import pages, report_text
from cratous.services.results.names import (
    CERTIFICATE_NAME,
    COMMANDED_NAME,
    MANIFEST_NAME,
    NAMES,
    OF_PROCESSES,
    REPORT_NAME,
)
from cratous.services.results.ownership import digest_of, is_plain, manifest_text, read_manifest

SINCE_MANIFESTS = "environment"
"""Meta entry of all logs written since manifests exist: beside such a log a missing manifest was removed."""


def no_result(name: str) -> str:
    """The message about an entry of the folder that no run wrote."""
    return f"{name}: no file of the results"


class Files:
    """The files in the folder beside the log.

    wrong: faults that cannot be repaired; differing: files that can be regenerated from the report;
    unchecked: other entries; commanded: the results contain the mission with the operator's
    commands.
    """

    def __init__(
        self, folder: Path, report: dict[str, Any], meta: dict[str, Any], *, same: bool
    ) -> None:
        """meta: of the log; same: report.json agrees with the log, so its bytes are compared too."""
        self._folder = folder
        self.wrong: list[str] = []
        self.differing: list[str] = []
        self._anew: dict[str, str] = {}
        self._names = [name for name in NAMES if name != MANIFEST_NAME]
        if not report["plan"]["certificate"]:
            self._names.remove(CERTIFICATE_NAME)
        stated = read_manifest(folder) or {}
        self.commanded = COMMANDED_NAME in stated
        if self.commanded:
            self._names.append(COMMANDED_NAME)
        if "processes" in meta:
            # compared with the manifest alone: they cannot be derived from the log
            self._names += sorted(name for name in stated if OF_PROCESSES.fullmatch(name))
        self.unchecked = [
            no_result(entry.name)
            for entry in sorted(folder.iterdir())
            if entry.name not in self._names and entry.name != MANIFEST_NAME
        ]
        self._pages = pages(report)
        if same:
            self._pages[REPORT_NAME] = report_text(report)
        for name, text in self._pages.items():
            self._hold(name, text)
        self._hold_manifest(required=SINCE_MANIFESTS in meta)

    def rewrite(self) -> list[str]:
        """Regenerate the files that differ; returns their names."""
        for name, text in self._anew.items():
            write_atomically(self._folder / name, text)
        write_atomically(self._folder / MANIFEST_NAME, self._manifest())
        return [*self._anew, MANIFEST_NAME]

    def _hold(self, name: str, expected: str) -> None:
        path = self._folder / name
        if path.exists() and not is_plain(path):
            self.wrong.append(f"{name}: not a file")
            return
        if not path.exists():
            self.differing.append(f"{name}: it is missing")
        else:
            text = expected.encode("utf-8")
            with path.open("rb") as stream:
                found = stream.read(len(text) + 1)
            if found == text:
                return
            self.differing.append(text_difference(name, found, expected))
        self._anew[name] = expected

    def _hold_manifest(self, *, required: bool) -> None:
        stated = read_manifest(self._folder)
        if stated is None:
            if (self._folder / MANIFEST_NAME).exists():
                self.differing.append(f"{MANIFEST_NAME}: not the manifest of a run")
            elif required:
                self.differing.append(f"{MANIFEST_NAME}: it is missing")
            else:
                self.unchecked.append(f"{MANIFEST_NAME}: an earlier version wrote none")
            return
        for name in sorted({*stated, *self._names}):
            found = digest_of(self._folder / name)
            if name not in self._names:
                self.differing.append(f"{MANIFEST_NAME}: {name} is no file of the results")
            elif stated.get(name, "") == found or name in self._anew:
                continue
            elif name in self._pages:  # the file itself is right, so the manifest is wrong
                self.differing.append(f"{MANIFEST_NAME}: another SHA-256 of {name}")
            else:
                was = stated.get(name, "none")
                self.wrong.append(f"{name}: SHA-256 in {MANIFEST_NAME} {was}, of the file {found}")
        if not self.wrong and not self.differing:
            text, found_text = self._manifest(), (self._folder / MANIFEST_NAME).read_bytes()
            if found_text != text.encode():
                self.differing.append(text_difference(MANIFEST_NAME, found_text, text))

    def _manifest(self) -> str:
        there = [name for name in self._names if (self._folder / name).exists()]
        return manifest_text(self._folder, there)
