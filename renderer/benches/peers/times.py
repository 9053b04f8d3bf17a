"""From points of time and error to times to a given error, and their table."""

import math

import numpy as np

GOALS = (0.02, 0.01)


def curve(points):
    """Seconds to a goal: read between points by error ~ time^slope, beyond the last (marked ~) by time^-1/2."""

    def seconds(goal, is_unbiased):
        ordered = sorted(points)
        if ordered[0][1] <= goal:
            return ordered[0][0], "<"
        for (t0, e0), (t1, e1) in zip(ordered, ordered[1:]):
            if e1 <= goal < e0:
                return t0 * (t1 / t0) ** (math.log(e0 / goal) / math.log(e0 / e1)), ""
        t, e = ordered[-1]
        return (t * (e / goal) ** 2, "~") if is_unbiased else (None, f"{100 * e:.2f} % at {t:.1f}")

    return seconds


class Table:
    """The points of one scene as they come, and the times to the goals."""

    def __init__(self):
        self.points, self.times = {}, {}

    def add(self, renderer, setting, seconds, error, mean):
        self.points.setdefault(renderer, []).append((seconds, error))
        print(f"| {renderer} | {setting} | {seconds:.2f} | {100 * error:.2f} | {mean:.4f} |", flush=True)

    def read(self, renderer, is_unbiased=True):
        if renderer in self.points:
            read = curve(self.points[renderer])
            self.times[renderer] = [read(goal, is_unbiased) for goal in GOALS]

    def offer(self, renderer, times):
        """Another setting of a renderer, of which the quickest counts."""
        old = self.times.get(renderer, [(None, "never")] * len(GOALS))
        self.times[renderer] = [min(pair, key=lambda it: math.inf if it[0] is None else it[0]) for pair in zip(old, times)]


def shown(time):
    seconds, note = time
    if seconds is None:
        return f"({note})"
    return f"{'~' if '~' in note else note}{seconds:.3g}{' cache' if 'cache' in note and 'no' not in note else ''}"


def summary(all_times, goal):
    """Times to one goal, the ratios to crex's, and their geometric means."""
    pick = lambda times, name: next((t[goal] for key, t in times.items() if key == name or key.startswith(name + " --")), None)
    smooth = lambda times: next((t[goal] for key, t in times.items() if "--filter" in key), None)
    print(f"\n### CPU seconds to {100 * GOALS[goal]:.0f} %\n")
    heads = ["crex", "crex --filter", "rpict, best", "Mitsuba", "Cycles", "Cycles, denoised"]
    ratios = ["rpict / crex", "rpict / filter", "best of M and C / crex", "Cycles denoised / filter"]
    print(f"| scene | {' | '.join(heads + ratios)} |\n|{'---|' * (1 + len(heads + ratios))}")
    collected = [{} for _ in ratios]
    for name, times in all_times.items():
        us, ours = pick(times, "crex"), smooth(times)
        rpict, mitsuba, cycles, denoised = (pick(times, it) for it in ("rpict", "Mitsuba", "Cycles", "Cycles, denoised"))
        best = min((it for it in (mitsuba, cycles) if it and it[0]), default=None)
        row = []
        for found, (theirs, mine) in zip(collected, ((rpict, us), (rpict, ours), (best, us), (denoised, ours))):
            if theirs and mine and theirs[0] and mine[0]:
                found[name] = theirs[0] / mine[0]
                row.append(f"{found[name]:.2f}")
            else:
                row.append("")
        values = [shown(it) if it else "" for it in (us, ours, rpict, mitsuba, cycles, denoised)]
        print(f"| {name} | {' | '.join(values + row)} |")
    six = [name for name in all_times if name != "cornell, all components" and not name.endswith("matt")]
    for title, found, among in zip(ratios, collected, (six, six, all_times, all_times)):
        values = [found[name] for name in among if name in found]
        if values:
            print(f"\n{title}: geometric mean {math.exp(np.mean(np.log(values))):.2f} of {len(values)} scenes")
