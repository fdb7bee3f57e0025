"""UxAS's end and the gate of the vehicle agree: what UxAS commands when it has heard an offer passes the
gate and completes the handback, unless ICAROUS has withdrawn the offer since, and then it is dropped;
what it commands before it has heard of a takeover is dropped too."""

from cratous.core.authority.gate import Gate, gate_accepts, gate_after, gate_offer, gate_takeover
from cratous.core.authority.link_end import LinkEnd, link_mode
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("gate_epoch"), c.boolean("offered"))
    end = LinkEnd(c.boolean("active"), c.integer("epoch"), c.boolean("alive"))
    c.premise(c.define(authority.well_formed, gate))
    c.premise(end.epoch <= gate.epoch)  # it has heard of no epoch that has not begun
    taken = c.use(gate_takeover, gate)
    early = c.use(gate_accepts, taken, 0, end.epoch)
    c.show(c.negation(early), "a command that was made before the takeover is dropped")
    heard = c.use(link_mode, end, taken, True, taken.epoch)
    c.show(heard.act == link_end.SUSPEND, "a takeover that is heard is believed")
    c.show(heard.end.epoch == taken.epoch, "and end and gate agree")
    offer = c.use(gate_offer, taken)
    told = c.use(link_mode, heard.end, offer, False, offer.epoch)
    c.show(told.act == link_end.TAKE_BACK, "an offer that is heard is taken")
    passes = c.use(gate_accepts, offer, 0, told.end.epoch)
    c.show(passes, "the command passes the gate")
    after = c.use(gate_after, offer, 0, told.end.epoch)
    alone = c.all_of(
        c.define(authority.may_command, after, 0),
        c.negation(c.define(authority.may_command, after, 1)),
    )
    c.show(alone, "and UxAS commands alone")
    withdrawn = c.use(gate_takeover, offer)
    late = c.use(gate_accepts, withdrawn, 0, told.end.epoch)
    c.show(c.negation(late), "an offer that was withdrawn is not taken")
