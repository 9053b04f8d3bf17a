#!/usr/bin/env python3
"""Makes the tables that the statistics are held against: 40-digit arithmetic (mpmath), written to 13 digits.

    python3 golden.py            # all tables, about ten minutes; needs mpmath, numpy, scipy

Distribution tails are sums of exact terms, limits are roots polished at 40 digits; scipy's double-precision values only
start the roots, so where scipy is wrong mpmath decides. numpy finds the neighbourhood of Barnard's maximum and of the
posterior's mass, mpmath the value. Nothing here calls the program under test.

one_sample.csv.gz  every k <= n/2 for every n from 1 to 200; the other half is its mirror
by_n.csv           sizes, powers and reach of every n from 1 to 200
chi_square.csv     chi-square from 1e-300 to 1e300
two_sample.csv     two arms: whole families of tables, and tables up to 200 people an arm
order.csv          sensitivity, bias and order-corrected equivalence
ladder.csv         maximum-likelihood fits of psychometric functions
"""
import gzip
import random
import sys
from fractions import Fraction

import mpmath as mp
import numpy as np
from scipy import optimize, special

mp.mp.dps = 40
HALF = mp.mpf(1) / 2
ALPHA = mp.mpf(5) / 100
BOUNDS = ["0.1", "0.15", "0.2", "0.25"]


def text(value):
    return mp.nstr(mp.mpf(value), 13, strip_zeros=True)


def z(p):
    """The standard normal quantile."""
    p = mp.mpf(p)
    if p <= 0 or p >= 1:
        return mp.inf if p >= 1 else -mp.inf
    x = mp.mpf(float(special.ndtri(float(p))))
    for _ in range(4):
        x -= (mp.ncdf(x) - p) / mp.npdf(x)
    return x


Z95, Z90 = z(mp.mpf("0.975")), z(mp.mpf("0.95"))


def masses(n, p):
    """P(X = k) for all k."""
    p = mp.mpf(p)
    q = 1 - p
    out, choose = [], 1
    for k in range(n + 1):
        out.append(choose * p**k * q ** (n - k))
        choose = choose * (n - k) // (k + 1)
    return out


def tails(n, p):
    """P(X <= k) and P(X >= k) for all k, each summed from its own end."""
    mass = masses(n, p)
    below, above = [], []
    total = mp.mpf(0)
    for value in mass:
        total += value
        below.append(total)
    total = mp.mpf(0)
    for value in reversed(mass):
        total += value
        above.append(total)
    return below, above[::-1]


def beta_lower(a, b, x):
    """I_x(a, b) by the power series of DLMF 8.17.8, from the side where it converges faster."""
    x = mp.mpf(x)
    if x > (a + 1) / (a + b + 2):
        return 1 - beta_lower(b, a, 1 - x)
    term = total = mp.mpf(1)
    j = 0
    while abs(term) > mp.mpf(10) ** -(mp.mp.dps + 3) * abs(total):
        term *= (a + b + j) * x / (a + 1 + j)
        total += term
        j += 1
    return total * mp.exp(a * mp.log(x) + b * mp.log(1 - x) - mp.log(a) - ln_beta(a, b))


def ln_beta(a, b):
    return mp.loggamma(a) + mp.loggamma(b) - mp.loggamma(a + b)


def beta_quantile(a, b, q):
    """The x with I_x(a, b) = q, on the logit of x so that small ones keep their digits."""
    a, b, q = mp.mpf(a), mp.mpf(b), mp.mpf(q)
    start = mp.mpf(float(special.betaincinv(float(a), float(b), float(q))))
    t = mp.log(start / (1 - start))
    for _ in range(20):
        x = 1 / (1 + mp.exp(-t))
        value = beta_lower(a, b, x)
        slope = mp.exp(a * mp.log(x) + b * mp.log(1 - x) - ln_beta(a, b))
        step = (value - q) / slope
        t -= step
        if abs(step) < mp.mpf(10) ** -9:  # Newton doubles the digits: the rest is far below 13 of them.
            break
    return 1 / (1 + mp.exp(-t))


