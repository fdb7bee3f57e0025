"""What a watch has found so far, as Prometheus reads it: text, served on this machine alone."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from cratous.services.requirements.watch import Watch
from cratous.spec.errors import BadInput

COUNTS = ("holds", "violated", "unknown")
KIND = "text/plain; version=0.0.4; charset=utf-8"


def text_of(watch: Watch, messages: int) -> str:
    """The counts in Prometheus's text format 0.0.4."""
    lines = [
        "# HELP cratous_messages_total Messages that came.",
        "# TYPE cratous_messages_total counter",
        f"cratous_messages_total {messages}",
        "# HELP cratous_samples_total Verdicts of a requirement on samples.",
        "# TYPE cratous_samples_total counter",
    ]
    for one in watch.outcomes:
        name = _quoted(one.name)
        lines += [
            f'cratous_samples_total{{requirement="{name}",verdict="{word}"}} {getattr(one, word)}'
            for word in COUNTS
        ]
    lines += [
        "# HELP cratous_violated Whether a requirement is violated at some sample.",
        "# TYPE cratous_violated gauge",
        *(
            f'cratous_violated{{requirement="{_quoted(one.name)}",severity="{_quoted(one.requirement.severity)}"}} '
            f"{int(one.violated > 0)}"
            for one in watch.outcomes
        ),
        "# HELP cratous_unauthenticated Whether a requirement was held against what nothing authenticates.",
        "# TYPE cratous_unauthenticated gauge",
        *(
            f'cratous_unauthenticated{{requirement="{_quoted(one.name)}"}} {int(watch.is_unauthenticated(one))}'
            for one in watch.outcomes
        ),
        "# HELP cratous_findings_total What was wrong with the samples.",
        "# TYPE cratous_findings_total counter",
        *(
            f'cratous_findings_total{{kind="{found.kind}",signal="{_quoted(found.signal)}"}} {found.count}'
            for found in watch.sampling.findings
        ),
    ]
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


@contextmanager
def served(port: int, text: Callable[[], str]) -> Iterator[int]:
    """Serve the text at http://127.0.0.1:PORT/metrics in here; gives the port (0 takes a free one)."""

    class Handler(BaseHTTPRequestHandler):
        timeout = 5.0  # a reader that says nothing holds its thread no longer

        def do_GET(self) -> None:
            body = text().encode() if self.path == "/metrics" else b"look at /metrics\n"
            self.send_response(200 if self.path == "/metrics" else 404)
            self.send_header("Content-Type", KIND)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Requests are not logged."""

    try:
        server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
    except OSError as error:
        raise BadInput(
            "cannot listen", where=f"127.0.0.1:{port}", item="--metrics",
            expected="a free port of this machine", got=error.strerror or str(error),
        ) from None  # fmt: skip
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
