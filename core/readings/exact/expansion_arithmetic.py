"""Floating-point expansions as numba text: sums, products and signs without rounding.

An expansion is a sum of doubles of which no two overlap; sums and products of expansions are
exact as long as nothing overflows or underflows (J. R. Shewchuk, "Adaptive Precision
Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997; products split after T. J.
Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971, so that no fused
operation is needed). One compiled function carries out tables of steps over a work array with fixed
places; `expansion_steps` makes the tables. It is text and not code because it is compiled beside
the kernels, in their private folder, with their flags.
"""

LONGEST = 2100
"""Upper bound of an expansion's length: its parts do not overlap, and doubles span fewer bits."""
MUL2, ADD2, SUB2, ADD, SUB, SCALE, MUL, TIMES, ABS, PICK, PICK_NOT, DOT, CROSS = range(13)

PRIMITIVES = '''
@FLAGS
def two_sum(x, y):
    """x + y, rounded, and the exact rest (Knuth)."""
    s = x + y
    t = s - x
    return s, (x - (s - t)) + (y - t)


@FLAGS
def _high(x):
    """The upper 26 bits of x (Dekker)."""
    t = 134217729.0 * x
    return t - (t - x)


@FLAGS
def two_product(x, y):
    """x * y, rounded, and the exact rest (Dekker)."""
    p = x * y
    a = _high(x)
    b = x - a
    c = _high(y)
    d = y - c
    return p, b * d - (((p - a * c) - b * c) - a * d)


# An expansion's place has two cells more than it is long: results are written before it is known
# whether they are zero, and no branch depends on the data.
@FLAGS
def _two(w, c, s, e):
    """The expansion of e and s, the greater."""
    w[c] = e
    n = 1 if e != 0 else 0
    w[c + n] = s
    return n + (1 if s != 0 else 0)


@FLAGS
def _add2(w, c, x, y):
    """x + y."""
    s, e = two_sum(x, y)
    return _two(w, c, s, e)


@FLAGS
def _mul2(w, c, x, y):
    """x * y."""
    p, e = two_product(x, y)
    return _two(w, c, p, e)


@FLAGS
def _dot(w, c, x, y, u, v, sign):
    """x * y plus sign times u * v: a sum of two and two, without a loop."""
    p, e = two_product(x, y)
    q, g = two_product(sign * u, v)
    s, h0 = two_sum(e, g)
    i, k = two_sum(p, s)
    s, h1 = two_sum(k, q)
    h3, h2 = two_sum(i, s)
    w[c] = h0
    n = 1 if h0 != 0 else 0
    w[c + n] = h1
    n += 1 if h1 != 0 else 0
    w[c + n] = h2
    n += 1 if h2 != 0 else 0
    w[c + n] = h3
    return n + (1 if h3 != 0 else 0)


@FLAGS
def _times(w, a, n, x, c):
    """The expansion at a times x, a power of two or 0 or -1."""
    if x == 0:
        return 0
    for k in range(n):
        w[c + k] = w[a + k] * x
    return n


@FLAGS
def _scale(w, a, n, y, c):
    """The expansion at a times y."""
    if n == 0 or y == 0:
        return 0
    q, low = two_product(w[a], y)
    w[c] = low
    m = 1 if low != 0 else 0
    for k in range(1, n):
        p, low = two_product(w[a + k], y)
        s, e = two_sum(q, low)
        w[c + m] = e
        m += 1 if e != 0 else 0
        q = p + s
        e = s - (q - p)
        w[c + m] = e
        m += 1 if e != 0 else 0
    w[c + m] = q
    m += 1 if q != 0 else 0
    return m


@FLAGS
def _sum(w, a, n, b, k, sign, c):
    """The expansion at a plus sign times the one at b."""
    if n == 0:
        return _times(w, b, k, sign, c)
    if k == 0:
        return _times(w, a, n, 1.0, c)
    i = 0
    j = 0
    m = 0
    q = 0.0
    for _ in range(n + k):
        # one place beyond either may be read: it is not used
        x = w[a + i]
        y = w[b + j]
        first = (j == k) | ((i < n) & (abs(x) < abs(y)))
        x = x if first else sign * y
        i += 1 if first else 0
        j += 0 if first else 1
        q, e = two_sum(q, x)
        w[c + m] = e
        m += 1 if e != 0 else 0
    w[c + m] = q
    m += 1 if q != 0 else 0
    return m


@FLAGS
def _mul(w, a, n, b, k, c, t, u):
    """The product of two expansions; t and u are scratch."""
    if n < k:
        a, n, b, k = b, k, a, n
    if k == 0:
        return 0
    if k == 1:
        return _scale(w, a, n, w[b], c)
    m = _scale(w, a, n, w[b], u)
    for j in range(1, k - 1):
        p = _scale(w, a, n, w[b + j], t)
        r = _sum(w, u, m, t, p, 1.0, c)
        m = _times(w, c, r, 1.0, u)
    p = _scale(w, a, n, w[b + k - 1], t)
    return _sum(w, u, m, t, p, 1.0, c)


@FLAGS
def _sign(w, a, n):
    """The sign of an expansion: that of its greatest part."""
    if n == 0 or w[a + n - 1] == 0:
        return 0
    return 1 if w[a + n - 1] > 0 else -1


@FLAGS
def sign_of(w, length, steps, first, last):
    """Carry out the steps first to last - 1 and give the sign of the last one's result.

    A step is (operation, operands x and y, result z, their places in w, two scratch places);
    length[x] is the length of value x.
    """
    z = 0
    at = 0
    for k in range(first, last):
        op = steps[k, 0]
        x = steps[k, 1]
        y = steps[k, 2]
        z = steps[k, 3]
        a = steps[k, 4]
        b = steps[k, 5]
        at = steps[k, 6]
        if op == 0:
            length[z] = _mul2(w, at, w[a], w[b])
        elif op == 1:
            length[z] = _add2(w, at, w[a], w[b])
        elif op == 2:
            length[z] = _add2(w, at, w[a], -w[b])
        elif op == 3:
            length[z] = _sum(w, a, length[x], b, length[y], 1.0, at)
        elif op == 4:
            length[z] = _sum(w, a, length[x], b, length[y], -1.0, at)
        elif op == 5:
            length[z] = _scale(w, a, length[x], w[b], at)
        elif op == 6:
            length[z] = _mul(w, a, length[x], b, length[y], at, steps[k, 7], steps[k, 8])
        elif op == 7:
            length[z] = _times(w, a, length[x], w[b], at)
        elif op == 8:
            length[z] = _times(w, a, length[x], 1.0 * _sign(w, a, length[x]), at)
        elif op == 11:
            length[z] = _dot(w, at, w[a], w[b], w[steps[k, 7]], w[steps[k, 8]], 1.0)
        elif op == 12:
            length[z] = _dot(w, at, w[a], w[b], w[steps[k, 7]], w[steps[k, 8]], -1.0)
        else:
            # the first operand where the sign of value p is not s, else the second
            p = steps[k, 7]
            if _sign(w, steps[k, 8], length[p]) * (1 if op == 9 else -1) <= 0:
                length[z] = _times(w, a, length[x], 1.0, at)
            else:
                length[z] = _times(w, b, length[y], 1.0, at)
    return _sign(w, at, length[z])


@FLAGS
def usable(x, low, high):
    """True iff x is 0 or of a magnitude from low to high."""
    return x == 0 or (abs(x) >= low and abs(x) <= high)
'''


def primitives(flags: str) -> str:
    """Functions shared by all kernels: `two_sum`, `two_product`, `sign_of` and `usable`."""
    return "from numba import njit\n\n\n" + PRIMITIVES.strip().replace("@FLAGS", f"@{flags}") + "\n"
