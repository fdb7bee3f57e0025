"""Large-neighbourhood search: strings of adjacent tasks are removed from their chains and reinserted.

The removed tasks (at most 14, in strings of at most 10) are reinserted one by one where this costs least: the
positions of all vehicles and options are ranked by the delay of the following task, and the best three are timed in
full (`time_chains`). A result is accepted by threshold accepting. Everything found is timed and checked like any
other solution.

Source of string removal: J. Christiaens, G. Vanden Berghe, "Slack Induction by String Removals for Vehicle Routing
Problems", Transportation Science 54(2), 2020.
"""

from __future__ import annotations

import numpy as np

from cratous.core.assignment.instance import Instance
from cratous.core.assignment.search_records import ChainArrays, Times
from cratous.core.assignment.steps import earliest_start, weighted


def time_chains(
    chains: ChainArrays, times: Times, order: np.ndarray, next_of: np.ndarray, i: Instance
) -> int:
    """The cost of chains, possibly of some tasks only, with times and order; 2**60: they block each other.

    Rows about tasks that are in no chain are ignored. The task that can start first comes next. next_of [V]: scratch.
    Each millisecond beyond a latest end costs 1000.
    """
    chain, length, how, there = chains.chain, chains.length, chains.how, chains.there
    starts, ends, free = times.starts, times.ends, times.free
    travel, added, duration, ready = i.travel, i.added, i.duration, i.ready
    release, due, ref_kind, member_first = i.release, i.due, i.ref_kind, i.member_first
    member, row_first, row_ref, row_lo = i.member, i.row_first, i.row_ref, i.row_lo
    weight, waits = i.weight, i.waits
    vehicles, options, n = ready.size, duration.size, starts.size
    total = 0
    for v in range(vehicles):
        next_of[v] = 0
        free[v] = ready[v]
        total += length[v]
    for j in range(n):
        ends[j] = -1
    last = 0
    legs = 0
    late = 0
    for p in range(total):
        best_v, best_begin = -1, 1 << 60
        for v in range(vehicles):
            if next_of[v] >= length[v]:
                continue
            j = chain[v, next_of[v]]
            o = how[j]
            at = options
            if next_of[v] > 0:
                at = how[chain[v, next_of[v] - 1]]
            way = travel[v, at, o]
            if way >= 1 << 40:
                return 1 << 60
            ref = release[j]
            open_now = True
            for place in range(row_first[j], row_first[j + 1]):
                r = row_ref[place]
                at_ref = 0 if ref_kind[r] == 1 else 1 << 40
                any_there = False
                for m in range(member_first[r], member_first[r + 1]):
                    k = member[m]
                    if there[k] == 0:
                        continue
                    any_there = True
                    if ref_kind[r] == 1:
                        if ends[k] < 0:
                            open_now = False
                        at_ref = max(at_ref, ends[k])
                    elif ends[k] >= 0:
                        at_ref = min(at_ref, starts[k])
                if any_there and at_ref == 1 << 40:
                    open_now = False
                if any_there and waits and open_now:
                    ref = max(ref, at_ref + row_lo[place])
            if not open_now:
                continue
            begin = earliest_start(free[v], way, 0, ref)
            if begin < best_begin:
                best_v, best_begin = v, begin
        if best_v < 0:
            return 1 << 60
        j = chain[best_v, next_of[best_v]]
        o = how[j]
        at = options
        if next_of[best_v] > 0:
            at = how[chain[best_v, next_of[best_v] - 1]]
        legs += added[best_v, at, o]
        starts[j] = best_begin
        ends[j] = best_begin + duration[o]
        free[best_v] = ends[j]
        next_of[best_v] += 1
        order[p] = j
        last = max(last, ends[j])
        if ends[j] > due[j]:
            late += ends[j] - due[j]
    team = 0
    for v in range(vehicles):
        if length[v] > 0:
            team += free[v]
    free[vehicles] = team
    return weighted(last, team, legs, weight[0], weight[1]) + late * 1000


