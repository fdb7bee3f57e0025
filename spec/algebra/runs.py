"""The orders in which the tasks of a process-algebra term may be assigned. Timing is not considered.

An operand of `.` may begin when the one before it is complete; an operand of `~` when the one before it has begun.
Sorted by start, the tasks of every schedule that satisfies the term appear in such an order, so a search over these
orders misses no schedule. A state is the remainder of the term after the actions so far (its derivative); it has
several entries only if operands of a `+` share tasks, and then the choice stays open until the tasks themselves
decide it.
"""

from __future__ import annotations

from collections.abc import Iterator

from cratous.spec.algebra import ALTERNATIVE, PARALLEL, SEQUENTIAL, TILDE, Atom, Op, Term

State = tuple[Term | None, ...]
"""What may remain to be done after some actions, one entry per way to get there; None: nothing remains."""


def begin(term: Term) -> State:
    """The state before the first action."""
    return (term,)


def advance(state: State, task: int) -> State:
    """The state after one more task; empty if that task may not come next."""
    found: list[Term | None] = []
    for rest in state:
        if rest is not None:
            found += _after(rest, task)
    return tuple(found) if len(found) < 2 else tuple(dict.fromkeys(found))


def actions(state: State) -> frozenset[int]:
    """The tasks that may come next."""
    found: set[int] = set()
    for rest in state:
        if rest is not None:
            _first(rest, found)
    return frozenset(found)


def next_actions(term: Term, done: tuple[int, ...]) -> frozenset[int]:
    """The tasks that may be assigned next, after `done` in this order.

    Empty if nothing remains to be done, and also if `done` itself is not allowed (`complete` tells these apart).
    """
    return actions(_state_after(term, done))


def complete(term: Term, done: tuple[int, ...]) -> bool:
    """Whether `done`, in this order, does everything that the term requires and nothing else."""
    return None in _state_after(term, done)


def runs(term: Term, limit: int | None = None) -> Iterator[tuple[int, ...]]:
    """All complete assignment orders, each once, in lexicographic order of ids; at most `limit`."""
    given = 0
    done: list[int] = []
    states = [begin(term)]
    choices = [iter(sorted(actions(states[0])))]
    while choices and (limit is None or given < limit):
        task = next(choices[-1], None)
        if task is None:
            choices.pop()
            states.pop()
            if done:
                done.pop()
            continue
        done.append(task)
        states.append(advance(states[-1], task))
        choices.append(iter(sorted(actions(states[-1]))))
        if None in states[-1]:
            given += 1
            yield tuple(done)


def _state_after(term: Term, done: tuple[int, ...]) -> State:
    state = begin(term)
    for task in done:
        state = advance(state, task)
    return state


def _first(term: Term, found: set[int]) -> None:
    if isinstance(term, Atom):
        found.add(term.task)
    elif term.op in (SEQUENTIAL, TILDE):
        _first(term.operands[0], found)
    else:
        for operand in term.operands:
            _first(operand, found)


def _after(term: Term, task: int) -> list[Term | None]:
    """What may remain of a term after `task` has been done first."""
    if isinstance(term, Atom):
        return [None] if term.task == task else []
    left: list[Term | None] = []
    if term.op == ALTERNATIVE:
        for operand in term.operands:
            left += _after(operand, task)
        return left
    if term.op == PARALLEL:
        for place, operand in enumerate(term.operands):
            for rest in _after(operand, task):
                others = (*term.operands[:place], rest, *term.operands[place + 1 :])
                left.append(_together(PARALLEL, others))
        return left
    tail = _together(term.op, term.operands[1:])
    joint = SEQUENTIAL if term.op == SEQUENTIAL else PARALLEL
    for rest in _after(term.operands[0], task):
        left.append(_together(joint, (rest, tail)))
    return left


def _together(op: str, parts: tuple[Term | None, ...]) -> Term | None:
    """The remaining parts under one operator, without timing.

    `.` and `|` are flattened to keep terms shallow; `~` is not associative.
    """
    flat: list[Term] = []
    for part in parts:
        if isinstance(part, Op) and part.op == op and op != TILDE:
            flat.extend(part.operands)
        elif part is not None:
            flat.append(part)
    if not flat:
        return None
    return flat[0] if len(flat) == 1 else Op(op, tuple(flat))
