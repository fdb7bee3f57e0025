"""An answer to the request that is being planned is passed on at once; an answer to any other, late or
foreign or repeated, changes nothing and is reported; an arrival is taken under the next ticket."""

from cratous.core.contracts.requests import Line, line_step
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    line = Line(c.integer("taken"), c.integer("answered"), c.boolean("busy"), c.integer("sent_ms"))
    event, answer, now, limit = (c.integer(n) for n in ("event", "answer", "now_ms", "limit_ms"))
    c.premise(c.all_of(line.answered >= 0, line.answered <= line.taken, line.taken <= 2**60))
    c.premise(c.implies(line.busy, line.answered < line.taken))
    step = c.use(line_step, line, event, answer, now, limit)
    mine = c.all_of(event == 2, line.busy, answer == line.answered)
    other = c.all_of(event == 2, c.negation(c.all_of(line.busy, answer == line.answered)))
    passed = c.all_of(step.act == 3, step.ticket == answer, step.line.answered > answer)
    c.show(c.implies(mine, passed), "the answer that is waited for is passed on")
    # what is kept of the last publication is its instant
    c.show(c.implies(event != 3, step.line.sent_ms == line.sent_ms), "its instant stays")
    c.show(
        c.implies(other, c.all_of(step.act == 5, step.ticket == answer, c.same(step.line, line))),
        "any other is reported and changes nothing",
    )
    room = c.all_of(event == 1, line.taken < 2**60)
    c.show(
        c.implies(
            room,
            c.all_of(
                step.act == 1,
                step.ticket == line.taken,
                step.line.taken == line.taken + 1,
                step.line.answered == line.answered,
                c.same(step.line.busy, line.busy),
                step.line.sent_ms == line.sent_ms,
            ),
        ),
        "an arrival gets the next ticket",
    )
    full = c.all_of(event == 1, line.taken >= 2**60)
    c.show(
        c.implies(full, c.all_of(step.act == 6, c.same(step.line, line))), "a full line refuses it"
    )
    c.show(c.implies(full, step.ticket == line.taken), "by the ticket it would have had")
    free = c.all_of(event == 3, c.negation(line.busy), line.answered < line.taken)
    published = c.all_of(step.act == 2, step.ticket == line.answered, step.line.sent_ms == now)
    c.show(c.implies(free, published), "with none being planned the next one is published")
    over = c.all_of(event == 3, line.busy, now - line.sent_ms >= limit)
    c.show(
        c.implies(over, c.all_of(step.act == 4, step.ticket == line.answered)),
        "one whose time ran out is answered so",
    )
    c.show(c.implies(over, step.line.sent_ms == line.sent_ms), "its instant stays too")
    wait = c.all_of(event == 3, line.busy, now - line.sent_ms < limit)
    empty = c.all_of(event == 3, c.negation(line.busy), line.answered == line.taken)
    unknown = c.all_of(event != 1, event != 2, event != 3)
    c.show(
        c.implies(c.any_of(wait, empty, unknown), c.all_of(step.act == 0, c.same(step.line, line))),
        "without a cause nothing happens",
    )
    c.show(c.implies(step.act == 0, step.ticket == line.answered), "to the next to be answered")
