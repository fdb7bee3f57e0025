"""Dynamic look-ups that were reviewed: why a key need not follow them.

A name that is looked up at run time cannot be followed in the text. Code that does so depends on everything, unless
it is listed here. A row names `module.definition` and the words by which it looks something up, with the reason; a
row that names nothing real fails a test.
"""

from __future__ import annotations

CACHE = "what lies there is found by the hash of what it was made from"
ENTRY = "what is registered has a key of its own, which is held against the ledger by itself"
READ = "it looks into functions that a key is about, and their keys follow the names in them"
RUNS = "the gate holds what runs against the files by it; it decides nothing else"
MADE = "it runs a text that was made here from the text of the function that it is given"
TABLE = "it makes the tables that keys are made of: other tables give other keys"

EXCUSES: dict[str, tuple[tuple[str, ...], str]] = {
    "core.files.private_cache.cache_folder": (("environ",), CACHE),
    "core.kernel.entry_of": (("REGISTRY",), ENTRY),
    "core.kernel._register": (("REGISTRY",), ENTRY),
    "core.kernel._resolved": (
        ("REGISTRY", "modules", "vars"),
        "the kernels that re-check a driver are roots of the driver's own walk",
    ),
    "core.kernel.sources.reached": (("__globals__", "modules", "vars"), READ),
    "core.kernel.sources._written": (("read_bytes", "read_text"), RUNS),
    "core.kernel.sources._held": (("vars",), READ),
    "core.kernel.sources.stands_for_itself": (("modules", "vars"), RUNS),
    "core.kernel.sources._as_written": (("modules",), RUNS),
    "core.ledger.load_all": (("REGISTRY", "import_module", "importlib"), ENTRY),
    "core.ledger.check": (("load_all",), ENTRY),
    "core.ledger.check_everything": (("REGISTRY",), ENTRY),
    "core.ledger.require": (("REGISTRY",), "names for what is refused"),
    "core.ledger.meant_folds.other_parts": (("getattr", "modules", "vars"), RUNS),
    "core.ledger.meant_folds._named": (("getattr",), RUNS),
    "core.ledger.meant_folds._written": (("read_bytes",), RUNS),
    "core.ledger.meant_methods._of": (("vars",), RUNS),
    "core.ledger.meant_methods._is_made": (("vars",), RUNS),
    "core.ledger.meant_methods._made_anew": (("getattr", "vars"), RUNS),
    "core.ledger.meant_methods._other_fields": (("vars",), RUNS),
    "core.ledger.meant_methods._written": (("modules",), RUNS),
    "core.ledger.meant_methods.GETTER": (("vars",), RUNS),
    "core.ledger.meant_names.BUILTINS": (("vars",), RUNS),
    "core.ledger.meant_names._file_says": (("modules", "read_bytes"), RUNS),
    "core.ledger.meant_names._is_pythons": (("vars",), RUNS),
    "core.ledger.meant_names._of": (("__globals__", "vars"), RUNS),
    "core.ledger.meant_names._within": (("vars",), RUNS),
    "core.ledger.meant_names._is_imported": (("vars",), RUNS),
    "core.ledger.package_home.package": (
        ("import_module", "importlib"),
        "the package with its kernels has a ledger of its own",
    ),
    "core.ledger.kept_keys.keys_of": (("read_text",), CACHE),
    "core.ledger.kept_keys._files": (("open",), "it hashes what the keys are made from"),
    "core.ledger.key_parts.version": (("importlib",), "the versions are parts of each key"),
    "core.ledger.records.read": (("read_text",), "it reads what the keys are held against"),
    "core.ledger.syntax_text._Reader.plain": (("getattr",), TABLE),
    "core.ledger.tables._table": (("read_text",), TABLE),
    "core.ledger.tables._maker": (("read_bytes",), TABLE),
    "core.ledger.tables._kept": (("vars",), TABLE),
    "core.ledger.module_trees.Tree._read": (("open",), TABLE),
    "core.ledger.module_trees._data": (("read_bytes",), TABLE),
    "core.readings.exact._scalar_filter": (("exec",), MADE),
    "core.readings.exact.integers.decider": (("exec",), MADE),
    "core.readings.graph._Walk.called": (("__globals__",), READ),
    "core.readings.graph._Walk.known": (("__globals__",), READ),
    "core.readings.machine.compiled.load": (("importlib", "modules", "read_text"), MADE),
    "core.readings.machine.compiled.machine": (("getattr",), MADE),
    "core.readings.machine.source_text.SourceText._function": (("__globals__",), READ),
    "core.readings.machine.source_text.SourceText._reference": (("__globals__",), READ),
    "core.readings.machine.source_text.SourceText.reference": (("getattr",), READ),
    "core.readings.machine.source_text._Renaming._typed": (("__globals__",), READ),
    "core.readings.machine.source_text._Renaming.visit_Call": (("__globals__",), READ),
    "core.readings.machine.source_text._Renaming.visit_Attribute": (
        ("__globals__", "getattr"),
        READ,
    ),
    "proofs.engine.lift._with_lifted_callees": (("__globals__", "getattr"), READ),
    "proofs.engine.plain_numbers.watching": (("__globals__", "exec"), MADE),
    "proofs.engine.plain_numbers._together": (("__globals__",), READ),
    "proofs.engine.plain_numbers._used": (("__globals__", "vars"), READ),
    "proofs.engine.plain_numbers._is_number": (("__globals__",), READ),
    "proofs.engine.plain_numbers.hold": (("__globals__",), READ),
    "proofs.engine.closed._called": (("__globals__",), READ),
    "proofs.engine.subset.lint": (("__globals__",), READ),
    "proofs.engine.subset._head": (("__globals__",), READ),
    "proofs.engine.subset._of_python": (("vars",), READ),
    "proofs.engine.subset.identity": (("__globals__", "vars"), READ),
    "proofs.engine.definition_subset._check": (("__globals__",), READ),
    "proofs.engine.definition_subset.DefinitionKinds.named": (("vars",), READ),
    "proofs.engine.expressions.Kinds._call": (("getattr",), READ),
    "proofs.engine.value_kinds.is_record": (("vars",), READ),
    "proofs.engine.written_types._is": (("vars",), READ),
    "proofs.engine.written_types.record": (("vars",), READ),
    "proofs.engine.module_source.constant": (("vars",), READ),
    "proofs.engine.theorem_names.BEHAVIOUR": (
        ("getattr",),
        "it names the methods of Python's own values, which are the same in each process of one Python",
    ),
    "proofs.engine.theorem_values.check_values": (("modules",), READ),
    "proofs.engine.theorem_values._meant": (("vars",), READ),
    "proofs.engine.theorem_values._check_file": (("modules", "read_text", "vars"), READ),
    "proofs.engine.theorem_subset.HIDDEN": (
        ("vars",),
        "the names of a class that is walked itself",
    ),
    "proofs.engine.module_source.parsed": (("open",), RUNS),
    "proofs.engine.module_source._value": (("eval",), MADE),
    "proofs.engine.subset.lint_all": (("REGISTRY",), ENTRY),
    "proofs.engine.theorem_files._module": (
        ("__dict__", "exec", "modules", "read_text"),
        "a theorem and the lemmas that it names are parts of the keys of what they are about",
    ),
    "proofs.running.all._some": (
        ("import_module", "importlib", "vars"),
        "it runs functions that a theorem looked into: they are parts of the key of what it is about",
    ),
    "proofs.running.copies.with_root": (("__globals__",), READ),
    "proofs.running.lifted.evaluator": (("exec",), MADE),
    "proofs.ledger.prove_all": (("load_all",), ENTRY),
    "proofs.ledger.problems": (("REGISTRY",), ENTRY),
    "proofs.ledger.records": (("load_all",), ENTRY),
    "proofs.methods.rounding.filters": (
        ("load_all",),
        "it states the same of each kernel by itself, and a changed kernel is refused until the whole "
        "ledger is proved anew; what is recalled follows all of them (`Keys.asks_registry`)",
    ),
}

EXCUSED: dict[str, frozenset[str]] = {
    f"cratous.{name}": frozenset(words) for name, (words, _) in EXCUSES.items()
}