def rebuild(
    order: np.ndarray, who: np.ndarray, how: np.ndarray, rounds: int, seed: int, hot: float,
    near: np.ndarray, i: Instance,
) -> int:  # fmt: skip
    """Remove and reinsert tasks for `rounds` rounds; returns the cost of the best, which is left in the arrays.

    near [n, n]: for each task all tasks, the nearest first; hot: initial temperature, as a share of the cost.
    """
    travel, added, duration, ready = i.travel, i.added, i.duration, i.ready
    release, due, ref_kind, member_first = i.release, i.due, i.ref_kind, i.member_first
    member, row_first, row_ref, row_lo = i.member, i.row_first, i.row_ref, i.row_lo
    weight, waits = i.weight, i.waits
    task, may = i.task, i.may
    n, vehicles, options = order.size, ready.size, duration.size
    chain, length = np.zeros((vehicles, n), np.int64), np.zeros(vehicles, np.int64)
    for p in range(n):
        v = who[order[p]]
        chain[v, length[v]] = order[p]
        length[v] += 1
    there = np.ones(n, np.int64)
    starts, ends = np.zeros(n, np.int64), np.zeros(n, np.int64)
    made, next_of = np.zeros(n, np.int64), np.zeros(vehicles, np.int64)
    free = np.zeros(vehicles + 1, np.int64)
    spare, spare_of, spare_how = chain.copy(), length.copy(), how.copy()
    best_how = how.copy()
    out, hit = np.zeros(n, np.int64), np.zeros(vehicles, np.int64)
    chains, times = ChainArrays(chain, length, how, there), Times(starts, ends, free)
    top_key, top = np.zeros(3, np.int64), np.zeros((3, 3), np.int64)
    share = 6 * vehicles
    now = time_chains(chains, times, made, next_of, i)
    best = 1 << 60
    if now < 1 << 60:
        best = now
        order[:] = made
    smooth = now + free[vehicles] // share if now < 1 << 60 else 1 << 60
    x = np.int64(seed * 2 + 88172645463325253)
    for step in range(rounds):
        spare[:] = chain
        spare_of[:] = length
        spare_how[:] = how
        x ^= x << 13
        x ^= (x >> 7) & np.int64(0x01FFFFFFFFFFFFFF)
        x ^= x << 17
        # remove strings of the chains that pass the tasks nearest to one
        seed_task = (x & 0xFFFF) % n
        strings = 1 + ((x >> 16) & 0xFF) % 3
        count = 0
        hit[:] = 0
        for q in range(n):
            if strings == 0 or count >= 14:
                break
            j = near[seed_task, q]
            v, at = -1, -1
            for w in range(vehicles):
                for p in range(length[w]):
                    if chain[w, p] == j:
                        v, at = w, p
            if v < 0 or hit[v] == 1:
                continue
            hit[v] = 1
            strings -= 1
            x ^= x << 13
            x ^= (x >> 7) & np.int64(0x01FFFFFFFFFFFFFF)
            x ^= x << 17
            long = min(length[v], 1 + ((x >> 8) & 0xFF) % 10)
            long = min(long, 14 - count)
            first = max(0, min(at - ((x >> 20) & 0xFF) % long, length[v] - long))
            for p in range(first, first + long):
                out[count] = chain[v, p]
                there[chain[v, p]] = 0
                count += 1
            for p in range(first, length[v] - long):
                chain[v, p] = chain[v, p + long]
            length[v] -= long
        # order of reinsertion: random, or the longest first
        x ^= x << 13
        x ^= (x >> 7) & np.int64(0x01FFFFFFFFFFFFFF)
        x ^= x << 17
        for a in range(count):
            b = a + ((x >> (a % 32)) & 0xFFFF) % (count - a)
            out[a], out[b] = out[b], out[a]
        if (x >> 40) & 1:
            for a in range(1, count):
                q = a
                while q > 0 and duration[how[out[q - 1]]] < duration[how[out[q]]]:
                    out[q - 1], out[q] = out[q], out[q - 1]
                    q -= 1
        cost = time_chains(chains, times, made, next_of, i)
        for a in range(count):
            if cost >= 1 << 60:
                break
            j = out[a]
            last = 0
            for v in range(vehicles):
                if length[v] > 0:
                    last = max(last, free[v])
            ref = release[j]
            if waits:
                for place in range(row_first[j], row_first[j + 1]):
                    r = row_ref[place]
                    if ref_kind[r] == 1:
                        for m in range(member_first[r], member_first[r + 1]):
                            if there[member[m]]:
                                ref = max(ref, ends[member[m]] + row_lo[place])
            # the first start of a successor, which a later end delays
            follows = 1 << 60
            for k in range(n):
                if there[k] == 0 or waits == 0:
                    continue
                for place in range(row_first[k], row_first[k + 1]):
                    r = row_ref[place]
                    if ref_kind[r] == 1:
                        for m in range(member_first[r], member_first[r + 1]):
                            if member[m] == j:
                                follows = min(follows, starts[k] - row_lo[place])
            for t in range(3):
                top_key[t] = 1 << 60
            for o in range(options):
                if task[o] != j:
                    continue
                for v in range(vehicles):
                    if may[v, o] == 0:
                        continue
                    for p in range(length[v] + 1):
                        x ^= x << 13
                        x ^= (x >> 7) & np.int64(0x01FFFFFFFFFFFFFF)
                        x ^= x << 17
                        if (x & 0x7F) == 0:
                            continue
                        at, leave = options, ready[v]
                        if p > 0:
                            at, leave = how[chain[v, p - 1]], ends[chain[v, p - 1]]
                        way = travel[v, at, o]
                        if way >= 1 << 40:
                            continue
                        end = max(leave + way, ref) + duration[o]
                        push = 0
                        more = added[v, at, o]
                        if p < length[v]:
                            behind = chain[v, p]
                            on = travel[v, o, how[behind]]
                            if on >= 1 << 40:
                                continue
                            push = max(0, end + on - starts[behind])
                            more += added[v, o, how[behind]] - added[v, at, how[behind]]
                            done = free[v] + push
                        else:
                            push = end - (free[v] if length[v] > 0 else 0)
                            done = end
                        key = (weight[0] * max(last, done) + more) * share + push * (
                            weight[1] * share + 1 + weight[0]
                        )
                        if end > follows:
                            key += (end - follows) * (weight[0] + weight[1]) * share
                        if end > due[j]:
                            key += (end - due[j]) * 1000
                        t = 3
                        while t > 0 and key < top_key[t - 1]:
                            t -= 1
                        for u in range(2, t, -1):
                            top_key[u] = top_key[u - 1]
                            for c in range(3):
                                top[u, c] = top[u - 1, c]
                        if t < 3:
                            top_key[t] = key
                            top[t, 0], top[t, 1], top[t, 2] = v, p, o
            there[j] = 1
            least, pick = 1 << 60, -1
            for t in range(4):
                # the last round restores the best solution
                u = t
                if t == 3:
                    if pick < 0:
                        break
                    u = pick
                elif top_key[t] >= 1 << 60:
                    continue
                v, p = top[u, 0], top[u, 1]
                how[j] = top[u, 2]
                for q in range(length[v], p, -1):
                    chain[v, q] = chain[v, q - 1]
                chain[v, p] = j
                length[v] += 1
                got = time_chains(chains, times, made, next_of, i)
                if t == 3:
                    break
                got_smooth = got + free[vehicles] // share if got < 1 << 60 else got
                if got_smooth < least:
                    least, pick = got_smooth, t
                length[v] -= 1
                for q in range(p, length[v]):
                    chain[v, q] = chain[v, q + 1]
            cost = int(got) if pick >= 0 else 1 << 60
        left = 1.0 - step / rounds
        slack = now * hot * left * left * (((x >> 20) & 0xFFF) / 4096.0)
        kept = False
        if cost < 1 << 60:
            if cost < best:
                best = cost
                best_how[:] = how
                order[:] = made
                for v in range(vehicles):
                    for p in range(length[v]):
                        who[chain[v, p]] = v
            if cost + free[vehicles] // share <= smooth + int(slack):
                now = cost
                smooth = cost + free[vehicles] // share
                kept = True
        if not kept:
            chain[:] = spare
            length[:] = spare_of
            how[:] = spare_how
        there[:] = 1
    how[:] = best_how
    return best
