"""The current results of a watch as Prometheus text, which `metrics_server` serves."""

from __future__ import annotations

from cratous.services.requirements.watch import Watch

COUNTS = ("holds", "violated", "unknown")


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
