"""Numbers without end in texts."""

from __future__ import annotations

import pytest

from cratous.spec.errors import BadInput

DIGITS = "9" * 5000


def test_numbers_without_end_in_texts_of_configurations_and_peers() -> None:
    from lxml import etree

    from cratous.bridge import lmcp
    from cratous.services.loading.assignment_attributes import _whole
    from cratous.services.logs import message_logger, uxas_log
    from cratous.services.logs.replay import parse_address

    with pytest.raises(BadInput, match="not an address"):
        parse_address(f"tcp://host:{DIGITS}")
    with pytest.raises(BadInput, match="not an address"):
        parse_address("tcp://host:²")
    with pytest.raises(BadInput, match="NumberNodesMaximum"):
        _whole({"NumberNodesMaximum": DIGITS}, "NumberNodesMaximum", "cfg.xml:1")
    with pytest.raises(BadInput, match="wrong attribute"):
        message_logger._whole(etree.Element("a", N=DIGITS), "N", "cfg.xml:1")
    with pytest.raises(BadInput, match="int64"):
        lmcp.xml.loads(
            f"<AutomationRequest><OperatingRegion>{DIGITS}</OperatingRegion></AutomationRequest>"
        )
    assert uxas_log._number(DIGITS) == uxas_log._number("9" * 30) == 0
    assert uxas_log._number("-7") == -7
