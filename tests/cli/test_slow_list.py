"""The list of slow tests names what there is, and is made as it says."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
import slow_tests

JUNIT = """<testsuites><testsuite>
<testcase classname="tests.a.test_one" name="test_slow[1]" time="0.5"/>
<testcase classname="tests.a.test_one" name="test_slow[2]" time="0.1"/>
<testcase classname="tests.a.test_one" name="test_quick" time="0.01"/>
<testcase classname="tests.a.test_one" name="test_quicker" time="0.01"/>
<testcase classname="tests.a.test_one" name="test_quickest" time="0.001"/>
{many}
<testcase classname="tests.b.test_two" name="test_this" time="0.3"/>
<testcase classname="tests.b.test_two" name="test_that" time="0.3"/>
<testcase classname="tests.b.test_two" name="test_rest" time="0.001"/>
</testsuite></testsuites>"""
MANY = '<testcase classname="tests.a.test_one" name="test_many[{}]" time="0.04"/>'


def test_it_names_what_there_is(root: Path) -> None:
    lines = slow_tests.LIST.read_text(encoding="utf-8").splitlines()
    assert lines == sorted(set(lines))
    assert len(lines) > 100
    for line in lines:
        file, _, function = line.partition("::")
        tree = ast.parse((root / file).read_text(encoding="utf-8"))
        names = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        assert not function or function in names, line


def test_slow_is_what_takes_long_alone_or_together(tmp_path: Path) -> None:
    file = tmp_path / "took.xml"
    file.write_text(JUNIT.format(many="\n".join(MANY.format(k) for k in range(80))))
    assert slow_tests.listed(file) == [
        "tests/a/test_one.py::test_many",
        "tests/a/test_one.py::test_slow",
        "tests/b/test_two.py",
    ]


def test_what_is_listed_is_marked(request: pytest.FixtureRequest) -> None:
    listed = set(slow_tests.LIST.read_text(encoding="utf-8").split())
    for item in request.session.items:
        file = item.path.relative_to(request.config.rootpath).as_posix()
        if listed & {file, f"{file}::{item.name.partition('[')[0]}"}:
            assert item.get_closest_marker("slow"), item.nodeid