def wilson(k, n, zed=None):
    zed = Z95 if zed is None else zed
    p, n = mp.mpf(k) / n, mp.mpf(n)
    middle = (p + zed**2 / (2 * n)) / (1 + zed**2 / n)
    half = zed / (1 + zed**2 / n) * mp.sqrt(p * (1 - p) / n + zed**2 / (4 * n**2))
    return (mp.mpf(0) if k == 0 else middle - half), (mp.mpf(1) if k == n else middle + half)


def clopper_pearson(k, n, level="0.95"):
    tail = (1 - mp.mpf(level)) / 2
    low = mp.mpf(0) if k == 0 else beta_quantile(k, n - k + 1, tail)
    high = mp.mpf(1) if k == n else 1 - beta_quantile(n - k, k + 1, tail)
    return low, high


def one_sample():
    tail = mp.mpf("0.025")
    header = ["k", "n", "chi_p", "exact_p", "cp_lo", "cp_hi", "wilson_lo", "wilson_hi", "jeffreys_lo", "jeffreys_hi",
              "h", "d_prime", "d_prime_lo", "d_prime_hi", "jod", "bf01_uniform", "bf01_above", "bf01_below",
              "bf01_jeffreys"]
    for bound in BOUNDS:
        header += [f"tost_lower_{bound}", f"tost_upper_{bound}", f"posterior_{bound}"]
    rows = [header]
    z75 = z(mp.mpf("0.75"))
    for n in range(1, 201):
        below, _ = tails(n, HALF)
        by_bound = [(mp.mpf(b), tails(n, HALF - mp.mpf(b)), tails(n, HALF + mp.mpf(b)),
                     tails(n + 1, HALF - mp.mpf(b)), tails(n + 1, HALF + mp.mpf(b))) for b in BOUNDS]
        for k in range(n // 2 + 1):
            statistic = mp.mpf((2 * k - n) ** 2) / n
            chi_p = mp.erfc(mp.sqrt(statistic / 2))
            exact = mp.mpf(1) if n - 2 * k <= 1 else min(mp.mpf(1), 2 * below[k])
            cp = clopper_pearson(k, n)
            wil = wilson(k, n)
            j_lo = mp.mpf(0) if k == 0 else beta_quantile(mp.mpf(k) + HALF, mp.mpf(n - k) + HALF, tail)
            j_hi = 1 - beta_quantile(mp.mpf(n - k) + HALF, mp.mpf(k) + HALF, tail)
            p = mp.mpf(k) / n
            d_prime = mp.sqrt(2) * z(p)
            ln_uniform = -n * mp.log(2) - ln_beta(k + 1, n - k + 1)
            # The mass above one half of Beta(k + 1, n - k + 1) is P(X <= k) of n + 1 throws of a coin.
            upper = tails_half(n + 1)[k]
            uniform = mp.exp(ln_uniform)
            jeffreys = mp.exp(-n * mp.log(2) + mp.log(mp.pi) - ln_beta(k + HALF, n - k + HALF))
            row = [k, n, chi_p, exact, *cp, *wil, j_lo, j_hi, mp.asin(2 * p - 1), d_prime,
                   mp.sqrt(2) * z(cp[0]), mp.sqrt(2) * z(cp[1]), z(p) / z75,
                   uniform, uniform / (2 * upper), uniform / (2 * (1 - upper)), jeffreys]
            for bound, low, high, low_more, high_more in by_bound:
                # I_x(k + 1, n - k + 1) is P(X >= k + 1) of n + 1 at x: the mass between is a difference of tails.
                inside = low_more[0][k] - high_more[0][k]
                if inside < mp.mpf(10) ** -20 * low_more[0][k]:
                    raise SystemExit("too few digits")
                row += [low[1][k], high[0][k], inside]
            rows.append([str(v) if isinstance(v, int) else text(v) for v in row])
        if n % 20 == 0:
            print("one_sample", n, file=sys.stderr)
    return rows


_HALVES = {}


def tails_half(n):
    if n not in _HALVES:
        _HALVES.clear()
        _HALVES[n] = tails(n, HALF)[0]
    return _HALVES[n]


def by_n():
    truths = ["0.6", "0.75", "0.9"]
    header = ["n", "chi_size", "exact_size"] + [f"chi_power_{t}" for t in truths] + [f"exact_power_{t}" for t in truths]
    header += [f"tost_power_{t}_{b}" for b in BOUNDS for t in ("0.5", "0.6", "0.99")] + ["smallest_bound", "detectable"]
    critical = 2 * mp.erfinv(1 - ALPHA) ** 2
    rows = [header]
    for n in range(1, 201):
        chi = [k for k in range(n + 1) if mp.mpf((2 * k - n) ** 2) / n > critical]
        below = tails(n, HALF)[0]
        exact = [k for k in range(n + 1) if 2 * below[min(k, n - k)] <= ALPHA and n != 2 * k]
        at = {t: masses(n, mp.mpf(t)) for t in ["0.5", "0.6", "0.75", "0.9", "0.99"]}
        total = lambda ks, t: mp.fsum(at[t][k] for k in ks)
        row = [mp.mpf(n), total(chi, "0.5"), total(exact, "0.5")]
        row += [total(chi, t) for t in truths] + [total(exact, t) for t in truths]
        for bound in BOUNDS:
            lower, upper = tails(n, HALF - mp.mpf(bound))[1], tails(n, HALF + mp.mpf(bound))[0]
            passing = [k for k in range(n + 1) if max(lower[k], upper[k]) <= ALPHA]
            row += [total(passing, t) for t in ("0.5", "0.6", "0.99")]
        # The likeliest count to pass is floor(n/2): P(X >= n/2) falls as the lower bound does.
        middle = n // 2
        row.append(solve(lambda b: tail_above(n, middle, HALF - b) - ALPHA, mp.mpf("1e-12"), HALF - mp.mpf("1e-9")))
        size = lambda t: tail_below(n, exact, t) - mp.mpf("0.8")
        row.append(solve(size, HALF, 1 - mp.mpf("1e-9")) if exact else mp.nan)
        rows.append([str(n)] + [text(v) for v in row[1:]])
        if n % 20 == 0:
            print("by_n", n, file=sys.stderr)
    return rows


def tail_above(n, k, p):
    return mp.fsum(masses(n, p)[k:])


def tail_below(n, ks, p):
    mass = masses(n, p)
    return mp.fsum(mass[k] for k in ks)


def solve(f, low, high):
    """A root of a monotone function, or not a number where it has none inside."""
    a, b = f(low), f(high)
    if a * b > 0:
        return mp.nan
    for _ in range(30):
        middle = (low + high) / 2
        value = f(middle)
        low, high, a, b = (middle, high, value, b) if value * a > 0 else (low, middle, a, value)
    return mp.findroot(f, (low, high), solver="anderson", tol=1e-30)


def chi_square():
    rows = [["statistic", "df", "log10_p"]]
    mp.mp.dps = 340
    points = [f"1e{e}" for e in range(-300, 301, 20)]
    points += ["0.01", "0.25", "1", "2.5", "3.841458820694124", "10", "60", "300", "1400", "1480", "5000"]
    for df in (1, 2, 3, 4, 5, 10):
        for point in points:
            x = mp.mpf(point)
            if x > 1e6:
                # The tail is x^(a-1) e^-x / Gamma(a) times 1 + (a-1)/x + ..., x being half the statistic.
                a, y = mp.mpf(df) / 2, x / 2
                term, series, j = mp.mpf(1), mp.mpf(1), 1
                while j < 60 and a - j != 0:
                    term *= (a - j) / y
                    series += term
                    j += 1
                log10 = ((a - 1) * mp.log(y) - y - mp.loggamma(a) + mp.log(series)) / mp.log(10)
            elif x < mp.mpf("1e-6"):
                a, y = mp.mpf(df) / 2, x / 2
                lower, term, j = mp.mpf(0), mp.mpf(1), 0
                for j in range(40):
                    lower += term / (a + j)
                    term *= -y / (j + 1)
                lower *= y**a / mp.gamma(a)
                log10 = -(lower + lower**2 / 2 + lower**3 / 3) / mp.log(10)
            else:
                log10 = mp.log(mp.gammainc(mp.mpf(df) / 2, x / 2, regularized=True)) / mp.log(10)
            rows.append([point, str(df), mp.nstr(log10, 17)])
    mp.mp.dps = 40
    return rows


def fisher(a, m, b, n):
    s = a + b
    weight = {i: mp.binomial(m, i) * mp.binomial(n, s - i) for i in range(max(0, s - n), min(m, s) + 1)}
    weight = {i: int(mp.nint(w)) for i, w in weight.items()} if m + n < 60 else {
        i: exact_choose(m, i) * exact_choose(n, s - i) for i in weight}
    here = weight[a]
    return mp.mpf(sum(w for w in weight.values() if w <= here)) / sum(weight.values())


def exact_choose(n, k):
    from math import comb
    return comb(n, k)


def barnard(a, m, b, n):
    """The largest probability over the common proportion of a table whose squared score is at least this one's."""
    def score(i, j):
        s = i + j
        if s == 0 or s == m + n:
            return 0, 1
        return (i * n - j * m) ** 2, s * (m + n - s)
    top, bottom = score(a, b)
    if top == 0:
        return mp.mpf(1)
    weights = [0] * (m + n + 1)
    rows = [exact_choose(m, i) for i in range(m + 1)]
    columns = [exact_choose(n, j) for j in range(n + 1)]
    for i in range(m + 1):
        for j in range(n + 1):
            t, u = score(i, j)
            if t * bottom >= top * u:
                weights[i + j] += rows[i] * columns[j]
    people = m + n
    p = np.linspace(0, 1, 4003)[1:-1]
    sums = np.zeros_like(p)
    for s, weight in enumerate(weights):
        if weight:
            sums += np.exp(float(mp.log(weight)) + s * np.log(p) + (people - s) * np.log1p(-p))
    best = mp.mpf(0)
    size = lambda x: mp.fsum(w * x**s * (1 - x) ** (people - s) for s, w in enumerate(weights) if w)
    for at in range(len(p)):
        left, right = sums[at - 1] if at else 0, sums[at + 1] if at + 1 < len(p) else 0
        if sums[at] >= left and sums[at] >= right and sums[at] > 0.9999 * sums.max():
            low, high = mp.mpf(p[max(at - 1, 0)]), mp.mpf(p[min(at + 1, len(p) - 1)])
            golden = (mp.sqrt(5) - 1) / 2
            x, y = high - golden * (high - low), low + golden * (high - low)
            fx, fy = size(x), size(y)
            for _ in range(45):
                if fx > fy:
                    high, y, fy = y, x, fx
                    x = high - golden * (high - low)
                    fx = size(x)
                else:
                    low, x, fx = x, y, fy
                    y = low + golden * (high - low)
                    fy = size(y)
            best = max(best, fx, fy)
    return min(best, mp.mpf(1))


def two_sample():
    rows = [["a", "m", "b", "n", "difference", "newcombe_lo", "newcombe_hi", "h", "fisher_p", "barnard_p"]]
    tables = []
    for m, n in [(1, 1), (3, 3), (4, 6), (8, 8), (16, 16)]:
        tables += [(a, m, b, n) for a in range(m + 1) for b in range(n + 1)]
    draw = random.Random(2005)
    for _ in range(150):
        m, n = draw.randint(1, 200), draw.randint(1, 200)
        tables.append((draw.randint(0, m), m, draw.randint(0, n), n))
    for done, (a, m, b, n) in enumerate(tables):
        p, q = mp.mpf(a) / m, mp.mpf(b) / n
        (p_lo, p_hi), (q_lo, q_hi) = wilson(a, m), wilson(b, n)
        low = p - q - mp.sqrt((p - p_lo) ** 2 + (q_hi - q) ** 2)
        high = p - q + mp.sqrt((p_hi - p) ** 2 + (q - q_lo) ** 2)
        h = 2 * (mp.asin(mp.sqrt(p)) - mp.asin(mp.sqrt(q)))
        values = [p - q, low, high, h, fisher(a, m, b, n), barnard(a, m, b, n)]
        rows.append([str(v) for v in (a, m, b, n)] + [text(v) for v in values])
        if done % 100 == 0:
            print("two_sample", done, len(tables), file=sys.stderr)
    return rows


def ln_ncdf(x):
    return mp.log(mp.erfc(-x / mp.sqrt(2)) / 2)


class Profile:
    """The likelihood of d with the bias free: H = Phi(b + d), F = Phi(b - d)."""

    def __init__(self, x, n, y, m):
        self.counts = [x, n - x, y, m - y]
        part = lambda k, n: k * mp.log(mp.mpf(k) / n) if k else mp.mpf(0)
        self.most = part(x, n) + part(n - x, n) + part(y, m) + part(m - y, m)
        self.best = (z(mp.mpf(x) / n) - z(mp.mpf(y) / m)) / 2

    def at(self, d):
        signs = [(1, 1), (-1, -1), (1, -1), (-1, 1)]
        terms = [(c, sb, sd) for c, (sb, sd) in zip(self.counts, signs) if c]
        def slope(b):
            first = second = mp.mpf(0)
            for c, sb, sd in terms:
                u = sb * b + sd * d
                ratio = mp.exp(-u * u / 2 - mp.log(2 * mp.pi) / 2 - ln_ncdf(u))
                first += c * sb * ratio
                second -= c * ratio * (u + ratio)
            return first, second
        low, high = mp.mpf(-40) - abs(d), mp.mpf(40) + abs(d)
        b = mp.mpf(0)
        for _ in range(200):
            first, second = slope(b)
            low, high = (b, high) if first > 0 else (low, b)
            step = b - first / second
            after = step if low < step < high else (low + high) / 2
            if abs(after - b) < mp.mpf(10) ** -32:
                break
            b = after
        return mp.fsum(c * ln_ncdf(sb * b + sd * d) for c, sb, sd in terms)

    def root(self, d):
        size = mp.sqrt(max(mp.mpf(0), 2 * (self.most - self.at(d))))
        return size if d <= self.best else -size


def order():
    rows = [["x", "n", "y", "m", "d_prime", "c", "proportion", "p_0.1", "p_0.25", "low", "high"]]
    tables = [(x, 8, y, 8) for x in range(9) for y in range(9)]
    tables += [(x, 7, y, 5) for x in range(8) for y in range(6)]
    tables += [(x, 22, y, 22) for x in range(0, 23, 4) for y in range(0, 23, 3)]
    tables += [(50, 100, 50, 100), (88, 100, 80, 100), (3, 100, 4, 100)]
    for x, n, y, m in tables:
        if (x, y) in ((0, 0), (n, m)):
            continue  # Every answer was the same interval: nothing can be told.
        extreme = x in (0, n) or y in (0, m)
        rate = (lambda k, n: (mp.mpf(k) + HALF) / (n + 1)) if extreme else (lambda k, n: mp.mpf(k) / n)
        h, f = z(rate(x, n)), z(rate(y, m))
        likelihood = Profile(x, n, y, m)
        ps = []
        for bound in ("0.1", "0.25"):
            limit = z(HALF + mp.mpf(bound))
            ps.append(max(mp.ncdf(-likelihood.root(-limit)), mp.ncdf(likelihood.root(limit))))
        ends = []
        for target in (Z90, -Z90):
            f_of = lambda d: likelihood.root(d) - target
            low, high = mp.mpf(-6), mp.mpf(6)
            if f_of(low) <= 0:
                ends.append(mp.mpf(0))
            elif f_of(high) >= 0:
                ends.append(mp.mpf(1))
            else:
                for _ in range(12):
                    middle = (low + high) / 2
                    low, high = (middle, high) if f_of(middle) > 0 else (low, middle)
                ends.append(mp.ncdf(mp.findroot(f_of, (low, high), solver="anderson", tol=1e-25)))
        values = [(h - f) / mp.sqrt(2), -(h + f) / 2, mp.ncdf(likelihood.best), *ps, *ends]
        rows.append([str(v) for v in (x, n, y, m)] + [text(v) for v in values])
    print("order", len(rows), file=sys.stderr)
    return rows


SPANS = {"gaussian": 2 * 1.6448536269514722, "logistic": 2 * np.log(19),
         "weibull": np.log(np.log(20)) - np.log(np.log(20 / 19))}


def shape(family, u):
    if family == "gaussian":
        return special.ndtr(SPANS[family] * u)
    if family == "logistic":
        return special.expit(SPANS[family] * u)
    return -np.expm1(-np.log(2) * np.exp(np.clip(SPANS[family] * u, -700, 700)))


def ladder():
    """Each ladder: five or six steps, k of n right. scipy finds the maximum from many starts; a grid finer than the
    program's in every direction gives the posterior of the threshold."""
    rows = [["ladder", "family", "threshold", "width", "lapse", "deviance", "low", "high"]]
    shown = [("x", "k", "n")]
    ladders = []
    draw = np.random.default_rng(2005)
    for people, threshold, width, lapse in [(16, 0, 2, 0), (44, -0.4, 1.5, 0.02), (44, 0.6, 3, 0.05), (100, 0, 1, 0),
                                            (200, 0.3, 2, 0.03), (1000, -0.2, 2.5, 0.01)]:
        x = np.arange(6) - 2.5
        p = 0.5 + (0.5 - lapse) * shape("gaussian", (x - threshold) / width)
        ladders.append((x, draw.binomial(people, p), np.full(6, people)))
    steps = [["ladder", "x", "k", "n"]]
    for number, (x, k, n) in enumerate(ladders):
        steps += [[str(number), repr(float(a)), str(int(b)), str(int(c))] for a, b, c in zip(x, k, n)]
        span = x.max() - x.min()
        for family in ("gaussian", "logistic", "weibull"):
            def ln(threshold, width, lapse):
                p = 0.5 + (0.5 - lapse)[..., None] * shape(family, (x - threshold[..., None]) / width[..., None])
                return (special.xlogy(k, p) + special.xlog1py(n - k, -p)).sum(-1)
            minus = lambda v: -ln(np.array(v[0]), np.exp(np.array(v[1])), np.array(v[2]))
            best = None
            bounds = [(x.min() - span / 2, x.max() + span / 2), (np.log(0.1 * span), np.log(5 * span)), (0, 0.1)]
            for t in np.linspace(x.min(), x.max(), 7):
                for w in (0.3, 1, 3, 8):
                    found = optimize.minimize(minus, [t, np.log(w), 0.02], bounds=bounds, method="L-BFGS-B",
                                              options={"ftol": 1e-15, "gtol": 1e-10})
                    best = found if best is None or found.fun < best.fun else best
            for _ in range(5):
                found = optimize.minimize(minus, best.x, bounds=bounds, method="Nelder-Mead",
                                          options={"xatol": 1e-12, "fatol": 1e-14, "maxiter": 20000, "maxfev": 20000})
                best = found if found.fun <= best.fun else best
            share = k / n
            saturated = (special.xlogy(k, share) + special.xlog1py(n - k, -share)).sum()
            thresholds = np.linspace(x.min() - span / 2, x.max() + span / 2, 1201)
            widths = np.exp(np.linspace(np.log(0.1 * span), np.log(5 * span), 161))
            lapses = np.linspace(0, 0.1, 41)
            mass = np.zeros(len(thresholds))
            for lapse in lapses:
                t, w = np.meshgrid(thresholds, widths, indexing="ij")
                # Trapezoid rule: the ends of the lapse's range count half.
                weight = 0.5 if lapse in (lapses[0], lapses[-1]) else 1.0
                value = np.exp(ln(t, w, np.full_like(t, lapse)) + best.fun)
                value[:, [0, -1]] *= 0.5
                mass += weight * value.sum(1)
            cumulative = np.concatenate([[0], np.cumsum(0.5 * (mass[1:] + mass[:-1]))])
            cumulative /= cumulative[-1]
            ends = [float(np.interp(q, cumulative, thresholds)) for q in (0.025, 0.975)]
            values = [best.x[0], np.exp(best.x[1]), best.x[2], 2 * (saturated + best.fun), *ends]
            rows.append([str(number), family] + [f"{v:.10g}" for v in values])
    print("ladder", len(rows), file=sys.stderr)
    return rows, steps


def lines(rows):
    return "".join(",".join(row) + "\n" for row in rows)


def write(name, rows):
    with open(name, "w") as out:
        out.write(lines(rows))


def main():
    wanted = sys.argv[1:]
    does = lambda name: not wanted or name in wanted
    if does("one_sample"):
        # Without a time stamp, so that the same numbers are the same file.
        with open("one_sample.csv.gz", "wb") as out:
            with gzip.GzipFile(fileobj=out, mode="wb", compresslevel=9, mtime=0, filename="") as zipped:
                zipped.write(lines(one_sample()).encode())
    for name, make in (("by_n", by_n), ("chi_square", chi_square), ("two_sample", two_sample), ("order", order)):
        if does(name):
            write(name + ".csv", make())
    if does("ladder"):
        fits, steps = ladder()
        write("ladder.csv", fits)
        write("ladder_steps.csv", steps)


if __name__ == "__main__":
    main()
