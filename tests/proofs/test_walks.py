"""Walks from definition to definition: what counts for a key, what does not, and what cannot be seen."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.core.ledger.definition_hash import Border, walk
from cratous.core.ledger.module_trees import Tree

ROOT = "pkg.use.root"
FILES = {
    "__init__.py": "",
    "use.py": "from pkg.tools import helper\n\ndef root(x):\n    return helper(x) + 1\n",
    "tools.py": (
        "LIMIT = 3\n\ndef helper(x):\n    return x + LIMIT\n\n"
        "def other(x):\n    return x\n\nclass Box:\n    def __init__(self):\n        self.n = 1\n"
        "    def used(self):\n        return 1\n    def spare(self):\n        return 2\n"
    ),
}


def _digest(folder: Path, files: dict[str, str]) -> str:
    edits = {folder.joinpath(*name.split("/")): text.encode() for name, text in files.items()}
    for file in edits:
        file.parent.mkdir(exist_ok=True, parents=True)
        file.write_bytes(edits[file])
    tree = Tree({"pkg": folder}, {"pkg": ("",)})
    module, _, name = ROOT.rpartition(".")
    places = [place for place in tree.meant(module, (name,)) if not isinstance(place, str)]
    assert places
    return walk(tree, places).digest


def _pair(tmp_path: Path, old: dict[str, str], new: dict[str, str]) -> tuple[str, str]:
    one = _digest(tmp_path / "one", {**FILES, **old})
    return one, _digest(tmp_path / "two", {**FILES, **old, **new})


TOOLS = FILES["tools.py"]
COUNTS = {
    "a callee": ({}, {"tools.py": TOOLS.replace("x + LIMIT", "x - LIMIT")}),
    "a constant": ({}, {"tools.py": TOOLS.replace("LIMIT = 3", "LIMIT = 4")}),
    "a name that means something else": (
        {"use.py": "from pkg.tools import other as helper\n\ndef root(x):\n    return helper(x)\n"},
        {"use.py": "from pkg.tools import helper\n\ndef root(x):\n    return helper(x)\n"},
    ),
    "which of two that are both used": (
        {"use.py": "from pkg.tools import helper as a, other as b, helper as c\n\n"
                   "def root(x):\n    return a(x) + b(x) + c(x)\n"},
        {"use.py": "from pkg.tools import helper as a, other as b, other as c\n\n"
                   "def root(x):\n    return a(x) + b(x) + c(x)\n"},
    ),
    "a default": (
        {"use.py": "D = 1\ndef root(x=D):\n    return x\n"},
        {"use.py": "D = 2\ndef root(x=D):\n    return x\n"},
    ),
    "a decorator": (
        {"use.py": "def mark(f):\n    return f\n@mark\ndef root(x):\n    return x\n"},
        {"use.py": "def mark(f):\n    return abs\n@mark\ndef root(x):\n    return x\n"},
    ),
    "a second definition": (
        {"use.py": "def root(x):\n    return x\n"},
        {"use.py": "def root(x):\n    return x\ndef root(x):\n    return 0\n"},
    ),
    "a statement that changes another's value": (
        {"use.py": "TABLE = {}\ndef root(x):\n    return TABLE\n"},
        {"use.py": "TABLE = {}\ndef root(x):\n    return TABLE\nTABLE[1] = 2\n"},
    ),
    "a statement of another module that does": (
        {"use.py": "from pkg import tools\n\ndef root(x):\n    return tools.helper(x)\n"},
        {"more.py": "from pkg import tools\n\ntools.LIMIT = 9\n"},
    ),
    "a function that tells a decorator of itself": (
        {"use.py": "ALL = []\ndef told(f):\n    ALL.append(f)\n    return f\ndef root(x):\n    return ALL\n"
                   "@told\ndef one(x):\n    return 1\n"},
        {"use.py": "ALL = []\ndef told(f):\n    ALL.append(f)\n    return f\ndef root(x):\n    return ALL\n"
                   "@told\ndef one(x):\n    return 2\n"},
    ),
    "a global that is bound again": (
        {"use.py": "N = 1\ndef root(x):\n    return N\ndef more():\n    pass\n"},
        {"use.py": "N = 1\ndef root(x):\n    return N\ndef more():\n    global N\n    N = 2\n"},
    ),
    "a method that is called": (
        {"use.py": "from pkg.tools import Box\n\ndef root(x):\n    return Box().used()\n"},
        {"tools.py": TOOLS.replace("return 1", "return 7")},
    ),
    "a dunder method": (
        {"use.py": "from pkg.tools import Box\n\ndef root(x):\n    return Box()\n"},
        {"tools.py": TOOLS.replace("self.n = 1", "self.n = 2")},
    ),
    "any method, where the name is not written": (
        {"use.py": "from pkg.tools import Box\n\ndef root(x):\n    return getattr(Box(), x)()\n"},
        {"tools.py": TOOLS.replace("return 2", "return 7")},
    ),
    "any method, where getattr is handed on": (
        {"use.py": "from pkg.tools import Box\n\ndef root(x):\n    return map(getattr, [Box()], x)\n"},
        {"tools.py": TOOLS.replace("return 2", "return 7")},
    ),
    "a base": (
        {"use.py": "from pkg.tools import Box\nclass Mine(Box):\n    pass\ndef root(x):\n    return Mine().used()\n"},
        {"tools.py": TOOLS.replace("return 1", "return 7")},
    ),
    "a method that a base from outside may call": (
        {"use.py": "import ast\nclass V(ast.NodeVisitor):\n    def visit_Add(self, n):\n        return 1\n"
                   "def root(x):\n    return V().visit(x)\n"},
        {"use.py": "import ast\nclass V(ast.NodeVisitor):\n    def visit_Add(self, n):\n        return 2\n"
                   "def root(x):\n    return V().visit(x)\n"},
    ),
    "a module that is handed on": (
        {"use.py": "from pkg import tools\n\ndef root(x):\n    return x(tools)\n"},
        {"tools.py": TOOLS.replace("    return x\n", "    return 8\n")},
    ),
    "an import inside": (
        {"use.py": "def root(x):\n    from pkg.tools import other\n    return other(x)\n"},
        {"tools.py": TOOLS.replace("    return x\n", "    return 8\n")},
    ),
    "all names of a module": (
        {"use.py": "from pkg.tools import *\n\ndef root(x):\n    return other(x)\n"},
        {"tools.py": TOOLS.replace("    return x\n", "    return 8\n")},
    ),
    "an import that may be another": (
        {"use.py": "try:\n    from pkg.tools import helper as h\nexcept ImportError:\n    h = None\n"
                   "def root(x):\n    return h(x)\n"},
        {"tools.py": TOOLS.replace("x + LIMIT", "x - LIMIT")},
    ),
    "a name of a module without it": (
        {"use.py": "from pkg import tools\n\ndef root(x):\n    return tools.made_up\n",
         "tools.py": "def __getattr__(name):\n    return 1\n"},
        {"tools.py": "def __getattr__(name):\n    return 2\n"},
    ),
    "anything, where a module is imported by name": (
        {"use.py": "import importlib\n\ndef root(x):\n    return importlib.import_module(x)\n"},
        {"far.py": "X = 1\n"},
    ),
    "anything, where text is run": (
        {"use.py": "def root(x):\n    return eval(x)\n"}, {"far.py": "X = 1\n"}),
    "anything, where the globals are looked into": (
        {"use.py": "def root(x):\n    return globals()[x]\n"}, {"far.py": "X = 1\n"}),
    "anything, where a file is read": (
        {"use.py": "def root(x):\n    return x.open('rb')\n"}, {"far.py": "X = 1\n"}),
    "a grammar, where a file is read": (
        {"use.py": "def root(x):\n    return x.read_text()\n", "g.lark": "a: b"}, {"g.lark": "a: c"}),
    "anything, where modules are looked up": (
        {"use.py": "import sys\n\ndef root(x):\n    return sys.modules[x]\n"}, {"far.py": "X = 1\n"}),
    "whatever is registered": (
        {"use.py": "from pkg.tools import REGISTRY\n\ndef root(x):\n    return REGISTRY[x]\n"},
        {"far.py": "X = 1\n"},
    ),
}  # fmt: skip
SAME = {
    "comments, layout and docstrings": (
        {}, {"use.py": 'from pkg.tools import helper\n\ndef root(x):\n    """Text."""\n    return (helper(x)\n       + 1)  # more\n'}),
    "a function that nothing uses": ({}, {"tools.py": TOOLS + "\ndef more(x):\n    return 0\n"}),
    "a function beside it": ({}, {"tools.py": TOOLS.replace("    return x\n", "    return 8\n")}),
    "a method that nobody names": (
        {"use.py": "from pkg.tools import Box\n\ndef root(x):\n    return Box().used()\n"},
        {"tools.py": TOOLS.replace("return 2", "return 7")},
    ),
    "a field that is called open": (
        {"use.py": "def root(x):\n    return x.open\n"}, {"far.py": "X = 1\n"}),
    "another order": (
        {}, {"tools.py": "def helper(x):\n    return x + LIMIT\n\nLIMIT = 3\n"}),
    "a move of a function": (
        {}, {"use.py": "from pkg.far import helper\n\ndef root(x):\n    return helper(x) + 1\n",
             "far.py": "from pkg.tools import LIMIT\n\ndef helper(x):\n    return x + LIMIT\n"}),
    "a rename of a module": (
        {}, {"use.py": "from pkg.deep.renamed import helper\n\ndef root(x):\n    return helper(x) + 1\n",
             "deep/__init__.py": "", "deep/renamed.py": TOOLS}),
}  # fmt: skip


@pytest.mark.parametrize("what", sorted(COUNTS))
def test_what_can_change_the_meaning_counts(what: str, tmp_path: Path) -> None:
    one, other = _pair(tmp_path, *COUNTS[what])
    assert one != other


@pytest.mark.parametrize("what", sorted(SAME))
def test_what_cannot_does_not(what: str, tmp_path: Path) -> None:
    one, other = _pair(tmp_path, *SAME[what])
    assert one == other


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("'law_a'", ["law_a"]),
        ("f'law_{x}'", ["law_a", "law_b"]),
        ("'law_' + x", ["law_a", "law_b"]),
        ("'other'", []),
        ("f'law: {x}'", []),
        ("f'{x}.{x}'", []),
    ],
)
def test_names_in_texts_are_known(text: str, names: list[str], tmp_path: Path) -> None:
    _digest(tmp_path, {**FILES, "use.py": f"def root(x):\n    return {text}\n"})
    tree = Tree({"pkg": tmp_path}, {"pkg": ("",)})
    (place,) = tree.meant("pkg.use", ("root",))
    assert not isinstance(place, str)
    known = frozenset({"law_a", "law_b", "rule", "pkg.law_a"})
    assert list(walk(tree, [place], known=known).strings) == names


def test_an_excuse_is_of_one_definition_and_one_way_of_looking(tmp_path: Path) -> None:
    files = {**FILES, "use.py": "def root(x):\n    return eval(x)\n"}
    _digest(tmp_path, files)
    tree = Tree({"pkg": tmp_path}, {"pkg": ("",)})
    (place,) = tree.meant("pkg.use", ("root",))
    assert not isinstance(place, str)

    def asks(excused: dict[str, frozenset[str]]) -> set[str]:
        found = walk(tree, [place], excused=excused).asks
        return {word for words in found.values() for word in words}

    assert asks({}) == {"eval"}
    assert asks({ROOT: frozenset({"exec"})}) == {"eval"}
    assert asks({"pkg.use.other": frozenset({"eval"})}) == {"eval"}
    assert asks({ROOT: frozenset({"eval"})}) == set()


def test_a_walk_ends_at_its_border(tmp_path: Path) -> None:
    _digest(tmp_path, FILES)
    tree = Tree({"pkg": tmp_path}, {"pkg": ("",)})
    (root,) = tree.meant("pkg.use", ("root",))
    (helper,) = tree.meant("pkg.tools", ("helper",))
    assert not isinstance(root, str)
    assert not isinstance(helper, str)
    found = walk(tree, [root], Border(frozenset({helper}), lambda place: "the border"))
    assert set(found.places) == {root}
    assert found.edge == {helper}
